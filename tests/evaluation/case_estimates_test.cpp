#include "evaluation/case_estimates.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "geometry/quad_grid.h"

namespace mimik::evaluation {
namespace {

using geometry::Point;
using geometry::Vector;

constexpr int size = 31;
constexpr double rounding = 1e-12;  // of coordinates up to 30 mm

/// A grid of 31 x 31 vertices, 1 mm apart, at the heights that `height` says; its middle is at the origin.
template <class Height>
geometry::QuadGrid grid_of(const Height& height, double shift_x = 0) {
    geometry::QuadGrid grid;
    grid.rows = grid.cols = size;
    for (int row = 0; row < size; ++row)
        for (int col = 0; col < size; ++col) {
            const double x = col - size / 2 + shift_x, y = row - size / 2;
            grid.vertices_mm.emplace_back(x, y, height(x, y));
            grid.origin.push_back(geometry::VertexOrigin::measured);
        }
    return grid;
}
double flat(double, double) { return 0; }

/// A flat neutral face, and a real one of any shape. The zone is the middle square of 21 x 21 vertices: nothing that is
/// moved by 2 mm leaves the real surface there.
class Estimates : public testing::Test {
protected:
    void real_is(const geometry::QuadGrid& real) {
        neutral_ = geometry::face_surface(grid_of(flat), {});
        scored_ = {};
        scored_.expressive.emplace(real.vertices_mm, geometry::triangles(real));
        geometry::VertexMask zone(neutral_.size(), 0);
        for (std::uint32_t v = 0; v < neutral_.size(); ++v) {
            zone[v] = neutral_.vertices_mm[v].head<2>().cwiseAbs().maxCoeff() <= 10 ? 1 : 0;
            scored_.vertices.push_back(v);
            scored_.in_zone.push_back(zone[v]);
            scored_.nothing_mm.push_back(0);
        }
        target_.emplace(scored_, neutral_, RegionMasks{{"zone", zone}});
    }
    [[nodiscard]] geometry::DisplacementField everywhere(const Vector& way) const {
        return {std::vector<Vector>(neutral_.size(), way), geometry::VertexMask(neutral_.size(), 1)};
    }
    [[nodiscard]] double value(const geometry::DisplacementField& field, const std::string& estimator,
                               const std::string& metric = "mean", bool area_weighted = false) {
        const JudgedFace face{scored_, neutral_, field};
        CaseEstimates estimates(*target_, face);
        for (const auto& measure : estimates.measure(estimator_by_name(estimator), {{metric}, area_weighted}))
            if (measure.metric == metric) return measure.value.value();
        return std::numeric_limits<double>::quiet_NaN();
    }
    geometry::FaceSurface neutral_;
    ScoredTarget scored_;
    std::optional<EstimatedTarget> target_;
};

TEST_F(Estimates, a_plane_moved_outward_by_1_mm_is_off_by_plus_1_and_inward_by_minus_1) {
    real_is(grid_of(flat));
    EXPECT_NEAR(value(everywhere({0, 0, 1}), "signed"), 1, rounding);
    EXPECT_NEAR(value(everywhere({0, 0, -1}), "signed"), -1, rounding);
    EXPECT_NEAR(value(everywhere({0, 0, -1}), "signed", "mean_absolute"), 1, rounding);
    EXPECT_NEAR(value(everywhere({0, 0, -1}), "along-normal/signed"), -1, rounding);
    EXPECT_NEAR(value(everywhere({0, 0, 1}), "normal-angle"), 0, rounding);
    for (const auto* name : {"point-to-surface", "point-to-point", "along-normal", "reverse"})
        EXPECT_NEAR(value(everywhere({0, 0, 1}), name), 1, rounding) << name;
    EXPECT_NEAR(value(everywhere({0, 0, 1}), "hausdorff", "max"), 1, rounding);
}

TEST_F(Estimates, sliding_by_half_a_cell_shows_in_points_and_in_the_truth_and_not_in_the_surface) {
    real_is(grid_of(flat));
    const auto slid = everywhere({0.5, 0, 0});
    for (const auto* name : {"point-to-surface", "along-normal", "signed", "normal-angle"})
        EXPECT_NEAR(value(slid, name), 0, rounding) << name;
    EXPECT_NEAR(value(slid, "point-to-point"), 0.5, rounding);
    EXPECT_TRUE(std::isnan(value(slid, "true")));  // nobody knows the truth yet
    target_->true_places = target_->registered_places =
        SkinPlaces{{}, geometry::VertexMask(target_->vertices().size(), 1)};
    for (const auto v : target_->vertices()) {
        target_->true_places->place_mm.push_back(neutral_.vertices_mm[v]);
        target_->registered_places->place_mm.emplace_back(neutral_.vertices_mm[v] + Vector(0.5, 0, 0));
    }
    EXPECT_NEAR(value(slid, "true"), 0.5, rounding);
    EXPECT_NEAR(value(slid, "true/signed"), 0, rounding);
    EXPECT_NEAR(value(slid, "registered"), 0, rounding);
    EXPECT_NEAR(value(everywhere({0, 0, 0}), "registered"), 0.5, rounding);
}

TEST_F(Estimates, a_vertex_whose_place_is_not_known_does_not_count_and_the_coverage_says_so) {
    real_is(grid_of(flat));
    target_->registered_places = SkinPlaces{{}, {}};
    for (std::size_t k = 0; k < target_->vertices().size(); ++k) {
        target_->registered_places->place_mm.push_back(neutral_.vertices_mm[target_->vertices()[k]]);
        target_->registered_places->known.push_back(k < 21 ? 0 : 1);  // one of 21 rows
    }
    EXPECT_NEAR(value(everywhere({0, 0, 1}), "registered"), 1, rounding);
    EXPECT_DOUBLE_EQ(value(everywhere({0, 0, 1}), "registered", "coverage"), 20.0 / 21.0);
    EXPECT_NEAR(value(everywhere({0, 0, 1}), "registered", "n"), 420, rounding);
    EXPECT_NEAR(value(everywhere({0, 0, 1}), "point-to-surface", "coverage"), 1, rounding);
}

TEST_F(Estimates, a_shifted_grid_of_the_same_plane_is_off_by_its_shift_in_points_alone) {
    real_is(grid_of(flat, 0.25));
    EXPECT_NEAR(value(everywhere({0, 0, 0}), "point-to-surface"), 0, rounding);
    EXPECT_NEAR(value(everywhere({0, 0, 0}), "point-to-point"), 0.25, rounding);
}

TEST_F(Estimates, a_plane_tilted_by_ten_degrees_has_normals_ten_degrees_off) {
    const double slope = std::tan(10.0 * std::numbers::pi / 180);
    real_is(grid_of([&](double x, double) { return slope * x; }));
    EXPECT_NEAR(value(everywhere({0, 0, 0}), "normal-angle"), 10, 1e-9);
    EXPECT_NEAR(value(everywhere({0, 0, 0}), "normal-angle", "max"), 10, 1e-9);
    // The error is |x| sin(10 degrees); over x from -10 to 10 its mean is 110 / 21 times that.
    EXPECT_NEAR(value(everywhere({0, 0, 0}), "signed", "mean_absolute"),
                110.0 / 21 * std::sin(10.0 * std::numbers::pi / 180), 1e-9);
}

TEST_F(Estimates, a_plane_before_a_sphere_lacks_the_curvature_of_the_sphere) {
    const double radius = 60;
    real_is(grid_of([&](double x, double y) { return std::sqrt(radius * radius - x * x - y * y) - radius; }));
    // 1 / 60 mm = 16.7 / m. A quadric over 5 mm of a sphere of 60 is off by (5 / 60)^2, 0.7 %; at the corners of the
    // zone the nearest point lies at 14 mm from the axis, where fits still have all their points.
    EXPECT_NEAR(value(everywhere({0, 0, 0}), "curvature"), 1000 / radius, 0.02 * 1000 / radius);
    auto bent = everywhere({0, 0, 0});
    for (std::size_t v = 0; v < bent.size(); ++v) bent.mm[v].z() = scored_.expressive->vertices_mm()[v].z();
    EXPECT_NEAR(value(bent, "curvature"), 0, 1e-6);  // the same vertices, in another order of sums
}

TEST_F(Estimates, a_step_that_one_side_alone_has_shows_in_the_direction_that_asks_from_there) {
    // The real face has a dent of 3 mm, 4 mm wide and steep; a flat face comes near its rim and bottom alike.
    real_is(grid_of([](double x, double) { return std::abs(x) < 2 ? -3.0 : 0.0; }));
    const auto still = everywhere({0, 0, 0});
    EXPECT_NEAR(value(still, "reverse", "max"), 3, rounding);
    EXPECT_LT(value(still, "point-to-surface", "max"), 3);
    EXPECT_NEAR(value(still, "hausdorff", "max"), 3, rounding);
    // Along the normal it looks straight down.
    EXPECT_NEAR(value(still, "along-normal", "max"), 3, rounding);
}

TEST_F(Estimates, nothing_along_the_normal_within_10_mm_leaves_vertices_out) {
    real_is(grid_of([](double x, double) { return x < 0 ? 0.0 : -20.0; }));
    EXPECT_LT(value(everywhere({0, 0, 0}), "along-normal", "coverage"), 0.6);
    EXPECT_NEAR(value(everywhere({0, 0, 0}), "along-normal", "median"), 0, rounding);
}

TEST_F(Estimates, a_vertex_without_an_answer_is_measured_where_it_is) {
    real_is(grid_of([](double, double) { return 2.0; }));
    auto field = everywhere({0, 0, 2});
    EXPECT_NEAR(value(field, "point-to-surface"), 0, rounding);
    field.answered.assign(field.size(), 0);
    EXPECT_NEAR(value(field, "point-to-surface"), 2, rounding);
    EXPECT_NEAR(value(field, "signed"), -2, rounding);
}

TEST_F(Estimates, point_to_surface_is_to_the_bit_what_every_experiment_has_as_surface_distance) {
    real_is(grid_of([](double x, double y) { return 1.5 + std::sin(0.3 * x) * std::cos(0.2 * y); }));
    auto field = everywhere({0.1, -0.2, 0.7});
    for (std::size_t v = 0; v < field.size(); v += 3) field.mm[v].setZero();
    std::size_t k = 0;
    for (const auto& hit : scored_.expressive->closest(neutral_.vertices_mm)) scored_.nothing_mm[k++] = hit.distance_mm;
    EXPECT_EQ(value(field, "point-to-surface"), distances_to_real_scan({scored_, neutral_, field}).zone_mm);
}

TEST_F(Estimates, area_weights_count_a_steep_part_for_what_it_is) {
    real_is(grid_of(flat));
    // Right of x = 0 the neutral face is steep: four times the area per vertex, and the whole error.
    for (auto& p : neutral_.vertices_mm) p.z() = p.x() > 0 ? std::sqrt(15.0) * p.x() : 0;
    const auto zone = target_->regions();
    target_.emplace(scored_, neutral_, zone);
    auto field = everywhere({0, 0, 0});
    for (std::size_t v = 0; v < field.size(); ++v)
        field.mm[v].z() = (neutral_.vertices_mm[v].x() > 0 ? 1 : 0) - neutral_.vertices_mm[v].z();
    EXPECT_NEAR(value(field, "point-to-surface"), 10.0 / 21, 1e-12);
    // Columns: 10 flat of area 1, one between of 2.5, 10 steep of 4.
    EXPECT_NEAR(value(field, "point-to-surface", "mean", true), 40 / 52.5, 1e-12);
}

}  // namespace
}  // namespace mimik::evaluation
