#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "capture/feature_motion.h"
#include "io/image.h"
#include "video/feature_tracker.h"

namespace mimik::video {

/// Draws the curves on a frame; where the face is lost, says so in its corner.
void draw_face(io::Image& frame, const std::optional<TrackedFace>& face);

/// The same of a row of feature motion: curves through its pixels (motion.csv has the middle of the first pixel at
/// (0.5, 0.5)). A row that lacks some has none; one that is lost says so. @param row  of the motion
/// @throws std::out_of_range if the motion has no such row
void draw_motion(io::Image& frame, const capture::FeatureMotion& motion, std::size_t row);

/// How high pictures beside a frame are unless somebody asks for more: as the frame, at most 720 pixels.
[[nodiscard]] int beside_height(const io::Image& frame);
/// A performer's frame, and the faces that it moves to its right, all scaled to one height; widths follow.
[[nodiscard]] io::Image beside(const io::Image& frame, const std::vector<io::Image>& faces, int height_px);

/// Close-ups of a face over a video, five in a row: a picture to judge a tracker by.
class ContactSheet {
public:
    explicit ContactSheet(std::size_t cells = 20) : cells_(cells) {}
    [[nodiscard]] bool full() const { return pictures_.size() == cells_; }
    void add(const io::Image& frame, const std::optional<TrackedFace>& face, const std::string& caption);
    [[nodiscard]] io::Image image() const;

private:
    std::size_t cells_;
    std::vector<io::Image> pictures_;
};

}  // namespace mimik::video
