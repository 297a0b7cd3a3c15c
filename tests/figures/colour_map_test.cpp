#include "figures/colour_map.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::figures {
namespace {

// One step of an 8-bit channel is at most 0.004 in lightness; two ends may each be off by half of it.
constexpr double rounding = 0.006;

TEST(ColourMap, equal_steps_of_the_sequential_map_are_equal_steps_of_lightness) {
    constexpr int steps = 32;
    const double whole =
        lightness(map_colour(ColourMap::sequential, 1)) - lightness(map_colour(ColourMap::sequential, 0));
    EXPECT_NEAR(whole, 0.66, 2 * rounding);
    for (int k = 0; k < steps; ++k) {
        const double rise = lightness(map_colour(ColourMap::sequential, (k + 1.0) / steps)) -
                            lightness(map_colour(ColourMap::sequential, double(k) / steps));
        EXPECT_NEAR(rise, whole / steps, rounding) << k;
    }
}

TEST(ColourMap, the_ends_of_the_diverging_map_are_equally_light_and_its_middle_is_nearly_white) {
    for (const double t : {0.0, 0.1, 0.25, 0.4})
        EXPECT_NEAR(lightness(map_colour(ColourMap::diverging, t)), lightness(map_colour(ColourMap::diverging, 1 - t)),
                    rounding);
    EXPECT_GT(lightness(map_colour(ColourMap::diverging, 0.5)), 0.95);
    const Colour low = map_colour(ColourMap::diverging, 0), high = map_colour(ColourMap::diverging, 1);
    EXPECT_GT(low[2], low[0]);
    EXPECT_GT(high[0], high[2]);
}

TEST(ColourMap, values_beyond_the_ends_take_the_colour_of_the_end_and_nan_its_own) {
    EXPECT_EQ(map_colour(ColourMap::sequential, -3), map_colour(ColourMap::sequential, 0));
    EXPECT_EQ(map_colour(ColourMap::sequential, 7), map_colour(ColourMap::sequential, 1));
    EXPECT_EQ(map_colour(ColourMap::diverging, std::numeric_limits<double>::quiet_NaN()), no_value_colour);
}

TEST(Lightness, runs_from_black_to_white) {
    EXPECT_NEAR(lightness({0, 0, 0}), 0, 1e-6);
    EXPECT_NEAR(lightness({255, 255, 255}), 1, 1e-6);
}

TEST(ParseColour, takes_six_hexadecimal_digits_and_nothing_else) {
    EXPECT_EQ(parse_colour("#0a80FF"), (Colour{10, 128, 255}));
    for (const auto* bad : {"", "red", "#12345", "#1234567", "#12 456", "#gg0000", "0a80ff0"}) {
        try {
            (void)parse_colour(bad);
            FAIL() << "accepted '" << bad << "'";
        } catch (const InputError& e) {
            EXPECT_THAT(e.what(), testing::HasSubstr("#rrggbb"));
        }
    }
}

TEST(ParseColourMap, an_unknown_name_is_refused_with_the_names_there_are) {
    EXPECT_EQ(parse_colour_map("diverging"), ColourMap::diverging);
    EXPECT_THROW((void)parse_colour_map("jet"), InputError);
}

}  // namespace
}  // namespace mimik::figures
