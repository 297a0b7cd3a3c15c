#include "report/page_buffers.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::report {
namespace {

TEST(PageBuffers, steps_are_hundredths_of_a_millimetre_and_nothing_is_beyond_their_range) {
    EXPECT_EQ(in_page_steps(1.234), 123);
    EXPECT_EQ(in_page_steps(-0.006), -1);
    EXPECT_EQ(in_page_steps(1e9), 32767);
    EXPECT_EQ(in_page_steps(-1e9), -32767);  // not the value that stands for "not known"
    EXPECT_EQ(in_page_steps(std::numeric_limits<double>::quiet_NaN()), page_no_value);
}

TEST(PageBuffers, what_is_packed_is_unpacked_to_the_last_step_whatever_the_jumps) {
    const std::vector<std::int16_t> steps = {0, 1, -1, 32767, -32768, 32767, 7, 7, 7, -300};
    EXPECT_EQ(unpacked_steps(packed_steps(steps), steps.size()), steps);
    const std::vector<std::uint8_t> bytes = {0, 255, 1, 2};
    EXPECT_EQ(unpacked_bytes(packed_bytes(bytes), bytes.size()), bytes);
    EXPECT_TRUE(unpacked_steps(packed_steps({}), 0).empty());
}

TEST(PageBuffers, neighbours_that_differ_by_little_take_few_bytes) {
    std::vector<std::int16_t> steps;
    for (int k = 0; k < 15000; ++k) steps.push_back(static_cast<std::int16_t>(3000 * std::sin(0.01 * k)));
    // Two bytes a value in base64 are 40 kB; the changes of this wave are below 31 steps.
    EXPECT_LT(packed_steps(steps).size(), 13000U);
}

TEST(PageBuffers, a_text_that_is_no_buffer_is_refused) {
    EXPECT_THROW((void)unpacked_bytes("no buffer!", 3), InputError);
    EXPECT_THROW((void)unpacked_steps(packed_steps(std::vector<std::int16_t>{1, 2}), 3), InputError);
}

}  // namespace
}  // namespace mimik::report
