#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "base/fields.h"
#include "geometry/types.h"

namespace mimik::animation {

struct MotionComponentsOptions {
    std::size_t components = 8;  ///< glTF asks no more morph targets at once of a viewer
    /// Evenly spaced frames that the components are made of: memory does not grow with the length of a take.
    std::size_t sampled_frames = 128;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("components", self.components);
        visit("sampled_frames", self.sampled_frames);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<MotionComponentsOptions>());

/// A motion of a mesh as a few shapes with weights that change over time: vertices(f) = rest + sum_c w_fc shape_c.
struct MotionComponents {
    std::vector<std::vector<geometry::Vector>> shapes_mm;  ///< [component][vertex]; weights are about 0 to 1 in size
    std::vector<std::vector<double>> weights;              ///< [frame][component]
    /// Over all vertices and frames: the bound of what is lost to the components, in double precision. A GLB rounds
    /// rest, shapes and weights to 32 bits, which may add up to 0.001 mm of a face.
    double largest_error_mm = 0;
    double rms_error_mm = 0;
    std::size_t worst_frame = 0, worst_vertex = 0;
};

/// The first principal components of a motion about rest, not about its mean, so that weights of 0 are the face at
/// rest. Each frame is asked for twice. @param frame_mm  fills the displacement of every vertex in a frame
/// @throws InputError for bad options, or without a frame.
[[nodiscard]] MotionComponents motion_components(
    std::size_t frames, std::size_t vertices,
    const std::function<void(std::size_t frame, std::span<geometry::Vector> displacement_mm)>& frame_mm,
    const MotionComponentsOptions& options = {});

}  // namespace mimik::animation
