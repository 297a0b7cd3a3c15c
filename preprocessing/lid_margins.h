#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/fields.h"
#include "facs/side.h"
#include "geometry/landmarks.h"
#include "geometry/mesh.h"
#include "geometry/types.h"
#include "geometry/vertex_mask.h"

namespace mimik::preprocessing {

/// Lengths in eye widths: between the corners of that very eye.
struct LidMarginOptions {
    int columns = 49;             ///< sections across the eye, from beyond one corner to beyond the other
    double beyond_corner = 0.08;  ///< landmarks of corners are off by a millimetre, holes of scans by two
    /// Of the eyeball, before a face has said its own: people have about 0.40, artists' heads 0.50.
    double usual_radius = 0.47;
    double least_height = 0.10;  ///< of the opening in the middle of the eye; less is a closed eye
    double most_height = 0.75;   ///< more is a hole of the face and no eye
    double least_share = 0.75;   ///< of the sections between the corners that show an opening
    double step_mm = 0.5;        ///< how far a lid stands off an eyeball that is one surface with it

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("columns", self.columns);
        visit("beyond_corner", self.beyond_corner);
        visit("usual_radius", self.usual_radius);
        visit("least_height", self.least_height);
        visit("most_height", self.most_height);
        visit("least_share", self.least_share);
        visit("step_mm", self.step_mm);
    }
    void check() const;  ///< throws InputError
};
static_assert(base::lists_every_field<LidMarginOptions>());

/// What lies between the lids.
enum class EyeballKind {
    none,    ///< nothing: a hole of the scan, an empty socket
    part,    ///< a part of the mesh of its own
    surface  ///< the same surface as the lids
};
[[nodiscard]] const char* to_string(EyeballKind kind);  ///< "none", "part", "surface"

/// Where the lids end in one section across the eye, seen from the axis of the lids.
struct LidSection {
    double x_mm = 0.0;                              ///< along the axis, from the centre
    double upper_rad = 0.0, lower_rad = 0.0;        ///< elevation of the margins above the forward direction
    double upper_rho_mm = 0.0, lower_rho_mm = 0.0;  ///< their distance from the axis
};

/// The lids of one eye: sliding about an axis through the centre of the eyeball, along the eye's corners.
struct EyeLids {
    bool found = false;
    std::string reason;                                   ///< why not
    double confidence = 0.0;                              ///< 1: a margin in every section, and smooth; 0: not found
    geometry::Point centre_mm = geometry::Point::Zero();  ///< of the eyeball
    double radius_mm = 0.0;
    double width_mm = 0.0;  ///< between the corners
    /// Rows: along the axis to the subject's left, up, out of the face.
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    EyeballKind eyeball = EyeballKind::none;
    std::vector<LidSection> sections;  ///< those that show an opening, from the subject's right to the left

    [[nodiscard]] geometry::Point local_mm(const geometry::Point& position_mm) const {
        return axes * (position_mm - centre_mm);
    }
};

/// The lids of a face.
struct LidMargins {
    EyeLids left, right;
    geometry::VertexMask eyeball;  ///< per vertex: of a part of the mesh that is an eyeball or lies within one

    [[nodiscard]] const EyeLids& of(facs::Side side) const { return side == facs::Side::left ? left : right; }
};

/// Looks for the margins of the lids between the landmarks of the eyes' corners: where the skin ends in a hole or turns
/// into a socket before the eyeball, or else where it steps up from the eyeball. An eye without them says why.
/// @param vertices_mm  of a face in a frame whose z leaves the face, such as the average one; any where no triangle is
/// @param measured     triangles with a vertex that is not count as a hole
/// @throws InputError for bad options.
[[nodiscard]] LidMargins find_lid_margins(std::span<const geometry::Point> vertices_mm,
                                          std::span<const geometry::Triangle> triangles,
                                          const geometry::VertexMask& measured, const geometry::Landmarks& landmarks,
                                          const LidMarginOptions& options = {});

}  // namespace mimik::preprocessing
