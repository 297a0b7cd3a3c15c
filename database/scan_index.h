#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "database/doctor.h"
#include "database/scan_database.h"

namespace mimik::database {

/// What a listing says about one scan, without opening it again.
struct ScanSummary {
    int rows = 0;  ///< 0: not organised
    int cols = 0;
    std::size_t points = 0;                     ///< measured
    std::vector<std::string> landmarks;         ///< our names
    std::vector<std::string> remarks;           ///< what the self-checks of load() found
    std::string error;                          ///< why the scan cannot be loaded; empty: it can
    std::vector<std::string> files_looked_for;  ///< that the scan file names: image, material file
    bool checked = false;                       ///< the doctor has looked at it: `findings` says what it found
    std::vector<Finding> findings;

    [[nodiscard]] std::vector<std::string> missing_landmarks() const;  ///< of the 22 regular ones
    [[nodiscard]] bool has_error() const;  ///< cannot be loaded, or an error of the doctor's
    bool operator==(const ScanSummary&) const = default;
};
/// Opens the scan. Nothing is thrown for a bad file.
[[nodiscard]] ScanSummary summarise(const ScanEntry& entry);

struct ScanIndexOptions {
    std::filesystem::path folder = {};  ///< empty: $XDG_CACHE_HOME/mimik, else $HOME/.cache/mimik
    bool use_cache = true;
    bool check = false;  ///< run the doctor where it has not seen the scan as it is now
    DoctorOptions doctor = {};
    std::function<void(const ScanEntry&)> progress = {};  ///< called once for every scan, from any thread

    static constexpr std::size_t unlisted = 1;  // progress
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("folder", self.folder);
        visit("use_cache", self.use_cache);
        visit("check", self.check);
        visit("doctor", self.doctor);
    }
};

/// Summaries of the scans asked for, in their order.
struct ScanIndexResult {
    std::vector<ScanSummary> summaries;
    std::size_t scans_read = 0;        ///< opened this time
    std::size_t scans_remembered = 0;  ///< taken from the index
    std::filesystem::path file;        ///< of the index; empty: none was used
    std::string remark;                ///< why the index was rebuilt or not used; empty: all well
};

/// The index of a database is an SQLite file in the user's cache, one per database (named after its absolute path),
/// never in the database. A scan is opened again when the time or size of one of its files (also of those that the scan
/// file names), its unit, its name or (for the doctor) the options have changed, and where it could not be read. An
/// index that is damaged is built anew; one that is locked or cannot be written is done without: it is never a reason
/// to fail. Scans are opened in parallel.
[[nodiscard]] ScanIndexResult scan_index(const ScanDatabase& database, std::span<const ScanEntry* const> scans,
                                         const ScanIndexOptions& options = {});

/// Where the index of a database lies; empty if the user has no cache folder (neither variable is set).
[[nodiscard]] std::filesystem::path scan_index_file(const ScanDatabase& database, const ScanIndexOptions& options = {});

}  // namespace mimik::database
