#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/fields.h"
#include "evaluation/performance.h"
#include "facs/facs_catalogue.h"
#include "geometry/types.h"
#include "statistics/interval.h"

namespace mimik::evaluation {

struct AdditivityOptions {
    double moving_mm = 0.5;    ///< a vertex counts where the expression or one of its units moves it so far
    std::uint64_t seed = 1;    ///< of the bootstrap
    int resamples = 2000;      ///< of it
    double confidence = 0.95;  ///< of its intervals, share

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("moving_mm", self.moving_mm);
        visit("seed", self.seed);
        visit("resamples", self.resamples);
        visit("confidence", self.confidence);
    }
    void check() const;  ///< throws InputError
};
static_assert(base::lists_every_field<AdditivityOptions>());

/// One person who was scanned with an expression of several units, and with each unit alone. Lengths are means over
/// the vertices that count, mm.
struct AdditivityCase {
    std::string subject;
    std::size_t vertices = 0;
    double motion_mm = 0;              ///< |d| of the expression's own scan
    double sum_off_mm = 0;             ///< |sum of the units - d|
    double scaled_sum_off_mm = 0;      ///< |gain x sum of the units - d|
    double resultant_off_mm = 0;       ///< |parallel resultant of the units - d|
    std::vector<double> alone_off_mm;  ///< |one unit - d|, in the units' order
    double gain = 0;                   ///< of the sum, by least squares
};

/// Part of the expression's motion that a way of combining gives: 1 - sum of what it is off / sum of the motion.
struct AdditivityShare {
    double share = 0;
    std::optional<statistics::Interval> interval;  ///< empty: of one person
};

struct Additivity {
    facs::Expression expression;
    std::vector<std::string> units;  ///< codes: "12", "1L"
    std::vector<AdditivityCase> cases;
    AdditivityShare sum, scaled_sum, resultant;
    std::string strongest;       ///< the unit that alone comes nearest
    AdditivityShare alone;       ///< by that unit
    double gain = 0;             ///< mean over the cases
    double registration_mm = 0;  ///< rms distance of the fits to the scans of the expression: what is known at best
};

/// What one face says. @param combined_mm, units_mm  motion per vertex. @param known  vertices that lie on every scan.
/// @throws InputError where the lists differ in length, or nothing moves.
[[nodiscard]] AdditivityCase add_up(std::span<const geometry::Vector> combined_mm,
                                    std::span<const std::vector<geometry::Vector>> units_mm,
                                    std::span<const std::uint8_t> known, const AdditivityOptions& options);

/// Expressions of several units that somebody who may be shown was scanned with, with each unit, too. Sorted by code.
[[nodiscard]] std::vector<facs::Expression> combined_expressions(const preprocessing::Workspace& workspace,
                                                                 const facs::FacsCatalogue& catalogue);

/// Whether the motions of Action Units add up to that of an expression made of them, on the same person, by dense
/// registration (docs/algorithms/dense_correspondence.md): no truth is used. Parallel over people; the same answer for
/// any number of threads.
/// @param failures  people who cannot take part, with the reason
/// @throws InputError for bad options, an expression of one unit, or if nobody has all the scans.
[[nodiscard]] Additivity additivity(const PerformanceReader& reader, const facs::FacsCatalogue& catalogue,
                                    const facs::Expression& expression, const AdditivityOptions& options,
                                    FailureList& failures);

}  // namespace mimik::evaluation
