#include "evaluation/estimator.h"

#include "base/errors.h"
#include "evaluation/lip_aperture.h"
#include "evaluation/over_hole.h"
#include "evaluation/peak.h"
#include "evaluation/still_skin.h"

namespace mimik::evaluation {

using geometry::Point;
using geometry::Vector;

namespace {

/// Whether the field says where vertex v goes.
bool answers(const geometry::DisplacementField& field, std::uint32_t v) {
    return field.answered[v] && field.mm[v].allFinite();
}

[[noreturn]] void refuse_empty_zone() {
    throw NumericalError(
        "no vertex of the active zone sees the real expressive scan: it does not lie on the neutral face there");
}

class SurfaceDistance : public Estimator {
public:
    [[nodiscard]] std::string name() const override { return "surface_distance"; }
    [[nodiscard]] std::vector<Measure> measure(const JudgedFace& face) const override {
        const auto distances = distances_to_real_scan(face);
        std::vector<Measure> measures = {{"zone", "mean", distances.zone_mm, "mm"}};
        if (distances.face_mm) measures.push_back({"face", "mean", distances.face_mm, "mm"});
        return measures;
    }
};

class TrueDistance : public Estimator {
public:
    [[nodiscard]] std::string name() const override { return "true_distance"; }
    [[nodiscard]] std::vector<Measure> measure(const JudgedFace& face) const override {
        const auto& target = face.target;
        if (target.true_displacement_mm.empty()) return {};
        double sum_mm = 0;
        for (std::size_t k = 0; k < target.vertices.size(); ++k) {
            if (!target.in_zone[k]) continue;
            sum_mm += (face.way_mm(target.vertices[k]) - target.true_displacement_mm[k]).norm();
        }
        const auto count = target.zone_size();
        if (count == 0) refuse_empty_zone();
        return {{"zone", "mean", sum_mm / static_cast<double>(count), "mm"}};
    }
};

/// What the field is like, whatever the real face did.
class FieldItself : public Estimator {
public:
    [[nodiscard]] std::string name() const override { return "field"; }
    [[nodiscard]] std::vector<Measure> measure(const JudgedFace& face) const override {
        const auto& target = face.target;
        std::size_t left_out = 0;
        for (std::size_t k = 0; k < target.vertices.size(); ++k)
            if ((target.whole_face || target.in_zone[k]) && !answers(face.field, target.vertices[k])) ++left_out;
        std::vector<Measure> measures = {
            {target.whole_face ? "face" : "zone", "left_out", static_cast<double>(left_out), "vertices"}};
        // A crack is a fault of a method.
        if (face.made_by_method)
            measures.push_back({"face", "largest_step",
                                geometry::field_extent(face.neutral, face.field.mm).largest_neighbour_step_mm, "mm"});
        return measures;
    }
};

}  // namespace

Vector JudgedFace::way_mm(std::uint32_t v) const { return answers(field, v) ? field.mm[v] : Vector(Vector::Zero()); }

SurfaceDistances distances_to_real_scan(const JudgedFace& face) {
    const auto& target = face.target;
    const auto& neutral = face.neutral;
    const auto& field = face.field;
    // A vertex that stays where it was, or has no answer, has the distance of doing nothing: only the others are asked.
    std::vector<Point> queries;
    std::vector<std::size_t> asked, moved;
    std::vector<double> distance_mm;
    for (std::size_t k = 0; k < target.vertices.size(); ++k) {
        if (!target.whole_face && !target.in_zone[k]) continue;
        const std::uint32_t v = target.vertices[k];
        const Point moved_mm = neutral.vertices_mm[v] + field.mm[v];
        if (answers(field, v) && moved_mm.allFinite() && moved_mm != neutral.vertices_mm[v]) {
            moved.push_back(asked.size());
            queries.push_back(moved_mm);
        }
        asked.push_back(k);
        distance_mm.push_back(target.nothing_mm[k]);
    }
    const auto hits = target.expressive->closest(queries);
    for (std::size_t i = 0; i < moved.size(); ++i) distance_mm[moved[i]] = hits[i].distance_mm;
    double zone_mm = 0, face_mm = 0;
    std::size_t zone_count = 0;
    for (std::size_t i = 0; i < asked.size(); ++i) {
        face_mm += distance_mm[i];
        if (!target.in_zone[asked[i]]) continue;
        ++zone_count;
        zone_mm += distance_mm[i];
    }
    if (zone_count == 0) refuse_empty_zone();
    SurfaceDistances distances;
    distances.zone_mm = zone_mm / static_cast<double>(zone_count);
    if (target.whole_face) distances.face_mm = face_mm / static_cast<double>(asked.size());
    return distances;
}

const std::vector<std::unique_ptr<const Estimator>>& known_estimators() {
    static const auto estimators = [] {
        std::vector<std::unique_ptr<const Estimator>> all;
        all.push_back(std::make_unique<SurfaceDistance>());
        all.push_back(std::make_unique<TrueDistance>());
        all.push_back(std::make_unique<FieldItself>());
        all.push_back(lip_aperture_estimator());
        all.push_back(still_skin_estimator());
        all.push_back(peak_estimator());
        all.push_back(over_hole_estimator());
        return all;
    }();
    return estimators;
}

}  // namespace mimik::evaluation
