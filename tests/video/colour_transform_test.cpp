#include "video/colour_transform.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "video/colour_network.h"

namespace mimik::video {
namespace {

io::Image skin_patch() {
    io::Image patch;
    patch.width = patch_width_px;
    patch.height = patch_height_px;
    for (int k = 0; k < patch.width * patch.height; ++k)
        for (const std::uint8_t c : {224, 182, 160}) patch.rgb.push_back(c);
    return patch;
}
void paint(io::Image& patch, const Pixel& from, const Pixel& to, const std::array<std::uint8_t, 3>& colour) {
    for (int y = static_cast<int>(from.y()); y <= static_cast<int>(to.y()); ++y)
        for (int x = static_cast<int>(from.x()); x <= static_cast<int>(to.x()); ++x)
            for (std::size_t c = 0; c < 3; ++c)
                patch.rgb[3 * static_cast<std::size_t>(y * patch.width + x) + c] = colour[c];
}

TEST(ColourTransform, channels_of_known_colours) {
    const auto red = channels_of(1, 0, 0);
    EXPECT_DOUBLE_EQ(red.magenta, 1);
    EXPECT_DOUBLE_EQ(red.black, 0);
    EXPECT_DOUBLE_EQ(red.hue_deg, 0);
    const auto half_blue = channels_of(0, 0, 0.5);
    EXPECT_DOUBLE_EQ(half_blue.value, 0.5);
    EXPECT_DOUBLE_EQ(half_blue.black, 0.5);
    EXPECT_DOUBLE_EQ(half_blue.hue_deg, 240);
    EXPECT_DOUBLE_EQ(half_blue.saturation, 1);
    EXPECT_DOUBLE_EQ(channels_of(0, 0, 0).black, 1);
}

TEST(ColourTransform, hues_of_lips_count_and_hues_of_skin_do_not) {
    EXPECT_GT(lip_hue(352), 0.99);
    EXPECT_LT(lip_hue(25), 0.05);
    EXPECT_NEAR(lip_hue(352 + 360), lip_hue(352), 1e-12);
}

TEST(ColourTransform, contrast_keeps_its_ends_and_parts_the_middle) {
    EXPECT_EQ(contrast(0), 0);
    EXPECT_EQ(contrast(1), 1);
    EXPECT_LT(contrast(0.25), 0.25);
    EXPECT_GT(contrast(0.75), 0.75);
}

TEST(ColourTransform, brows_and_lips_are_bright_and_skin_is_dark) {
    auto patch = skin_patch();
    paint(patch, patch_from_mean({-0.6, -0.3}), patch_from_mean({-0.1, -0.2}), {60, 45, 38});
    paint(patch, patch_from_mean({-0.28, 0.72}), patch_from_mean({0.28, 0.9}), {184, 100, 100});
    const auto maps = transform_colours(patch);
    EXPECT_GT(maps.feature.sample(patch_from_mean({-0.35, -0.25})), 0.7);
    EXPECT_GT(maps.feature.sample(patch_from_mean({0, 0.8})), 0.4);
    EXPECT_LT(maps.feature.sample(patch_from_mean({0.3, 0.3})), 0.1);
}

TEST(ColourTransform, the_level_of_the_light_changes_nothing) {
    auto patch = skin_patch();
    paint(patch, patch_from_mean({-0.6, -0.3}), patch_from_mean({-0.1, -0.2}), {60, 44, 36});
    auto dim = patch;
    for (auto& value : dim.rgb) value = static_cast<std::uint8_t>(value / 2);
    const auto bright_map = transform_colours(patch).feature, dim_map = transform_colours(dim).feature;
    // Halving loses the last bit: colours differ by up to 1 in 36.
    for (std::size_t k = 0; k < bright_map.values.size(); k += 37)
        EXPECT_NEAR(bright_map.values[k], dim_map.values[k], 0.08);
}

TEST(ColourNetwork, learns_the_weights_of_its_own_training_and_reads_back_the_same) {
    auto patch = skin_patch();
    paint(patch, patch_from_mean({-0.6, -0.33}), patch_from_mean({0.6, -0.17}), {60, 45, 38});
    paint(patch, patch_from_mean({-0.28, 0.7}), patch_from_mean({0.28, 0.92}), {184, 100, 100});
    FaceCurves curves = mean_face_curves();
    for (auto& curve : curves.curve)
        for (auto& p : curve.control) p = patch_from_mean(p);
    const std::vector<LabelledPatch> labelled = {{patch, curves}};
    ColourTrainingOptions options;
    options.variations = 12;
    const auto network = ColourNetwork::train(labelled, "one made patch", options);
    const auto wanted = best_weights(labelled[0]);
    const auto got = network.weights(colour_inputs(patch, curves));
    // Back-propagation stops before it knows them by heart: a tenth of the sum of the weights.
    EXPECT_NEAR(got.magenta, wanted.magenta, 0.3);
    EXPECT_NEAR(got.black, wanted.black, 0.3);
    EXPECT_NEAR(got.value, wanted.value, 0.3);
    EXPECT_LE(got.value, 0);
    const auto file = std::filesystem::path(testing::TempDir()) / "colours.yml";
    network.save(file);
    const auto again = ColourNetwork::load(file);
    EXPECT_EQ(again.made_of(), "one made patch");
    EXPECT_NEAR(again.weights(colour_inputs(patch, curves)).magenta, got.magenta, 1e-6);
}

TEST(ColourNetwork, the_shipped_one_says_what_it_was_trained_on) {
    EXPECT_THAT(ColourNetwork::shipped().made_of(), testing::HasSubstr("rendered"));
}

}  // namespace
}  // namespace mimik::video
