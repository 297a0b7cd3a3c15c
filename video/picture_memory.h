#pragma once

#include <deque>
#include <vector>

#include "io/image.h"

namespace mimik::video {

/// How the whole picture looked while a face was followed, so that a cut is told from a face that is hidden: after a
/// cut the place of the face says nothing of where to look.
class PictureMemory {
public:
    /// The picture of this frame. @param frame  its size may change
    void look_at(const io::Image& frame);
    /// In this frame the face was followed.
    void keep();
    /// Whether this frame shows another picture than the last in which the face was followed. Some frames before these
    /// count: a cut may be noticed late, and pictures that dissolve are cut, too.
    [[nodiscard]] bool is_another() const;
    void forget();

private:
    std::vector<float> now_;               ///< grey cells
    std::deque<std::vector<float>> kept_;  ///< the newest last
};

/// Correlation of grey values, about 0 to 1: alike but for light. A blank one is like nothing.
[[nodiscard]] double grey_correlation(const std::vector<float>& a, const std::vector<float>& b);

}  // namespace mimik::video
