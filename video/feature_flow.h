#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/fields.h"
#include "video/face_patch.h"

namespace mimik::video {

struct FlowOptions {
    int window_px = 11;        ///< of the square that is compared
    int levels = 3;            ///< of the pyramid, each of half the size
    double forth_back_px = 1;  ///< a point that does not come back to within this is not followed
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("window_px", self.window_px);
        visit("levels", self.levels);
        visit("forth_back_px", self.forth_back_px);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<FlowOptions>());

struct FlowedPoint {
    Pixel at = Pixel::Zero();
    bool followed = false;
};

/// Where points of one grey image are in the next: pyramidal Lucas-Kanade (Bouguet 2000), forth and back.
/// @param from, to  grey, `width` x `height`
[[nodiscard]] std::vector<FlowedPoint> flow_points(std::span<const std::uint8_t> from, std::span<const std::uint8_t> to,
                                                   int width, int height, std::span<const Pixel> points,
                                                   const FlowOptions& options = {});

/// A turn, a scale and a shift of the plane: p -> scale_turn * p + shift.
struct PlaneSimilarity {
    Eigen::Matrix2d scale_turn = Eigen::Matrix2d::Identity();
    Pixel shift = Pixel::Zero();
    double inliers = 0;  ///< share of the pairs that agree to within the tolerance
    [[nodiscard]] Pixel operator()(const Pixel& at) const { return scale_turn * at + shift; }
};
/// The similarity that most pairs agree on: least squares, with less weight for pairs that lie apart (reweighted
/// until it settles). Fewer than three pairs: the identity with no inliers.
[[nodiscard]] PlaneSimilarity fit_similarity(std::span<const Pixel> from, std::span<const Pixel> to,
                                             double tolerance_px = 1.5);

}  // namespace mimik::video
