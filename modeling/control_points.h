#pragma once

#include <span>
#include <string>
#include <vector>

#include "geometry/landmarks.h"
#include "geometry/surface_index.h"
#include "modeling/facs_catalogue.h"
#include "preprocessing/face.h"

namespace mimik::modeling {

/// A control point on a face, in the face's frame (+x left, +y up, +z out of the face: any normalised frame).
struct ControlPoint {
    std::string name;  ///< "AU12.mouth_corner_left", "AU12.coverage_3_-2_left", "anchor_2_5"
    ControlKind kind = ControlKind::muscle;
    geometry::Point position_mm = geometry::Point::Zero();
};

struct PlacedControls {
    std::vector<ControlPoint> controls;  ///< muscle, wrinkle and coverage points
    std::vector<ControlPoint> anchors;
    /// Catalogue points by name with the reason (off the face, on top of another); coverage points by their number, and
    /// only where most of them meet no surface: their lattice reaches beyond every face's rim.
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
/// @param expression  "12", "4L", "HAPPY", ... @throws InputError if it or a landmark it needs is unknown.
[[nodiscard]] PlacedControls place_controls(const FacsCatalogue& catalogue, const std::string& expression,
                                            const geometry::Landmarks& landmarks, const geometry::SurfaceIndex& surface,
                                            const PlacedKinds& kinds = {});

/// How far outside the expression's zones a point is, in outer-eye distances; negative inside.
class ExpressionZone {
public:
    ExpressionZone(const FacsCatalogue& catalogue, const std::string& expression, const geometry::Landmarks& landmarks);
    [[nodiscard]] double distance(const geometry::Point& position_mm) const;

private:
    struct Ellipse {
        double x, y, rx, ry;  // mm
    };
    std::vector<Ellipse> ellipses_;
    double unit_mm_ = 1.0;
};

/// Position of a placement on one side (left or right).
[[nodiscard]] geometry::Point place(const Placement& placement, const geometry::Landmarks& landmarks,
                                    database::Side side);

/// Vertices (1) of a neutral face that the expression leaves alone: measured, and outside its zones by the anchor
/// margin, upright by `neutral.average_from_scan`. If fewer than a tenth are, preprocessing::stable_on_every_face().
[[nodiscard]] std::vector<char> stable_vertices(const FacsCatalogue& catalogue, const std::string& expression,
                                                const preprocessing::Face& neutral);

}  // namespace mimik::modeling
