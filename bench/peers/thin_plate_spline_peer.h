#pragma once

#include <memory>
#include <span>
#include <vector>

#include "geometry/types.h"

namespace mimik::peers {

/// Another implementation of the thin-plate spline R^3 -> R^3 with r^2 ln r.
class ThinPlateSplinePeer {
public:
    virtual ~ThinPlateSplinePeer() = default;
    [[nodiscard]] virtual std::vector<geometry::Point> apply(std::span<const geometry::Point> points_mm) const = 0;
};

/// vtkThinPlateSplineTransform, basis R2LogR.
[[nodiscard]] std::unique_ptr<ThinPlateSplinePeer> make_vtk_peer(std::span<const geometry::Point> source_mm,
                                                                 std::span<const geometry::Point> target_mm);

}  // namespace mimik::peers
