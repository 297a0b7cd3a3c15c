#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "evaluation/case_row.h"
#include "evaluation/cast.h"
#include "evaluation/performance.h"

namespace mimik::evaluation {

/// Anchors are numbers that a score is read between. Doing nothing and the true fields are methods; these two are what
/// a perfect method would still score; their rows stand behind those of a target's methods.
inline constexpr const char* scanner_floor = "second-scan";            ///< the neutral face, scanned twice
inline constexpr const char* performer_floor = "repeated-expression";  ///< the expression, shown and scanned twice
[[nodiscard]] inline bool is_anchor(std::string_view method) {
    return method == scanner_floor || method == performer_floor;
}

/// The anchors of one target of the cast, as `surface_distance`, region zone and face, metric mean:
///   second-scan          the first neutral scan's vertices to the surface of the second
///   repeated-expression  the second expressive scan's vertices to the surface of the first, which methods are scored
///   by
/// Both in the expression's zone, measured vertices alone, and not where the nearest point lies on the border; the
/// scans are brought together as those of every case. No rows where the database has no second scan; what fails is
/// added to `failures`.
[[nodiscard]] std::vector<CaseRow> anchor_rows(const PerformanceReader& reader, const Cast& cast, std::size_t t,
                                               FailureList& failures);

/// What people differ by when they show an expression again, mm, where a database has nobody who did: Johnston,
/// Millett, Ayoub and Bock 2003, "Are facial expressions reproducible?", Cleft Palate-Craniofacial Journal 40(3): 0.7
/// at rest to 1.1 of puffed cheeks.
inline constexpr std::pair<double, double> published_performer_floor_mm = {0.7, 1.1};

/// One anchor of an experiment.
struct Anchor {
    std::string method;                ///< "second-scan"
    std::string title;                 ///< as tables print it: "scanner floor"
    std::map<std::string, double> mm;  ///< by expression: mean over the targets, in the zone
    std::map<std::string, std::size_t> targets;
    std::string unknown;  ///< why there is none of some expression; empty: all are known
};
/// Scanner floor and performer floor, from anchor rows.
[[nodiscard]] std::vector<Anchor> anchors_of(std::span<const CaseRow> rows,
                                             std::span<const facs::Expression> expressions);

}  // namespace mimik::evaluation
