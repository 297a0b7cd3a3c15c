#include "evaluation/case_score.h"

#include "base/errors.h"

namespace mimik::evaluation {

using geometry::Point;
using geometry::Vector;

ScoredTarget scored_target(const geometry::QuadGrid& neutral, const geometry::QuadGrid& expressive,
                           const geometry::Transform& neutral_from_expressive, const std::vector<char>& zone) {
    ScoredTarget target;
    std::vector<Point> surface;
    surface.reserve(expressive.size());
    for (const auto& p : expressive.vertices_mm) surface.emplace_back(neutral_from_expressive * p);
    target.expressive.emplace(surface, geometry::triangles(expressive, geometry::BridgedVertices::leave_out));

    std::vector<std::uint32_t> measured;
    std::vector<Point> queries;
    for (std::uint32_t v = 0; v < neutral.size(); ++v)
        if (neutral.measured(v)) {
            measured.push_back(v);
            queries.push_back(neutral.vertices_mm[v]);
        }
    const auto hits = target.expressive->closest(queries);
    for (std::size_t k = 0; k < measured.size(); ++k) {
        if (target.expressive->on_border(hits[k])) continue;
        target.vertices.push_back(measured[k]);
        target.in_zone.push_back(zone[measured[k]]);
        target.nothing_mm.push_back(hits[k].distance_mm);
    }
    return target;
}

CaseResult judge_case(const ScoredTarget& target, const std::vector<Point>& animated_mm,
                      const std::vector<Vector>& displacement_mm, const geometry::QuadGrid& grid, bool whole_face) {
    CaseResult result;
    // A vertex that stays where it was, or was left out, has the distance of doing nothing: only the others are asked.
    std::vector<Point> queries;
    std::vector<std::size_t> asked, moved;
    std::vector<double> distance_mm;
    std::vector<char> left_out;
    for (std::size_t k = 0; k < target.vertices.size(); ++k) {
        if (!whole_face && !target.in_zone[k]) continue;
        const std::uint32_t v = target.vertices[k];
        const bool answered = animated_mm[v].allFinite() && displacement_mm[v].allFinite();
        if (!answered) {
            ++result.left_out;
        } else if (animated_mm[v] != grid.vertices_mm[v]) {
            moved.push_back(asked.size());
            queries.push_back(animated_mm[v]);
        }
        asked.push_back(k);
        left_out.push_back(answered ? 0 : 1);
        distance_mm.push_back(target.nothing_mm[k]);
    }
    const auto hits = target.expressive->closest(queries);
    for (std::size_t i = 0; i < moved.size(); ++i) distance_mm[moved[i]] = hits[i].distance_mm;
    double zone = 0, zone_nothing = 0, whole = 0, whole_nothing = 0, true_sum = 0, true_nothing = 0;
    std::size_t zone_count = 0;
    for (std::size_t i = 0; i < asked.size(); ++i) {
        const std::size_t k = asked[i];
        whole += distance_mm[i];
        whole_nothing += target.nothing_mm[k];
        if (!target.in_zone[k]) continue;
        ++zone_count;
        zone += distance_mm[i];
        zone_nothing += target.nothing_mm[k];
        if (!target.true_displacement_mm.empty()) {
            const Vector& way = displacement_mm[target.vertices[k]];
            true_sum += ((left_out[i] ? Vector(Vector::Zero()) : way) - target.true_displacement_mm[k]).norm();
            true_nothing += target.true_displacement_mm[k].norm();
        }
    }
    if (zone_count == 0)
        throw NumericalError(
            "no vertex of the active zone sees the real expressive scan: it does not lie on the neutral face there");
    const auto count = static_cast<double>(zone_count);
    result.zone_mm = zone / count;
    result.zone_nothing_mm = zone_nothing / count;
    if (whole_face && !asked.empty()) {
        result.whole_mm = whole / static_cast<double>(asked.size());
        result.whole_nothing_mm = whole_nothing / static_cast<double>(asked.size());
    }
    if (!target.true_displacement_mm.empty()) {
        result.true_mm = true_sum / count;
        result.true_nothing_mm = true_nothing / count;
    }
    return result;
}

void ScoreSum::add(const CaseResult& result) {
    ++sums_.cases;
    error_ += result.zone_mm;
    nothing_ += result.zone_nothing_mm;
    whole_ += result.whole_mm;
    whole_nothing_ += result.whole_nothing_mm;
    if (result.step_mm) {
        steps_ += *result.step_mm;
        ++with_step_;
    }
    sums_.left_out_vertices += result.left_out;
    if (result.true_mm >= 0) {
        true_error_ += result.true_mm;
        true_nothing_ += result.true_nothing_mm;
        ++with_truth_;
    }
    if (result.zone_nothing_mm > 0) explained_.add(1 - result.zone_mm / result.zone_nothing_mm);
    if (result.zone_mm > result.zone_nothing_mm) ++sums_.worse_than_nothing;
}

Score ScoreSum::score() const {
    Score score = sums_;
    if (score.cases == 0) return score;
    const auto n = static_cast<double>(score.cases);
    score.explained = nothing_ > 0 ? 1 - error_ / nothing_ : 0;
    score.explained_median = explained_.median();
    score.explained_whole = whole_nothing_ > 0 ? 1 - whole_ / whole_nothing_ : 0;
    score.error_mm = error_ / n;
    score.nothing_mm = nothing_ / n;
    if (with_step_ > 0) score.largest_step_mm = steps_ / static_cast<double>(with_step_);
    if (with_truth_ > 0) {
        score.true_error_mm = true_error_ / static_cast<double>(with_truth_);
        score.nothing_true_mm = true_nothing_ / static_cast<double>(with_truth_);
    }
    return score;
}

}  // namespace mimik::evaluation
