#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "geometry/mesh.h"

namespace mimik::synthesis {

/// Where things lie on the mean face: mm right of the midline (`s`, along the skin, so that the side of the face keeps
/// its rows) and above the nasion (`t`). The person's own positions follow from these by the measurements.
namespace place {
inline constexpr double nasion = 0, pronasale = -43, subnasale = -55.3, upper_lip = -70.3, stomion = -77,
                        lower_lip = -85.5, sulcus = -95, pogonion = -108, gnathion = -121;
inline constexpr double philtrum_crest = 6.2, inner_canthus = 16, wing = 17.2, mouth_corner = 24.7,
                        outer_canthus = 43.6;
inline constexpr double eye = -7.5, upper_lid = -3.5, lower_lid = -10.7;  ///< sheet rows of the lid opening
inline constexpr double rim = 116, top = 78, bottom = -150;
inline constexpr double gonion = 80, zygion = 66;
}  // namespace place

/// A vertex of the sheet, the same skin on every face.
struct SheetVertex {
    double s = 0;           ///< across, signed: > 0 on the subject's left
    double v = 0;           ///< sheet row: equals t except that lid margins and lip borders are rows
    double t = 0;           ///< height on the mean face before the jaw line bends the rows up
    double across_eye = 0;  ///< -1 at the inner, +1 at the outer canthus, beyond outside
    geometry::Point base = geometry::Point::Zero();  ///< mean face without nose, eyes and lips
    std::uint32_t row = 0, column = 0;
};

/// The fixed topology of the built-in face: rows from hairline to under the jaw, columns from ear to ear, the row of
/// the mouth doubled between the corners so that the lips can part.
struct Sheet {
    std::vector<SheetVertex> vertices;
    std::vector<double> row_v, row_t;           ///< per row, at the midline
    std::vector<double> row_midline_base_z_mm;  ///< per row: base at s = 0
    geometry::Faces faces;
    std::vector<std::uint32_t> mirror;  ///< the same place on the other side
    std::vector<bool> lower_lip_side;   ///< hangs on the jaw where the mouth parts the sheet: below the mouth's row
    std::map<std::string, std::uint32_t> landmarks;
    std::vector<std::string> regions;
    std::uint32_t columns = 0;

    /// The vertex nearest to a place of the mean face.
    [[nodiscard]] std::uint32_t nearest(double s, double t) const;
};

/// How far the lids stand over the eyeball; nothing within the opening nor at its corners, where rows of the sheet
/// meet.
struct LidThickness {
    double upper, lower;
};
[[nodiscard]] LidThickness lid_thickness_mm(double across_eye, double v);

/// How far from the middle of the cornea: 1 on its rim.
[[nodiscard]] double cornea_radius(double across_eye, double t);

/// Height of the middle of the brow over the nasion at `a` mm from the midline of the mean face.
[[nodiscard]] double brow_line(double a);

[[nodiscard]] Sheet make_sheet();

}  // namespace mimik::synthesis
