#include "animation/dense_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/animation/analytic_smile.h"

namespace mimik::animation {
namespace {

using geometry::Point;
using geometry::Vector;

class DenseField : public AnalyticSmile {};

TEST_F(DenseField, a_dense_model_moves_a_face_of_other_size_part_of_the_way_to_its_own_smile) {
    const auto dense = smile(modeling::ModelOptions{});
    const PreparedTarget target(target_->neutral);
    const WeightedExpression weighted{&dense, 1.0};
    AnimatedFace still;
    still.field = geometry::DisplacementField::still(target_->neutral.grid.size());
    const double nothing_mm = smile_error_mm(still, target_->neutral, 1.1, 6.0);
    const double dense_mm = smile_error_mm(animate(target, std::span(&weighted, 1)), target_->neutral, 1.1, 6.0);
    // This smile slides along skin that is nearly flat, and hardly 12 mm about the corners: only the landmarks show it.
    EXPECT_LT(dense_mm, 0.6 * nothing_mm);
}

TEST_F(DenseField, a_dense_model_fades_to_nothing_beyond_the_face) {
    const auto dense = smile(modeling::ModelOptions{});
    const auto& average = average_->grid;
    double lowest = 1e9;
    for (std::size_t v = 0; v < average.size(); ++v)
        if (average.inside(v)) lowest = std::min(lowest, average.vertices_mm[v].y());
    // A head with a collar: a plate far below the chin.
    auto mesh = geometry::to_mesh(target_->neutral.grid);
    const auto on_face = static_cast<std::uint32_t>(mesh.vertices_mm.size());
    const auto scan_from_average = target_->neutral.average_from_scan.inverse();
    for (const auto& [x, y] : {std::pair(-40.0, -60.0), std::pair(40.0, -60.0), std::pair(0.0, -90.0)})
        mesh.vertices_mm.emplace_back(scan_from_average * Point(x, lowest + y, -30.0));
    mesh.faces.add(std::array{on_face, on_face + 2, on_face + 1});
    mesh.texture_coordinates.clear();
    mesh.attributes.clear();
    const WeightedExpression weighted{&dense, 1.0};
    const auto moved = animate_mesh(mesh, target_->neutral.landmarks, *average_, std::span(&weighted, 1));
    double most = 0;
    for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v) {
        const double way = (moved.vertices_mm[v] - mesh.vertices_mm[v]).norm();
        if (v >= on_face) {
            EXPECT_EQ(way, 0.0);
        }
        most = std::max(most, way);
    }
    EXPECT_GT(most, 3.0);  // half of the smile
}

TEST_F(DenseField, an_expression_of_the_upper_face_holds_the_mouth_still_whatever_its_scan_did) {
    // The scan smiles, and is said to be of AU 4.
    const auto frown = smile(modeling::ModelOptions{}, "4");
    ASSERT_TRUE(frown.moves_upper_face && !frown.moves_lower_face);
    const PreparedTarget target(target_->neutral);
    const auto all = dense_field(target, *frown.dense);
    const auto field = expression_field(target, frown, {});
    const auto& surface = target.surface();
    const double lip_y = surface.landmarks.position_mm("upper_lip_outer").y();
    double before = 0, after = 0;
    for (std::size_t v = 0; v < field.size(); ++v) {
        if (!surface.present[v] || surface.vertices_mm[v].y() > lip_y - 5) continue;  // the scan may lean
        before = std::max(before, all.mm[v].norm());
        after = std::max(after, field.mm[v].norm());
    }
    EXPECT_GT(before, 1.0);
    EXPECT_EQ(after, 0.0);
}

TEST_F(DenseField, one_side_of_a_smile_leaves_the_other_corner_still) {
    const auto dense = smile(modeling::ModelOptions{}, "12L");
    const auto field = dense_field(PreparedTarget(target_->neutral), *dense.dense);
    const auto largest_near = [&](const char* mark) {
        const Point& at = target_->neutral.landmarks.position_mm(mark);
        double largest = 0;
        for (std::size_t v = 0; v < field.size(); ++v)
            if ((target_->neutral.grid.vertices_mm[v] - at).norm() < 8) largest = std::max(largest, field.mm[v].norm());
        return largest;
    };
    EXPECT_GT(largest_near("mouth_corner_left"), 3.0);
    EXPECT_LT(largest_near("mouth_corner_right"), 0.05);
}

}  // namespace
}  // namespace mimik::animation
