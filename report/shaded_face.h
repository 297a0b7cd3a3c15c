#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/fields.h"
#include "geometry/mesh.h"
#include "io/image.h"

namespace mimik::report {

/// Of a face without colours and picture.
inline constexpr std::array<std::uint8_t, 3> painted_skin = {222, 190, 172};

struct ShadedFaceOptions {
    int width = 480, height = 480;  ///< pixels
    double margin = 0.06;           ///< of the picture, around the face at rest
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("width", self.width);
        visit("height", self.height);
        visit("margin", self.margin);
    }
    void check() const;  ///< throws InputError
};
static_assert(base::lists_every_field<ShadedFaceOptions>());

/// Draws one face again and again as it moves, in milliseconds and without VTK: seen from the front, along -z, parallel
/// rays, a depth buffer, light from the upper left of the viewer. The view is that of the face at rest.
class FacePainter {
public:
    /// @param texture  empty: the mesh's colours, or plain skin
    /// @throws InputError for bad options, or if the mesh has no face.
    explicit FacePainter(const geometry::Mesh& mesh, io::Image texture = {}, const ShadedFaceOptions& options = {});

    /// @param vertices_mm  of the mesh, moved. From any thread.
    [[nodiscard]] io::Image picture(std::span<const geometry::Point> vertices_mm) const;

private:
    [[nodiscard]] Eigen::Vector3d colour(std::size_t triangle, const Eigen::Vector3d& shares) const;

    ShadedFaceOptions options_;
    std::vector<geometry::Triangle> triangles_;
    std::vector<geometry::TextureCoordinate> texture_coordinates_;  ///< three per triangle; empty: none
    std::vector<std::array<std::uint8_t, 3>> colours_;              ///< per vertex; empty: none
    io::Image texture_;
    double pixels_per_mm_ = 1.0;
    Eigen::Vector2d middle_mm_ = Eigen::Vector2d::Zero();
};

}  // namespace mimik::report
