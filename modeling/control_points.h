#pragma once

#include <span>
#include <string>
#include <vector>

#include "facs/facs_catalogue.h"
#include "geometry/landmarks.h"
#include "geometry/surface_index.h"

namespace mimik::modeling {

/// A control point on a face, in the face's frame (+x left, +y up, +z out of the face: any normalised frame).
struct ControlPoint {
    std::string name;  ///< "AU12.mouth_corner_left", "AU12.coverage_3_-2_left", "anchor_2_5"
    facs::ControlKind kind = facs::ControlKind::muscle;
    geometry::Point position_mm = geometry::Point::Zero();
};

struct PlacedControls {
    std::vector<ControlPoint> controls;  ///< muscle, wrinkle and coverage points
    std::vector<ControlPoint> anchors;
    /// Catalogue points by name with the reason (off the face, on top of another, a landmark missing); coverage points
    /// by their number, and only where most of them meet no surface: their lattice reaches beyond every face's rim.
    std::vector<std::string> left_out;
};

/// What is placed beside the catalogue's own points.
struct PlacedKinds {
    bool coverage = true;
    bool anchors = true;
};

/// Places the points of an expression on a face: catalogue points, coverage points on a hexagonal lattice inside the
/// zones, anchors on a wider one outside them. All are brought to the surface along z. Names depend on the catalogue
/// and the landmarks' frame alone, so that points of one name correspond between faces.
/// @throws InputError if a unit of the expression or a landmark that it needs is unknown.
[[nodiscard]] PlacedControls place_controls(const facs::FacsCatalogue& catalogue, const facs::Expression& expression,
                                            const geometry::Landmarks& landmarks, const geometry::SurfaceIndex& surface,
                                            const PlacedKinds& kinds = {});

}  // namespace mimik::modeling
