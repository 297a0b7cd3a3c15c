#include "evaluation/anchors.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "evaluation/scored_target.h"

namespace mimik::evaluation {
namespace {

/// Mean distance of one scan's vertices to the surface of another, in the zone and on the whole face.
void add_rows(std::vector<CaseRow>& rows, const CaseKey& key, const ScoredTarget& scored) {
    double zone_mm = 0, face_mm = 0;
    for (std::size_t k = 0; k < scored.vertices.size(); ++k) {
        face_mm += scored.nothing_mm[k];
        if (scored.in_zone[k]) zone_mm += scored.nothing_mm[k];
    }
    const auto add = [&](const char* region, double sum_mm, std::size_t count) {
        if (count > 0)
            rows.push_back({key, "surface_distance", region, "mean", sum_mm / static_cast<double>(count), "mm", ""});
    };
    add("zone", zone_mm, scored.zone_size());
    add("face", face_mm, scored.vertices.size());
}

/// The vertices of `first` to the surface of `second`.
ScoredTarget between(const preprocessing::Face& first, const preprocessing::Face& second,
                     const geometry::Transform& first_from_second, const Cast& cast,
                     const preprocessing::AverageFace& average) {
    return scored_target(geometry::face_surface(first.grid, first.landmarks), second.grid, first_from_second,
                         carry_zone(cast.zone, average, first));
}

Anchor anchor_of(std::span<const CaseRow> rows, std::span<const facs::Expression> expressions, const char* method,
                 const char* title, const char* reason) {
    Anchor anchor;
    anchor.method = method;
    anchor.title = title;
    for (const auto& row : rows) {
        if (row.key.method != method || row.region != "zone" || !row.value) continue;
        anchor.mm[row.key.expression] += *row.value;
        ++anchor.targets[row.key.expression];
    }
    for (auto& [expression, mm] : anchor.mm) mm /= static_cast<double>(anchor.targets.at(expression));
    std::vector<std::string> missing;
    for (const auto& expression : expressions)
        if (!anchor.mm.contains(expression.code())) missing.push_back(expression.code());
    if (missing.size() == expressions.size())
        anchor.unknown = reason;
    else if (!missing.empty())
        anchor.unknown = fmt::format("of {}: {}", fmt::join(missing, ", "), reason);
    return anchor;
}

}  // namespace

std::vector<CaseRow> anchor_rows(const PerformanceReader& reader, const Cast& cast, std::size_t t,
                                 FailureList& failures) {
    const auto& id = cast.participants[t];
    const auto& average = reader.workspace().average();
    std::vector<CaseRow> rows;
    const auto key = [&](const char* method) { return CaseKey{"", id.subject, cast.expression.code(), method}; };
    const auto add = [&](const char* method, const database::ScanId& first, bool first_asks) {
        try {
            const auto pair = reader.second_scan(first);
            if (!pair) return;
            const geometry::Transform second_from_first = pair->first_from_second.inverse();
            add_rows(rows, key(method),
                     first_asks ? between(pair->first, pair->second, pair->first_from_second, cast, average)
                                : between(pair->second, pair->first, second_from_first, cast, average));
        } catch (const std::exception& e) {
            failures.add(fmt::format("{}: no {} of {}: {}", cast.expression.code(), method, id.subject, e.what()));
        }
    };
    add(scanner_floor, reader.workspace().neutral(id.subject), true);
    add(performer_floor, id, false);
    return rows;
}

std::vector<Anchor> anchors_of(std::span<const CaseRow> rows, std::span<const facs::Expression> expressions) {
    return {anchor_of(rows, expressions, scanner_floor, "scanner floor",
                      "nobody has a second neutral scan that can be used"),
            anchor_of(rows, expressions, performer_floor, "performer floor",
                      "nobody has a second scan of the expression that can be used")};
}

}  // namespace mimik::evaluation
