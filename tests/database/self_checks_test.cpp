#include "database/self_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "database/doctor.h"
#include "database/one_sided_codes.h"
#include "tests/database/made_face.h"

namespace mimik::database {
namespace {

std::optional<TextureOrientation> orientation(const MadeFace& face) {
    const auto labelled = to_bosphorus_labels(face.landmarks);
    return texture_orientation(face.scan, labelled, nearest_scan_points(face.scan, labelled), face.image_landmarks,
                               {face.image_size, face.image_size});
}

TEST(TextureOrientation, a_right_texture_is_found_right_without_error) {
    const auto found = orientation(make_face());
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->as_expected());
    EXPECT_EQ(found->landmarks, 22);
    EXPECT_LT(found->median_error_px[0], 1e-9);  // landmarks are grid vertices: rounding only
}

TEST(TextureOrientation, each_variant_is_recognised_and_turned_back) {
    const auto right = make_face();
    // What a file of the variant stores for a point whose right texture coordinate is t.
    const std::vector<std::pair<TextureAxes, std::function<geometry::TextureCoordinate(geometry::TextureCoordinate)>>>
        variants = {
            {TextureAxes::u_right_v_down, [](auto t) { return geometry::TextureCoordinate(t.x(), 1 - t.y()); }},
            {TextureAxes::u_down_v_left, [](auto t) { return geometry::TextureCoordinate(1 - t.y(), 1 - t.x()); }},
            {TextureAxes::u_up_v_left, [](auto t) { return geometry::TextureCoordinate(t.y(), 1 - t.x()); }}};
    for (const auto& [axes, stored] : variants) {
        MadeFace face = right;
        for (auto& t : face.scan.texture_coordinates) t = stored(t);
        const auto found = orientation(face);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->best, axes) << to_string(axes);
        EXPECT_TRUE(found->fits);
        EXPECT_FALSE(found->as_expected());
        reorient_texture(face.scan, axes);
        for (std::size_t i = 0; i < face.scan.points_mm.size(); ++i)
            ASSERT_LT((face.scan.texture_coordinates[i] - right.scan.texture_coordinates[i]).norm(),
                      1e-12);  // 1 - (1 - t)
    }
}

TEST(TextureOrientation, a_texture_of_another_face_does_not_fit) {
    MadeFace face = make_face();
    for (auto& mark : face.image_landmarks) mark = {mark.label, 50, 50};
    const auto found = orientation(face);
    ASSERT_TRUE(found);
    EXPECT_FALSE(found->fits);
}

TEST(TextureOrientation, two_landmarks_decide_nothing) {
    MadeFace face = make_face();
    face.image_landmarks.resize(2);
    EXPECT_FALSE(orientation(face));
    face = make_face();
    face.scan.texture_coordinates.clear();
    EXPECT_FALSE(orientation(face));
}

TEST(FrameCorrelations, are_one_on_a_regular_grid_and_change_sign_when_mirrored) {
    MadeFace face = make_face();
    auto found = frame_correlations(face.scan);
    for (const auto& value : {found.x_u, found.y_v, found.y_row, found.x_column})
        EXPECT_NEAR(value.value(), 1, 1e-9);  // rounding
    for (auto& p : face.scan.points_mm) p.y() = -p.y();
    found = frame_correlations(face.scan);
    EXPECT_NEAR(found.y_row.value(), -1, 1e-9);
    EXPECT_NEAR(found.y_v.value(), -1, 1e-9);
    EXPECT_NEAR(found.x_u.value(), 1, 1e-9);
}

TEST(FrameCorrelations, of_a_bare_cloud_are_empty) {
    geometry::RangeScan cloud;
    cloud.points_mm = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
    EXPECT_FALSE(frame_correlations(cloud).x_u);
    EXPECT_FALSE(frame_correlations(cloud).y_row);
}

TEST(NearestScanPoint, skips_unmeasured_points) {
    geometry::RangeScan scan;
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    scan.points_mm = {{nothing, nothing, nothing}, {3, 4, 0}};
    const auto nearest = nearest_scan_points(scan, geometry::Landmarks({{"chin", {0, 0, 0}, ""}}));
    ASSERT_EQ(nearest.size(), 1U);
    EXPECT_EQ(nearest[0].index, 1U);
    EXPECT_DOUBLE_EQ(nearest[0].distance_mm, 5);
}

}  // namespace
}  // namespace mimik::database
