#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "capture/feature_motion.h"
#include "video/track_video.h"

namespace mimik::video {

/// Rows of feature motion, one for every frame, from what a tracker sees of it. Rows wait until the neutral frames have
/// been seen, and come at once from then on.
class FeatureRows {
public:
    struct Row {
        long frame = 0;
        capture::FeatureFrame features;  ///< in the order of capture::face_features()
        std::optional<Points68> points;  ///< pixels; none: the face is lost
    };
    /// @param width, height  of the frames
    /// @param take  is given every row, in the order of the frames
    FeatureRows(double rate_hz, int width, int height, const TrackVideoOptions& options,
                std::function<void(const Row&)> take);

    /// What the tracker saw of the next frame.
    void add(const std::optional<TrackedFace>& face);
    /// Gives out what waits. @returns whether there ever was a face
    bool finish();

    [[nodiscard]] bool late_neutral() const { return late_neutral_; }  ///< none of the neutral frames showed a face
    [[nodiscard]] long tracked() const { return tracked_; }            ///< rows
    [[nodiscard]] long without_pose() const { return without_pose_; }  ///< rows lost though a face was seen
    [[nodiscard]] bool has_neutral() const { return head_.has_value(); }

private:
    void fit_head();
    void flush();
    void give_lost_front();
    void give(const std::optional<TrackedFace>& face);
    void fill(Row& row, const TrackedFace& face, const capture::HeadPose& pose);
    double smooth(std::size_t k, double value) { return options_.smooth ? filters_[k](value) : value; }

    std::function<void(const Row&)> take_;
    double rate_hz_;
    int width_, height_;
    TrackVideoOptions options_;
    std::deque<std::optional<TrackedFace>> waiting_;
    std::optional<FittedHead> head_;
    std::optional<capture::HeadPose> last_pose_;
    std::vector<OneEuroFilter> filters_;
    long given_ = 0, tracked_ = 0, without_pose_ = 0;
    bool late_neutral_ = false;
};

/// Gives out what waits. @returns what is to be said of the rows: no face, none in the neutral frames, no pose
[[nodiscard]] std::vector<std::string> finish_rows(FeatureRows& rows);

}  // namespace mimik::video
