#include "preprocessing/neutral_alignment.h"

#include <fmt/format.h>

#include "geometry/face_axes.h"
#include "geometry/surface_index.h"
#include "preprocessing/normalisation.h"

namespace mimik::preprocessing {

using geometry::Point;

void align_to_neutral(Face& face, const Face& neutral, const geometry::VertexMask& stable,
                      const RigidAlignmentOptions& options) {
    // Of 1, 0.4, 0.2, 0.1 and 0 for what the jaw carries, 0.2 came closest to true poses.
    constexpr double skull_weight = 1.0, jaw_weight = 0.2, below_nose_tip = 0.05;  // the last in outer-eye distances
    const auto marks = geometry::transformed(neutral.landmarks, neutral.average_from_scan);
    const double jaw_below_mm =
        marks.position_mm("nose_tip").y() - below_nose_tip * geometry::outer_eye_distance_mm(marks);
    std::vector<Point> still;
    std::vector<double> weights;
    for (std::size_t v = 0; v < stable.size(); ++v) {
        if (!stable[v] || !neutral.grid.measured(v)) continue;
        still.push_back(neutral.grid.vertices_mm[v]);
        const double y_mm = (neutral.average_from_scan * still.back()).y();
        weights.push_back(y_mm < jaw_below_mm ? jaw_weight : skull_weight);
    }
    const geometry::SurfaceIndex surface(face.grid.vertices_mm,
                                         geometry::triangles(face.grid, geometry::BridgedVertices::leave_out));
    const auto start = rigid_by_landmarks(neutral.landmarks, face.landmarks);
    const auto alignment = align_rigidly(still, surface, start, options, weights);
    face.neutral_from_scan = alignment.target_from_source.inverse();
    face.alignment_rms_mm = alignment.rms_mm;
    if (!alignment.converged)
        face.remarks.push_back(fmt::format("alignment to the neutral did not settle in {} steps (rms {:.3f} mm)",
                                           alignment.iterations, alignment.rms_mm));
}

}  // namespace mimik::preprocessing
