#pragma once

#include <array>

#include "figures/figure.h"

namespace mimik::figures {

/// A panel's pixels, and how millimetres lie on them.
struct PanelCamera {
    geometry::Point centre_mm = geometry::Point::Zero();
    double mm_per_px = 1.0;
    View view;
};

/// Right, up and towards the camera, as unit vectors of the face's frame (rows).
[[nodiscard]] Eigen::Matrix3d view_axes(const View& view);

/// The face alone, without caption, as seen by an orthographic camera. `scalar_range` is where the panel's colour map
/// begins and ends.
[[nodiscard]] io::Image draw_panel(const Panel& panel, const PanelCamera& camera, const Figure& figure,
                                   const std::array<double, 2>& scalar_range);

}  // namespace mimik::figures
