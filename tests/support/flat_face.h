#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/estimator.h"

namespace mimik::test {

/// A flat face in the scanner's frame, vertices 1 mm apart, x -40 ... 40, y -30 ... 60, at z = 0. The mouth lies at
/// y = 0, 50 mm wide, so the face's up axis is +y.
struct FlatFace {
    static constexpr int half_width = 40, lowest = -30, highest = 60;

    /// @param of  what stands at a place; empty: measured everywhere
    static geometry::QuadGrid grid(const std::function<geometry::VertexOrigin(int x, int y)>& of = {}) {
        geometry::QuadGrid grid;
        grid.rows = highest - lowest + 1;
        grid.cols = 2 * half_width + 1;
        for (int y = lowest; y <= highest; ++y)
            for (int x = -half_width; x <= half_width; ++x) {
                const auto origin = of ? of(x, y) : geometry::VertexOrigin::measured;
                grid.origin.push_back(origin);
                grid.vertices_mm.emplace_back(x, y, origin == geometry::VertexOrigin::outside ? NAN : 0.0);
            }
        return grid;
    }
    static std::uint32_t vertex(int x, int y) {
        return static_cast<std::uint32_t>((y - lowest) * (2 * half_width + 1) + x + half_width);
    }
    /// @param gap_mm  between the inner lips; half of it above y = 0
    static geometry::Landmarks landmarks(double gap_mm = 0) {
        std::vector<geometry::Landmark> marks;
        for (const double side : {-1.0, 1.0}) {
            const std::string of_side = side < 0 ? "_right" : "_left";
            marks.push_back({"eye_outer" + of_side, {side * 35, 40, 0}, ""});
            marks.push_back({"eye_inner" + of_side, {side * 15, 40, 0}, ""});
            marks.push_back({"mouth_corner" + of_side, {side * 25, 0, 0}, ""});
        }
        marks.push_back({"nose_tip", {0, 20, 15}, ""});
        marks.push_back({"upper_lip_outer", {0, 7.5, 0}, ""});
        marks.push_back({"upper_lip_inner", {0, gap_mm / 2, 0}, ""});
        marks.push_back({"lower_lip_inner", {0, -gap_mm / 2, 0}, ""});
        marks.push_back({"lower_lip_outer", {0, -7.5, 0}, ""});
        return geometry::Landmarks(std::move(marks));
    }
    /// One vector per vertex, answered everywhere.
    static geometry::DisplacementField field(const std::function<geometry::Vector(double x, double y)>& of) {
        auto field = geometry::DisplacementField::still(grid().size());
        for (int y = lowest; y <= highest; ++y)
            for (int x = -half_width; x <= half_width; ++x) field.mm[vertex(x, y)] = of(x, y);
        return field;
    }
    /// The zone is 60 mm wide and 40 mm high about the mouth.
    static evaluation::ScoredTarget target(const geometry::FaceSurface& neutral, const geometry::QuadGrid& expressive) {
        geometry::VertexMask zone(neutral.size(), 0);
        for (int y = -20; y <= 20; ++y)
            for (int x = -30; x <= 30; ++x) zone[vertex(x, y)] = 1;
        return evaluation::scored_target(neutral, expressive, geometry::Transform::Identity(), zone);
    }
};

/// What an estimator says of a region and a metric; empty: nothing.
inline std::optional<double> measured(const evaluation::Estimator& estimator, const evaluation::JudgedFace& face,
                                      const std::string& region, const std::string& metric) {
    for (const auto& measure : estimator.measure(face))
        if (measure.region == region && measure.metric == metric) return measure.value;
    return std::nullopt;
}

}  // namespace mimik::test
