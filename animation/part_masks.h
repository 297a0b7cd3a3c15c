#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "animation/prepared_target.h"
#include "base/fields.h"
#include "capture/marker_set.h"
#include "preprocessing/kept_registrations.h"

namespace mimik::animation {

struct PartMaskOptions {
    int columns = 720;  ///< texels round the half cylinder before the face: a quarter of a degree, 0.4 mm at the lips
    int rows = 720;     ///< from the template's lowest point to its highest: about 0.3 mm
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("columns", self.columns);
        visit("rows", self.rows);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<PartMaskOptions>());

/// How much a point belongs to what lies above an opening of the face (positive) or below it (negative): 1 at the
/// opening, 0 beside and far from it.
struct PartShares {
    float mouth = 0, eye_left = 0, eye_right = 0;
};

/// The shares of every vertex of a template: the lips' by its cut, the lids' by the corners of the eyes. Made once;
/// the rest is projection.
[[nodiscard]] std::vector<PartShares> template_part_shares(const preprocessing::FaceTemplate& face_template);

/// A picture of a face's parts in cylindrical coordinates: the angle about an upright axis through the head, and the
/// height (Sanchez et al. 2003, Sec. 4.3).
class PartTexture {
public:
    /// Draws a template that was bent on to a face (Sec. 6.1): so the masks are fitted to any face.
    /// @param bent_mm  its vertices there; a frame whose y is up and whose z leaves the face
    PartTexture(const preprocessing::FaceTemplate& face_template, std::span<const PartShares> shares,
                std::span<const geometry::Point> bent_mm, const PartMaskOptions& options = {});

    /// Of the texel that a point of the same frame falls on; none where the template is not.
    [[nodiscard]] PartShares at(const geometry::Point& position_mm) const;
    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] const PartShares& texel(int column, int row) const {
        return texels_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                       static_cast<std::size_t>(column)];
    }

private:
    [[nodiscard]] double column_of(const geometry::Point& p) const;
    [[nodiscard]] double row_of(const geometry::Point& p) const;
    void draw(const std::array<geometry::Point, 3>& corners, const std::array<PartShares, 3>& shares,
              std::vector<float>& depth);
    void fill_openings(std::span<const float> depth);

    int columns_ = 0, rows_ = 0;
    double axis_z_mm_ = 0, bottom_mm_ = 0, top_mm_ = 1;
    std::vector<PartShares> texels_;
};

/// Per vertex of a target, the parts it belongs to, as capture::ControlSurface::parts of the bones: one bit where it
/// lies above or below an opening, all bits elsewhere, none on an eyeball. By the texture of the template that is bent
/// on to the target; beside the mouth along the edges of the mesh, since lips that touch are a texel apart; lids where
/// their margins are known by these.
/// @throws as dense_field.
[[nodiscard]] std::vector<std::uint32_t> vertex_parts(
    const PreparedTarget& target, const std::shared_ptr<const preprocessing::KeptRegistrations>& registrations,
    const capture::MarkerSet& set = capture::builtin_marker_set(), const PartMaskOptions& options = {});

}  // namespace mimik::animation
