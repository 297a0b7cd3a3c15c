#include "video/track_video.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "video/video_file.h"

namespace mimik::video {
namespace {

std::filesystem::path place(const std::string& name) { return std::filesystem::path(testing::TempDir()) / name; }

TEST(VideoReader, a_missing_file_a_folder_and_what_is_no_video_are_refused_by_name) {
    const auto message = [](const std::string& source) -> std::string {
        try {
            VideoReader reader(source);
        } catch (const InputError& e) {
            return e.what();
        }
        return "nothing was thrown";
    };
    EXPECT_THAT(message("nowhere.mp4"), testing::HasSubstr("nowhere.mp4: there is no such file"));
    EXPECT_THAT(message(testing::TempDir()), testing::HasSubstr("is a folder"));
    std::ofstream(place("text.mp4")) << "this is no video";
    EXPECT_THAT(message(place("text.mp4").string()), testing::HasSubstr("no frame can be decoded"));
}

TEST(VideoWriter, frames_of_two_sizes_and_other_formats_are_refused_and_nothing_is_left) {
    EXPECT_THROW(VideoWriter(place("a.avi"), 25), InputError);
    EXPECT_THROW(VideoWriter(place("a.mp4"), 0), InputError);
    {
        VideoWriter writer(place("two.mp4"), 25);
        io::Image small, large;
        small.width = small.height = 32;
        small.rgb.assign(3 * 32 * 32, 10);
        large.width = large.height = 64;
        large.rgb.assign(3 * 64 * 64, 10);
        writer.add(small);
        EXPECT_THROW(writer.add(large), InputError);
    }
    EXPECT_FALSE(std::filesystem::exists(place("two.mp4")));
    EXPECT_FALSE(std::filesystem::exists(place("two.part.mp4")));
}

TEST(Landmarks68, a_row_reads_back_and_a_lost_one_has_empty_fields) {
    Points68 points;
    for (std::size_t k = 0; k < 68; ++k) points[k] = {k + 0.25, 100.5 - k};
    std::ofstream(place("rows.csv")) << landmarks68_header() << landmarks68_row(0, std::nullopt)
                                     << landmarks68_row(1, points);
    const auto rows = read_landmarks68(place("rows.csv"), 10);
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows[0].frame, 1);
    for (std::size_t k = 0; k < 68; ++k) EXPECT_LT((rows[0].points[k] - points[k]).norm(), 0.01);  // two decimals
    EXPECT_THAT(landmarks68_row(0, std::nullopt), testing::StartsWith("0,0,,,"));
}

TEST(TrackVideo, neutral_frames_in_the_wrong_order_are_refused) {
    TrackVideoOptions options;
    options.neutral_from = 10;
    options.neutral_to = 5;
    EXPECT_THROW(options.check(), InputError);
}

}  // namespace
}  // namespace mimik::video
