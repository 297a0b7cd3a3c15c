#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "synthesis/face_model.h"
#include "synthesis/scanner.h"
#include "synthesis/subject.h"

namespace mimik::synthesis {

struct SynthesizeOptions {
    int subjects = 12;                   ///< bs000, bs001, ...: the smallest number the project's scores are given for
    std::string expressions = "thesis";  ///< see make_expressions
    std::string emotions = "emfacs";     ///< what emotions are made of: "emfacs", or "thesis" (its Table 3-3)
    int neutrals = 2;                    ///< N_N_0, N_N_1 ...: as most Bosphorus subjects have
    bool repeat = false;                 ///< a second scan _1 of each expression
    std::uint64_t seed = 1;
    bool facs_codes = true;  ///< write facscodes.lst with the intensities
    VarianceOptions variances;
    ScannerOptions scanner;
    std::function<void(const std::string& scan)> on_scan_done = {};  ///< called from any thread

    static constexpr std::size_t unlisted = 1;  // on_scan_done
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("subjects", self.subjects);
        visit("expressions", self.expressions);
        visit("emotions", self.emotions);
        visit("neutrals", self.neutrals);
        visit("repeat", self.repeat);
        visit("seed", self.seed);
        visit("facs_codes", self.facs_codes);
        visit("variances", self.variances);
        visit("scanner", self.scanner);
    }
    void check() const;  ///< throws InputError naming field, value and range
};

/// What was made.
struct SynthesizeReport {
    std::size_t subjects = 0, scans = 0;
    std::size_t valid_points = 0;  ///< of all scans together
    std::size_t lost_grazing = 0, lost_holes = 0;
    std::size_t landmarks_marked = 0, landmarks_invisible = 0;
    std::uintmax_t bytes = 0;
    std::vector<std::string> skipped_expressions;  ///< the face model lacks a main shape; with the shape's name
};

/// What synthesize_database would make: scans, bytes on disk and seconds on one core, from figures measured once.
struct SynthesizeEstimate {
    std::size_t scans = 0;
    std::uintmax_t bytes = 0;
    double core_seconds = 0;
    std::vector<std::string> skipped_expressions;
};
[[nodiscard]] SynthesizeEstimate estimate_database(const FaceModel& model, const SynthesizeOptions& options);

/// Refuses before the work what would be refused after it. @throws InputError if `out` exists and is not an empty
/// folder, or its disk has fewer than `bytes` free.
void check_database_place(const std::filesystem::path& out, std::uintmax_t bytes = 0);

/// Writes a database in Bosphorus layout and its truth (docs/formats.md). It grows in a folder beside `out` and takes
/// its name when complete. Same options, same bytes, whatever the number of threads.
/// @throws InputError if `out` exists and is not an empty folder, or an option is out of range.
SynthesizeReport synthesize_database(const std::filesystem::path& out, const FaceModel& model,
                                     const SynthesizeOptions& options = {});

}  // namespace mimik::synthesis
