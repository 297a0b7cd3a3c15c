#include "video/feature_blobs.h"

#include <gtest/gtest.h>

namespace mimik::video {
namespace {

void fill(FloatImage& image, int left, int top, int right, int bottom, float value) {
    for (int y = top; y <= bottom; ++y)
        for (int x = left; x <= right; ++x) image.values[static_cast<std::size_t>(y * image.width + x)] = value;
}

TEST(FeatureBlobs, a_rectangle_is_found_with_its_area_and_box) {
    FloatImage image(100, 60);
    fill(image, 30, 20, 59, 29, 1);
    const auto blob = feature_blob(image, {5, 5, 90, 50});
    ASSERT_TRUE(blob);
    EXPECT_EQ(blob->area_px, 300);  // 30 x 10
    EXPECT_EQ(blob->box.left, 30);
    EXPECT_EQ(blob->box.right, 59);
    EXPECT_EQ(blob->box.top, 20);
    EXPECT_EQ(blob->box.bottom, 29);
    EXPECT_NEAR(blob->middle.x(), 44.5, 1e-9);
    EXPECT_NEAR(blob->middle.y(), 24.5, 1e-9);
}

TEST(FeatureBlobs, of_two_the_larger_is_taken_and_what_lies_outside_the_rectangle_is_not_seen) {
    FloatImage image(100, 60);
    fill(image, 10, 10, 14, 14, 1);
    fill(image, 40, 30, 59, 39, 1);
    fill(image, 70, 0, 99, 59, 1);
    const auto blob = feature_blob(image, {0, 0, 65, 59});
    ASSERT_TRUE(blob);
    EXPECT_EQ(blob->area_px, 200);
    EXPECT_EQ(blob->box.left, 40);
}

TEST(FeatureBlobs, a_crack_of_two_pixels_is_closed) {
    FloatImage image(100, 60);
    fill(image, 20, 20, 39, 29, 1);
    fill(image, 42, 20, 61, 29, 1);
    const auto blob = feature_blob(image, {0, 0, 99, 59});
    ASSERT_TRUE(blob);
    EXPECT_EQ(blob->box.left, 20);
    EXPECT_EQ(blob->box.right, 61);
}

TEST(FeatureBlobs, where_nothing_stands_out_there_is_no_blob) {
    EXPECT_FALSE(feature_blob(FloatImage(50, 50), {5, 5, 45, 45}));
    EXPECT_FALSE(feature_blob(FloatImage(50, 50), {60, 60, 90, 90}));
}

}  // namespace
}  // namespace mimik::video
