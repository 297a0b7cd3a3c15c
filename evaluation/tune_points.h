#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "animation/model_method.h"
#include "base/fields.h"
#include "evaluation/performance.h"
#include "facs/facs_catalogue.h"
#include "geometry/pattern_search.h"

namespace mimik::evaluation {

struct TuneOptions {
    double most_mm = 8.0;     ///< a point stays within this of where it was
    bool carried = true;      ///< move the points that skin or lids carry, too, not those of muscles and wrinkles alone
    bool one_sided = true;    ///< learn from scans of one side, where there are some, beside those of both
    int most_vertices = 600;  ///< of each face's zone that the search looks at; figures are of all
    geometry::PatternSearchOptions search;  ///< mm

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("most_mm", self.most_mm);
        visit("carried", self.carried);
        visit("one_sided", self.one_sided);
        visit("most_vertices", self.most_vertices);
        visit("search", self.search);
    }
    void check() const;  ///< throws InputError
};
static_assert(base::lists_every_field<TuneOptions>());

/// Subjects of one workspace. References.
struct TuneGroup {
    const PerformanceReader* reader = nullptr;
    std::vector<std::string> subjects;
};

/// The source on itself, of one expression over some subjects.
struct OwnScore {
    facs::Expression expression;
    std::size_t cases = 0;
    double before_mm = 0, after_mm = 0, nothing_mm = 0;  ///< mean error in the zone, mean over the cases

    /// 1 - error / error of doing nothing.
    [[nodiscard]] double explained_before() const { return nothing_mm > 0 ? 1 - before_mm / nothing_mm : 0; }
    [[nodiscard]] double explained_after() const { return nothing_mm > 0 ? 1 - after_mm / nothing_mm : 0; }
};

/// Offsets of a point before and after, in the catalogue's unit.
struct MovedPoint {
    std::string name;
    double lateral = 0, up = 0;          ///< after
    double was_lateral = 0, was_up = 0;  ///< before
    double moved_mm = 0;                 ///< on the reference face
};

struct TunedUnit {
    int unit = 0;
    std::vector<MovedPoint> points;          ///< those that may move, in the catalogue's order
    std::vector<OwnScore> training, unseen;  ///< one per expression that somebody shows
    int evaluations = 0;
    bool converged = false;  ///< else the evaluations were spent
};

/// What the thesis did by hand (5.5.1, 5.5.2: place the points, animate the source, compare with its real scan, move
/// the points, again), done by a search: moves the offsets of one AU's points, left and right alike, to lower the mean
/// error of the source on itself in the AU's zone, summed over the training subjects. Subjects in `unseen` take no part
/// in the search; the zone is that of all who show the AU in their workspace.
///
/// The points of a midline stay on it; a point stays on its half of the reference face and on that face. Parallel over
/// subjects; the same answer for any number of threads.
/// @param method  whose models and animations; its points stand on the source (ModelOptions::place_on_average off)
/// @param failures  subjects that cannot take part, with the reason
/// @param done  told after each evaluation, with their number and the lowest share of doing nothing's error
/// @throws InputError for bad options, an AU that is not in the catalogue, or if no training subject shows it.
[[nodiscard]] TunedUnit tune_points(std::span<const TuneGroup> training, std::span<const TuneGroup> unseen,
                                    const facs::FacsCatalogue& catalogue, int unit,
                                    const animation::ModelMethod& method, const TuneOptions& options,
                                    FailureList& failures, const std::function<void(int, double)>& done = {});

/// The catalogue with the points where they were moved to.
[[nodiscard]] facs::FacsCatalogue with_moved_points(const facs::FacsCatalogue& catalogue, const TunedUnit& tuned);

}  // namespace mimik::evaluation
