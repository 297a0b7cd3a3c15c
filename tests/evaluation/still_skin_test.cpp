#include "evaluation/still_skin.h"

#include <gtest/gtest.h>

#include "tests/support/flat_face.h"

namespace mimik::evaluation {
namespace {

using geometry::Vector;
using test::FlatFace;

/// The truth moves the lower half of the face, y < 0, by 5 mm, and the rest by 0.09 mm: less than 2 % of it.
class StillSkin : public testing::Test {
protected:
    StillSkin() {
        for (const auto v : target_.vertices) {
            const auto& p = neutral_.vertices_mm[v];
            target_.true_displacement_mm.emplace_back(0, 0, p.y() < 0 ? 5 : 0.09);
        }
        target_.still = still_by_truth(target_.true_displacement_mm);
    }
    [[nodiscard]] std::optional<double> mean_mm(const geometry::DisplacementField& field) const {
        return test::measured(*still_skin_estimator(), {target_, neutral_, field}, "face", "mean");
    }
    geometry::FaceSurface neutral_ = geometry::face_surface(FlatFace::grid(), FlatFace::landmarks());
    ScoredTarget target_ = FlatFace::target(neutral_, FlatFace::grid());
};

TEST_F(StillSkin, of_a_shifted_field_moves_by_the_shift) {
    EXPECT_NEAR(*mean_mm(FlatFace::field([](double, double) { return Vector(0.3, 0.4, 0); })), 0.5, 1e-12);
}

TEST_F(StillSkin, does_not_move_where_only_moving_skin_does) {
    EXPECT_EQ(mean_mm(FlatFace::field([](double, double y) { return Vector(0, 0, y < 0 ? 9 : 0); })), 0);
    EXPECT_EQ(mean_mm(geometry::DisplacementField::still(neutral_.size())), 0);
}

TEST_F(StillSkin, counts_a_vertex_without_an_answer_as_holding_still) {
    auto field = FlatFace::field([](double, double) { return Vector(0, 0, 1); });
    for (std::size_t v = 0; v < field.size(); ++v) field.answered[v] = neutral_.vertices_mm[v].x() < 0 ? 1 : 0;
    EXPECT_NEAR(*mean_mm(field), 39.0 / 79.0, 1e-12);  // columns -39 ... 39: at the outline nothing is scored
}

TEST_F(StillSkin, is_unknown_where_all_skin_moves) {
    for (auto& way : target_.true_displacement_mm) way = Vector(0, 0, 5);
    target_.still = still_by_truth(target_.true_displacement_mm);
    EXPECT_EQ(mean_mm(geometry::DisplacementField::still(neutral_.size())), std::nullopt);
    target_.still = {};
    EXPECT_EQ(mean_mm(geometry::DisplacementField::still(neutral_.size())), std::nullopt);
}

/// The real scan is the neutral one, but for the skin about (-20, 50) that stands 2 mm higher, far off the zone, which
/// ends at y = 20.
TEST(StillSkinWithoutTruth, is_where_the_real_scan_lies_on_the_neutral_one_all_around_and_off_the_zone) {
    const auto neutral = geometry::face_surface(FlatFace::grid(), FlatFace::landmarks());
    auto real = FlatFace::grid();
    for (auto& p : real.vertices_mm)
        if (std::abs(p.x() + 20) <= 5 && std::abs(p.y() - 50) <= 5) p.z() = 2;
    auto target = FlatFace::target(neutral, real);
    target.still = still_by_scans(neutral, target);
    const auto still = [&](int x, int y) {
        for (std::size_t k = 0; k < target.vertices.size(); ++k)
            if (target.vertices[k] == FlatFace::vertex(x, y)) return target.still[k] != 0;
        return false;
    };
    EXPECT_TRUE(still(20, 50));
    EXPECT_FALSE(still(20, 39));   // 19 mm off the zone
    EXPECT_TRUE(still(20, 41));    // 21 mm
    EXPECT_FALSE(still(-20, 50));  // it moved
    EXPECT_FALSE(still(-14, 50));  // beside it: of 15 x 15 vertices about it 7 x 11 moved, by 2 mm
    EXPECT_TRUE(still(-5, 50));    // 10 mm beside it
    const auto shifted = FlatFace::field([](double, double) { return Vector(0.3, 0.4, 0); });
    EXPECT_NEAR(*test::measured(*still_skin_estimator(), {target, neutral, shifted}, "face", "mean"), 0.5, 1e-12);
    auto mesh = neutral;
    mesh.grid.reset();
    EXPECT_TRUE(still_by_scans(mesh, target).empty());
}

}  // namespace
}  // namespace mimik::evaluation
