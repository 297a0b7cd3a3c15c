#include "capture/c3d.h"

#include <bit>
#include <cstring>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/capture/recordings.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/thrown.h"

namespace mimik::capture {
namespace {

using test::bytes_of;
using test::circling_markers;
using test::message_of;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

MotionFile decode(const std::string& text, const MotionReadOptions& options = {}) {
    return decode_c3d(bytes_of(text), "take.c3d", options);
}
std::string refused(const std::string& text) {
    return message_of([&] { (void)decode(text); });
}

/// A file put together byte by byte, little-endian, apart from Mimik's own writer.
struct HandMade {
    std::string header = std::string(512, '\0'), parameters, data;
    static std::string word(unsigned value) {
        return {static_cast<char>(value & 0xFFU), static_cast<char>((value >> 8U) & 0xFFU)};
    }
    static std::string real(float value) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        return word(bits & 0xFFFFU) + word(bits >> 16U);
    }
    void put(std::size_t at, const std::string& bytes) { header.replace(at, bytes.size(), bytes); }
    void group(int id, const std::string& name) {
        parameters += static_cast<char>(name.size());
        parameters += static_cast<char>(-id);
        parameters += name + word(3 + 4) + '\4' + "text";
    }
    void parameter(int id, const std::string& name, int type, const std::string& sizes, const std::string& values) {
        parameters += static_cast<char>(-static_cast<int>(name.size()));  // locked
        parameters += static_cast<char>(id);
        parameters += name + word(static_cast<unsigned>(2 + 2 + sizes.size() + values.size() + 1));
        parameters += static_cast<char>(type);
        parameters += static_cast<char>(sizes.size());
        parameters += sizes + values + '\0';
    }
    HandMade(unsigned points, unsigned frames) {
        put(0, "\2\x50" + word(points) + word(0) + word(1) + word(frames) + word(0) + real(-0.5F) + word(3) + word(0) +
                   real(60));
        group(1, "Point");
    }
    [[nodiscard]] std::string text() const {
        auto section = std::string("\0\0\1\x54", 4) + parameters;
        section.resize(512, '\0');
        return header + section + data;
    }
};

std::string point(float x, float y, float z, float w) {
    return HandMade::real(x) + HandMade::real(y) + HandMade::real(z) + HandMade::real(w);
}

/// Two markers, two frames; one sample is missing, one lies at the origin.
HandMade two_markers() {
    HandMade file(2, 2);
    file.parameter(1, "LABELS", -1, "\6\2", std::string("LBRO  lip\0\0\0", 12));
    file.parameter(1, "UNITS", -1, "\1", "m");
    file.data = point(0.25F, -0.5F, 1.5F, 4) + point(0, 0, 0, 0) + point(7, 7, 7, -1) + point(0.125F, 0, 0, 0);
    return file;
}

TEST(C3d, reads_a_file_put_together_by_hand) {
    const auto file = decode(two_markers().text());
    EXPECT_EQ(file.format, "C3D, Intel, float");
    EXPECT_EQ(file.unit, "m");
    EXPECT_THAT(file.markers.names(), ElementsAre("LBRO", "lip"));
    EXPECT_EQ(file.markers.rate_hz(), 60);
    ASSERT_EQ(file.markers.frames(), 2U);
    EXPECT_EQ(file.markers.at_mm(0, 0), Point(250, -500, 1500));
    EXPECT_EQ(file.markers.residual_mm(0, 0), 2000) << "4 steps of 0.5 m";
    EXPECT_TRUE(file.markers.valid(0, 1)) << "at the origin, and not marked as missing";
    EXPECT_FALSE(file.markers.valid(1, 0));
    EXPECT_EQ(file.markers.at_mm(1, 1), Point(125, 0, 0));
    EXPECT_THAT(file.remarks, ElementsAre(HasSubstr("1 sample is exactly at the origin")));
}

TEST(C3d, the_unit_and_rate_asked_for_go_before_the_file) {
    const auto file = decode(two_markers().text(), {io::LengthUnit::millimetre, 240.0});
    EXPECT_EQ(file.markers.at_mm(0, 0), Point(0.25, -0.5, 1.5));
    EXPECT_EQ(file.markers.rate_hz(), 240);
}

TEST(C3d, samples_that_are_no_numbers_are_missing_and_counted) {
    auto file = two_markers();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    file.data = point(nan, 0, 0, 0) + point(1, 2, 3, nan) + point(9999999, 9999999, 9999999, 0) + point(1, 2, 3, 0);
    MotionReadOptions millimetres;
    millimetres.unit = io::LengthUnit::millimetre;
    const auto read = decode(file.text(), millimetres);
    EXPECT_EQ(read.markers.valid_count(0), 0U);
    EXPECT_EQ(read.markers.valid_count(1), 1U);
    EXPECT_THAT(read.remarks, Contains(HasSubstr("1 sample holds no numbers")));
    EXPECT_THAT(read.remarks, Contains(HasSubstr("9999999")));
}

TEST(C3d, vax_reals_are_what_the_vax_handbook_says) {
    HandMade file(1, 1);
    // 1.0 is 4080 0000, -2.5 is C120 0000, 0.1 is 3ECC CCCD, each half little-endian; exponent 0 is zero.
    using File = HandMade;
    file.put(12, File::word(0xC080) + File::word(0));  // scale -1
    file.put(20, File::word(0x43F0) + File::word(0));  // 120 Hz
    file.data = File::word(0x4080) + File::word(0) + File::word(0xC120) + File::word(0) + File::word(0x3ECC) +
                File::word(0xCCCD) + File::word(0) + File::word(0);
    auto text = file.text();
    text[512 + 3] = 85;
    const auto read = decode(text);
    EXPECT_EQ(read.format, "C3D, DEC, float");
    EXPECT_EQ(read.markers.rate_hz(), 120);
    EXPECT_EQ(read.markers.at_mm(0, 0), Point(1, -2.5, double{0.1F}));
}

TEST(C3d, three_kinds_of_processor_are_read_identically) {
    auto take = circling_markers(75, 40, 101);
    take.set_residual_mm(1, 1, 0.25F);
    for (const auto processor : {C3dProcessor::intel, C3dProcessor::dec, C3dProcessor::sgi})
        for (const bool integers : {false, true}) {
            C3dWriteOptions options;
            options.processor = processor;
            // 1/32 mm is a binary fraction, so positions on its multiples come back as they were.
            auto rounded = take;
            if (integers) {
                options.integer_step_mm = 1.0 / 32;
                rounded.set_residual_mm(1, 1, 8.0F / 32);
                for (std::size_t frame = 0; frame < take.frames(); ++frame)
                    for (std::size_t k = 0; k < take.markers(); ++k)
                        if (take.valid(frame, k))
                            rounded.set(frame, k, (take.at_mm(frame, k) * 32).array().round().matrix() / 32);
            }
            const auto read = decode(encode_c3d(rounded, "take.c3d", options));
            SCOPED_TRACE(read.format);
            EXPECT_THAT(read.remarks, ElementsAre(HasSubstr("at the origin")));
            EXPECT_EQ(read.markers.names().size(), 75U);
            EXPECT_EQ(read.markers.first_frame(), 101);
            for (std::size_t frame = 0; frame < take.frames(); ++frame)
                for (std::size_t k = 0; k < take.markers(); ++k) {
                    ASSERT_EQ(read.markers.valid(frame, k), rounded.valid(frame, k));
                    ASSERT_EQ(read.markers.at_mm(frame, k), rounded.at_mm(frame, k));
                }
            // The step of residuals is 0.01 mm in files of reals.
            EXPECT_NEAR(read.markers.residual_mm(1, 1), 0.25, 1e-6);
        }
}

TEST(C3d, positions_that_are_32_bit_reals_read_back_exactly) {
    const auto take = circling_markers(12, 100);
    EXPECT_EQ(decode(encode_c3d(take, "take.c3d")).markers, take);
}

TEST(C3d, reals_of_every_size_survive_each_processor) {
    std::vector<float> values = {1e-30F, 3.4e5F, -1.0F / 3, 0.1F, -7e-5F, 999999.9F, 0.0F, 1.1754944e-38F};
    MarkerSequence take({"a"}, 100, values.size());
    for (std::size_t k = 0; k < values.size(); ++k) take.set(k, 0, Point(double{values[k]}, 1, -double{values[k]}));
    for (const auto processor : {C3dProcessor::intel, C3dProcessor::dec, C3dProcessor::sgi}) {
        C3dWriteOptions options;
        options.processor = processor;
        EXPECT_EQ(decode(encode_c3d(take, "take.c3d", options)).markers, take) << to_string(processor);
    }
}

TEST(C3d, more_than_255_markers_have_names_in_further_lists) {
    const auto take = circling_markers(600, 2);
    const auto text = encode_c3d(take, "take.c3d");
    EXPECT_THAT(text, HasSubstr("LABELS3"));
    EXPECT_EQ(decode(text).markers, take);
}

TEST(C3d, more_than_65535_frames_are_all_read) {
    const auto take = circling_markers(3, 70'000, 30'000);
    const auto text = encode_c3d(take, "take.c3d");
    EXPECT_EQ(decode(text).markers, take);
    // Without TRIAL and LONG_FRAMES the length of the file says how many.
    auto bare = text;
    for (const auto* name : {"ACTUAL_START_FIELD", "ACTUAL_END_FIELD", "LONG_FRAMES"}) bare[bare.find(name)] = '_';
    EXPECT_EQ(decode(bare).markers.frames(), 70'000U);
}

TEST(C3d, a_count_of_frames_that_the_length_contradicts_gives_way_with_a_remark) {
    auto text = encode_c3d(circling_markers(40, 10), "take.c3d");
    const auto at = text.find("FRAMES", text.find("DATA_START"));
    text[at + 10] = 9;  // of POINT:FRAMES; the header and TRIAL say 10
    const auto file = decode(text);
    EXPECT_EQ(file.markers.frames(), 10U);
    EXPECT_THAT(file.remarks, Contains(HasSubstr("POINT:FRAMES says 9 frames")));
}

TEST(C3d, analogue_values_are_passed_over_whether_ANALOG_is_there_or_not) {
    for (const bool with_group : {false, true}) {
        auto file = two_markers();
        file.put(4, HandMade::word(6));
        file.put(18, HandMade::word(3));
        if (with_group) {
            file.group(2, "ANALOG");
            file.parameter(2, "USED", 2, "", HandMade::word(2));
        }
        const auto frame = file.data.substr(0, 32), second = file.data.substr(32);
        std::string analogue;
        for (int k = 0; k < 6; ++k) analogue += HandMade::real(1e9F);
        file.data = frame + analogue + second + analogue;
        const auto read = decode(file.text());
        EXPECT_EQ(read.markers.at_mm(1, 1), Point(125, 0, 0));
        EXPECT_THAT(read.remarks, Contains(HasSubstr("6 analogue values a frame; not read")));
    }
}

TEST(C3d, labels_that_are_missing_or_there_twice_are_made_up_for_with_a_remark) {
    HandMade file(3, 1);
    file.parameter(1, "LABELS", -1, "\3\2", "lipLIP");
    file.data = point(1, 2, 3, 0) + point(1, 2, 3, 0) + point(1, 2, 3, 0);
    EXPECT_THAT(decode(file.text()).markers.names(), ElementsAre("lip", "LIP", "unnamed 3"));
    HandMade same(2, 1);
    same.parameter(1, "LABELS", -1, "\3\2",
                   "lip"
                   "lip");
    same.data = point(1, 2, 3, 0) + point(1, 2, 3, 0);
    const auto read = decode(same.text());
    EXPECT_THAT(read.markers.names(), ElementsAre("lip", "lip (2)"));
    EXPECT_THAT(read.remarks, Contains(HasSubstr("a name that is there before ('lip')")));
}

TEST(C3d, a_file_cut_anywhere_is_refused) {
    const auto text = encode_c3d(circling_markers(50, 20), "take.c3d");
    for (std::size_t length : {0U, 1U, 511U, 600U, 1023U, 1024U, 1600U, 5000U})
        EXPECT_THAT(refused(text.substr(0, length)), HasSubstr("take.c3d: ")) << length;
    EXPECT_THAT(refused(text.substr(0, text.size() - 512)), HasSubstr("the file is truncated: copy it again"));
}

TEST(C3d, wrong_block_numbers_are_refused) {
    auto text = two_markers().text();
    for (const char block : {'\0', '\1', '\x7F'}) {
        auto bad = text;
        bad[0] = block;
        EXPECT_THAT(refused(bad), HasSubstr("parameters are said to begin in block"));
    }
    for (const unsigned block : {0U, 1U, 2U, 65535U}) {
        auto file = two_markers();
        file.put(16, HandMade::word(block));
        EXPECT_THAT(refused(file.text()), HasSubstr("data are said to begin in block"));
    }
}

TEST(C3d, sizes_that_the_file_cannot_hold_take_no_memory) {
    auto file = two_markers();
    file.put(2, HandMade::word(65535));
    file.put(8, HandMade::word(65535));
    file.data.resize(1024);  // 2 kB in all
    EXPECT_THAT(refused(file.text()), HasSubstr("65535 frames of 65535 points"));
}

TEST(C3d, no_numbers_where_numbers_decide_are_refused) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    auto scale = two_markers();
    scale.put(12, HandMade::real(nan));
    EXPECT_THAT(refused(scale.text()), HasSubstr("POINT:SCALE is nan"));
    auto rate = two_markers();
    rate.put(20, HandMade::real(nan));
    EXPECT_THAT(refused(rate.text()), HasSubstr("POINT:RATE is nan Hz"));
    auto none = two_markers();
    none.put(2, HandMade::word(0));
    EXPECT_THAT(refused(none.text()), HasSubstr("POINT:USED is 0"));
    auto far = two_markers();
    far.data = point(1e6F, 0, 0, 0) + far.data.substr(16);
    EXPECT_THAT(refused(far.text()), HasSubstr("'LBRO' is 1e+09 mm from the origin in frame 1"));
    EXPECT_THAT(refused(std::string(4096, 'x')), HasSubstr("it is no C3D"));
    EXPECT_THAT(refused(std::string(512, '\0') + two_markers().text()),
                HasSubstr("512 bytes are zero before the header"));
}

TEST(C3d, what_the_format_cannot_hold_is_not_written) {
    EXPECT_THAT(message_of([] { (void)encode_c3d(MarkerSequence({std::string(128, 'a')}, 1, 1), "o"); }),
                HasSubstr("longer than 127 bytes"));
    EXPECT_THAT(message_of([] { (void)encode_c3d(MarkerSequence({"a"}, 1, 0), "o"); }), HasSubstr("no frame"));
    EXPECT_THAT(message_of([] { (void)encode_c3d(MarkerSequence({"a"}, 1, 2, 0xFFFFFFFF), "o"); }),
                HasSubstr("frames are numbered up to 4294967296, and a C3D holds up to 4294967295"));
    MarkerSequence far({"a"}, 1, 1);
    far.set(0, 0, Point(0, 5000, 0));
    C3dWriteOptions options;
    options.integer_step_mm = 0.1;
    EXPECT_THAT(message_of([&] { (void)encode_c3d(far, "o", options); }), HasSubstr("give larger steps"));
}

TEST(C3d, goes_through_files_by_extension) {
    const test::TemporaryFolder folder;
    const auto take = circling_markers(5, 9);
    for (const auto* name : {"a.c3d", "a.TRC", "a.csv"}) {
        write_motion(folder / name, take);
        EXPECT_EQ(read_motion(folder / name).markers, take) << name;
    }
    EXPECT_THAT(message_of([] { (void)read_motion("a.bvh"); }), HasSubstr("there are .c3d, .trc, .csv and .tsv"));
}

}  // namespace
}  // namespace mimik::capture
