#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/fields.h"
#include "geometry/face_surface.h"
#include "preprocessing/average_face.h"

namespace mimik::preprocessing {

struct FaceTemplateOptions {
    double spacing_mm = 2.0;  ///< of neighbouring vertices, seen from the front, on a face of usual size
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("spacing_mm", self.spacing_mm);
    }
    void check() const;
};
static_assert(base::lists_every_field<FaceTemplateOptions>());

/// A landmark of the template: a point of one of its triangles, which the landmark stays on however the template is
/// bent.
struct BoundLandmark {
    std::string name;
    geometry::Triangle corners = {0, 0, 0};
    Eigen::Vector3d weights = Eigen::Vector3d::UnitX();  ///< of the corners, sum 1
};

/// The average face as a mesh that is bent on to scans: symmetric, and cut along the line where the lips meet, so that
/// the lips can part. Upper and lower vertices of the cut lie at the same places. Average frame, mm.
struct FaceTemplate {
    geometry::FaceSurface surface;
    std::vector<std::uint32_t> mirror;  ///< per vertex: the one on the other side of the face; its own on the mid-line
    std::vector<std::uint32_t> upper_lip_line, lower_lip_line;  ///< from the right corner to the left, corners included
    std::vector<BoundLandmark> landmarks;                       ///< of the average face, those that lie on the template

    [[nodiscard]] std::size_t size() const { return surface.size(); }
};

/// On which side of the cut between the lips a triangle lies; neither where it is farther than 12 mm from it or beside
/// the mouth.
enum class LipSide : std::uint8_t { neither, upper, lower };
[[nodiscard]] std::vector<LipSide> lip_sides(const FaceTemplate& face_template);

/// Per vertex, how much it belongs to one lip alone: from 1 on the cut to 0 at 12 mm from it; positive for the upper
/// lip, negative for the lower, 0 in the corners and beside the mouth.
[[nodiscard]] std::vector<double> lip_shares(const FaceTemplate& face_template);

/// Makes the template of an average face. @throws InputError if a landmark of the mouth is missing, or the average face
/// has no surface.
[[nodiscard]] FaceTemplate build_face_template(const AverageFace& average, const FaceTemplateOptions& options = {});

/// Where a bound landmark is on a bent template.
[[nodiscard]] geometry::Point position_mm(const BoundLandmark& landmark, std::span<const geometry::Point> vertices_mm);

}  // namespace mimik::preprocessing
