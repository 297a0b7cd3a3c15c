#pragma once

#include <vector>

#include "facs/facs_catalogue.h"
#include "geometry/landmarks.h"
#include "geometry/types.h"

namespace mimik::facs {

/// The ellipses in which an expression moves the skin, as the catalogue draws them on a face; the whole face of a
/// database's own word that the catalogue lacks.
class ExpressionZone {
public:
    /// @throws InputError if a unit of the expression or a landmark that it needs is unknown.
    ExpressionZone(const FacsCatalogue& catalogue, const Expression& expression, const geometry::Landmarks& landmarks);
    /// How far outside the zone a point is, in outer-eye distances; negative inside.
    [[nodiscard]] double distance(const geometry::Point& position_mm) const;
    [[nodiscard]] bool whole_face() const { return whole_face_; }

private:
    struct Ellipse {
        double x, y, rx, ry;  // mm
    };
    std::vector<Ellipse> ellipses_;
    double unit_mm_ = 1.0;
    bool whole_face_ = false;
};

/// The sides on which a unit acts: one, or left and right.
[[nodiscard]] std::vector<Side> sides_of(const SidedUnit& sided);

}  // namespace mimik::facs
