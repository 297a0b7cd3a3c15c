#pragma once

#include <string>
#include <vector>

#include "io/image.h"
#include "video/feature_tracker.h"

namespace mimik::video {

/// Draws the curves on a frame; where the face is lost, says so in its corner.
void draw_face(io::Image& frame, const std::optional<TrackedFace>& face);

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
