#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/fields.h"
#include "video/feature_tracker.h"
#include "video/head_pose.h"
#include "video/one_euro.h"

namespace mimik::video {

/// Rows that wait for the neutral frames are kept in memory: the last of these frames is below.
inline constexpr int most_waiting_frames = 1000;

struct TrackVideoOptions {
    CameraOptions camera = {};
    /// Frames, the last one among them, in which the performer's face is at rest; the head is fitted to the mean of
    /// those that were tracked.
    int neutral_from = 0;
    int neutral_to = 9;
    bool smooth = false;  ///< the one-euro filter on pose and features
    OneEuroOptions one_euro = {};
    long most_frames = 0;  ///< 0: to the end; a camera has none
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("camera", self.camera);
        visit("neutral_from", self.neutral_from);
        visit("neutral_to", self.neutral_to);
        visit("smooth", self.smooth);
        visit("one_euro", self.one_euro);
        visit("most_frames", self.most_frames);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<TrackVideoOptions>());

/// What is written; empty: not.
struct TrackVideoFiles {
    std::filesystem::path motion;       ///< capture/feature_motion.h
    std::filesystem::path landmarks68;  ///< frame,detected,x0,y0,...,x67,y67
    std::filesystem::path sheet;        ///< PNG, close-ups with the curves
    std::filesystem::path video;        ///< MP4, the frames with the curves drawn on
};

struct TrackVideoReport {
    long frames = 0, tracked = 0;  ///< rows, and those that are not lost
    long found_anew = 0;           ///< times that the face was found, the first among them
    double seconds = 0;            ///< of the processor's time for tracking alone
    double rate_hz = 0;
    std::vector<std::string> remarks;
    [[nodiscard]] double frames_a_second() const { return seconds > 0 ? static_cast<double>(frames) / seconds : 0; }
};

/// Follows the face of a video, and writes a row for every frame: one in which there is no face is `lost`, and nothing
/// is said of its features. Memory does not grow with the video; rows wait until the neutral frames have been seen. If
/// none of those shows a face, the first face after them is taken for neutral, and a remark says so.
/// @throws InputError if the video cannot be read, or is a camera without most_frames
[[nodiscard]] TrackVideoReport track_video(const std::string& source, FeatureTracker& tracker,
                                           const TrackVideoFiles& files, const TrackVideoOptions& options = {});

/// "frame,detected,x0,y0,...": of the 68 points, pixels of the frame, the middle of its first pixel (0, 0).
[[nodiscard]] std::string landmarks68_header();
/// @param points  none: not detected, and every field is empty
[[nodiscard]] std::string landmarks68_row(long frame, const std::optional<Points68>& points);
/// The rows of such a table that have points, by frame; at most `most_rows`. @throws InputError naming line and value.
struct LabelledRow {
    long frame = 0;
    Points68 points;
};
[[nodiscard]] std::vector<LabelledRow> read_landmarks68(const std::filesystem::path& file, std::size_t most_rows);

}  // namespace mimik::video
