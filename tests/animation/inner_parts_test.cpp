#include "animation/inner_parts.h"

#include <gtest/gtest.h>

#include "tests/support/analytic_face.h"

namespace mimik::animation {
namespace {

using geometry::Point;
using geometry::Vector;

/// Small blocks, each a part of its own, beside a sheet of skin that has the nose tip.
struct Head {
    geometry::Landmarks landmarks = test::AnalyticFace{}.landmarks();
    std::vector<Point> vertices_mm;
    std::vector<geometry::Triangle> triangles;
    std::vector<double> behind_mm;
    Head() { add(landmarks.position_mm("nose_tip"), 0.0); }
    /// @return its first vertex
    std::uint32_t add(const Point& at_mm, double behind) {
        const auto first = static_cast<std::uint32_t>(vertices_mm.size());
        for (const Vector& corner : {Vector(0, 0, 0), Vector(1, 0, 0), Vector(0, 1, 0)}) {
            vertices_mm.push_back(at_mm + corner);
            behind_mm.push_back(behind);
        }
        triangles.push_back({first, first + 1, first + 2});
        return first;
    }
    [[nodiscard]] Point middle(const char* a, const char* b) const {
        return (landmarks.position_mm(a) + landmarks.position_mm(b)) / 2;
    }
    [[nodiscard]] InnerParts parts() const { return find_inner_parts(vertices_mm, triangles, landmarks, behind_mm); }
};

TEST(InnerParts, eyeballs_and_teeth_are_found_behind_the_skin_and_lashes_are_skin) {
    Head head;
    const Point eye = head.middle("eye_outer_left", "eye_inner_left");
    const Point mouth = head.middle("mouth_corner_left", "mouth_corner_right");
    const auto ball = head.add(eye - Vector(0, 0, 12), 12), lash = head.add(eye, 0.5);
    const auto upper = head.add(mouth + Vector(0, 8, -10), 10), lower = head.add(mouth + Vector(0, -8, -10), 10);
    const auto collar = head.add(mouth + Vector(0, -90, -10), 10);
    const auto found = head.parts();
    EXPECT_EQ(found.eye_vertices, 3U);
    EXPECT_EQ(found.mouth_vertices, 6U);
    for (std::uint32_t k = 0; k < 3; ++k) {
        EXPECT_EQ(found.inside[ball + k], 1) << k;
        EXPECT_EQ(found.on_jaw[ball + k], 0) << k;
        EXPECT_EQ(found.inside[lash + k], 0) << k;
        EXPECT_EQ(found.on_jaw[upper + k], 0) << k;
        EXPECT_EQ(found.inside[upper + k], 1) << k;
        EXPECT_EQ(found.on_jaw[lower + k], 1) << k;
        EXPECT_EQ(found.inside[collar + k], 0) << k;
        EXPECT_EQ(found.inside[k], 0) << "the skin itself, " << k;
    }
}

TEST(InnerParts, a_mesh_in_one_piece_has_none) {
    Head head;
    EXPECT_TRUE(head.parts().empty());
}

TEST(InnerParts, a_jaw_opens_about_its_joints_and_never_closes_beyond_the_teeth) {
    const auto landmarks = test::AnalyticFace{}.landmarks();
    const Point chin = landmarks.position_mm("chin");
    const auto open = jaw_turn(landmarks, {0, -20, -5});
    const Vector way = open * chin - chin;
    EXPECT_LT(way.y(), -9);  // the chin turns as far as it was pulled, on its own circle
    EXPECT_LT(way.z(), 0);
    EXPECT_EQ(way.x(), 0);
    EXPECT_TRUE(jaw_turn(landmarks, {0, 6, 1}).isApprox(geometry::Transform::Identity()));
}

}  // namespace
}  // namespace mimik::animation
