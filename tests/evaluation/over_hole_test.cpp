#include "evaluation/over_hole.h"

#include <gtest/gtest.h>

#include "tests/support/flat_face.h"

namespace mimik::evaluation {
namespace {

using geometry::DisplacementField;
using geometry::Vector;
using geometry::VertexOrigin;
using test::FlatFace;

/// The real scan is flat with an open mouth: 25 x 17 vertices are missing, so its quads end at |x| = 13 and |y| = 9.
class OverHole : public testing::Test {
protected:
    explicit OverHole(VertexOrigin there = VertexOrigin::outside)
        : open_(FlatFace::grid([there](int x, int y) {
              return std::abs(x) <= 12 && std::abs(y) <= 8 ? there : VertexOrigin::measured;
          })) {}
    [[nodiscard]] std::optional<double> count(const DisplacementField& field, const geometry::QuadGrid& real,
                                              const std::string& region = "face") const {
        const auto target = FlatFace::target(neutral_, real);
        return test::measured(*over_hole_estimator(), {target, neutral_, field}, region, "vertices");
    }
    [[nodiscard]] DisplacementField still() const { return DisplacementField::still(neutral_.size()); }
    geometry::FaceSurface neutral_ = geometry::face_surface(FlatFace::grid(), FlatFace::landmarks());
    geometry::QuadGrid open_;
};

TEST_F(OverHole, a_closed_mouth_over_an_open_one_counts_what_lies_farther_than_one_and_a_half_mm_from_the_border) {
    EXPECT_EQ(count(still(), open_), 23 * 15);           // |x| <= 11, |y| <= 7: 2 mm and more
    EXPECT_EQ(count(still(), open_, "mouth"), 23 * 15);  // the red ends at |y| = 7.5
}

TEST_F(OverHole, parted_lips_leave_it_free_and_a_web_is_counted) {
    const auto parted = FlatFace::field([](double, double y) { return Vector(0, y < 0 ? -9 : 9, 0); });
    EXPECT_EQ(count(parted, open_), 0);
    // Sewn: y goes to 1.5 y, and 9 - 1.5 |y| > 1.5 for |y| <= 4.
    const auto web = FlatFace::field([](double, double y) { return Vector(0, 0.5 * y, 0); });
    EXPECT_EQ(count(web, open_), 23 * 9);
    EXPECT_EQ(count(web, open_, "mouth"), 23 * 9);
}

TEST_F(OverHole, what_was_bridged_is_a_hole_and_what_the_neutral_scan_did_not_measure_does_not_count) {
    const auto bridged = FlatFace::grid([](int x, int y) {
        return std::abs(x) <= 12 && std::abs(y) <= 8 ? VertexOrigin::bridged : VertexOrigin::measured;
    });
    EXPECT_EQ(count(still(), bridged), 23 * 15);
    for (int x = -FlatFace::half_width; x <= FlatFace::half_width; ++x) neutral_.measured[FlatFace::vertex(x, 0)] = 0;
    EXPECT_EQ(count(still(), bridged), 23 * 14);
}

TEST_F(OverHole, the_outline_is_no_hole_nor_is_a_gap_that_opens_to_it) {
    const auto beside = FlatFace::field([](double, double) { return Vector(30, 0, 0); });
    EXPECT_EQ(count(beside, FlatFace::grid()), 0);
    const auto notch = FlatFace::grid(
        [](int x, int y) { return x > -12 && std::abs(y) <= 8 ? VertexOrigin::outside : VertexOrigin::measured; });
    EXPECT_EQ(count(still(), notch), 0);
}

TEST_F(OverHole, a_pinhole_under_lifted_skin_is_none) {
    const auto lifted = FlatFace::field([](double, double) { return Vector(0, 0, 3); });
    const auto pinhole =
        FlatFace::grid([](int x, int y) { return x == 0 && y == 0 ? VertexOrigin::outside : VertexOrigin::measured; });
    EXPECT_EQ(count(lifted, pinhole), 0);  // 4 mm^2
    const auto larger = FlatFace::grid([](int x, int y) {
        return std::abs(x) <= 1 && std::abs(y) <= 1 ? VertexOrigin::outside : VertexOrigin::measured;
    });
    EXPECT_EQ(count(lifted, larger), 25);  // 16 mm^2: all above it or above its border, |x|, |y| <= 2
}

TEST_F(OverHole, without_landmarks_of_the_mouth_the_face_alone_is_told) {
    neutral_.landmarks = {};
    EXPECT_EQ(count(still(), open_), 23 * 15);
    EXPECT_EQ(count(still(), open_, "mouth"), std::nullopt);
}

}  // namespace
}  // namespace mimik::evaluation
