#pragma once

#include <array>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "database/truth.h"
#include "geometry/face_surface.h"
#include "geometry/surface_index.h"
#include "modeling/expression_model.h"
#include "preprocessing/average_face.h"
#include "preprocessing/face.h"

namespace mimik::animation {

/// A neutral face in the average frame, ready for splines.
struct NormalisedTarget {
    geometry::Transform average_from_target;
    geometry::Landmarks landmarks, snapped_landmarks;  ///< as marked; at the nearest vertices (thesis 5.4)
    std::vector<geometry::Point> vertices_mm;          ///< those that are not present are of no meaning
    geometry::SurfaceIndex surface;
};

/// Where the vertices of a target lie on its true neutral surface: carries any subject's true field over.
struct MaterialPoints {
    database::MaterialPoints on_truth;              ///< of the vertices that are present, one after another
    std::vector<std::optional<std::size_t>> place;  ///< per vertex: which of them it is
    Eigen::Matrix3d target_from_head;               ///< turns the truth's vectors into the target's frame

    /// What a field on the true surface (head frame) does at vertex v, in the target's frame; zero if v is not present.
    [[nodiscard]] geometry::Vector at(const std::vector<geometry::Vector>& field_mm, std::size_t v) const;
};

/// A neutral face made ready to be animated many times. What a method asks for is made when the first asks, from any
/// thread.
class PreparedTarget {
public:
    /// A preprocessed neutral scan.
    /// @param truth  of this scan, where it is known; a reference is kept.
    explicit PreparedTarget(const preprocessing::Face& neutral, const database::TrueScan* truth = nullptr);
    /// Anybody's face: a mesh with landmarks, say, by geometry::face_surface(). It is brought to the average face by
    /// its landmarks. @throws InputError naming a landmark that is missing.
    PreparedTarget(geometry::FaceSurface neutral, const preprocessing::AverageFace& average, std::string name = "face");
    ~PreparedTarget();
    PreparedTarget(PreparedTarget&&) noexcept;

    [[nodiscard]] const std::string& name() const;
    [[nodiscard]] const preprocessing::Face* face() const;       ///< the preprocessed scan; null: somebody's mesh
    [[nodiscard]] const geometry::FaceSurface& surface() const;  ///< the neutral face, in its own frame
    [[nodiscard]] const geometry::Transform& average_from_target(modeling::Normalisation normalisation) const;
    [[nodiscard]] const NormalisedTarget& normalised(modeling::Normalisation normalisation) const;
    [[nodiscard]] bool has_truth() const;
    [[nodiscard]] const database::TrueScan* truth() const;  ///< of this scan; null: it is not known
    /// @throws InputError without a truth.
    [[nodiscard]] const MaterialPoints& material_points() const;
    /// What somebody needs of this face again and again: made when `owner` first asks, then kept with the face.
    [[nodiscard]] std::shared_ptr<const void> kept(const std::shared_ptr<const void>& owner,
                                                   const std::function<std::shared_ptr<const void>()>& make) const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// The present vertex that lies nearest. @return its position in the average frame
[[nodiscard]] geometry::Point nearest_vertex(const PreparedTarget& target, const NormalisedTarget& normalised,
                                             const geometry::Point& query_mm);

}  // namespace mimik::animation
