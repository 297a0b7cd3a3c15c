#include "report/shaded_face.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/errors.h"
#include "geometry/polygon_triangles.h"

namespace mimik::report {

using geometry::Point;
using geometry::Vector;

void ShadedFaceOptions::check() const {
    constexpr int most = 8192;
    if (width < 16 || width > most || height < 16 || height > most)
        throw InputError(fmt::format("width and height are {} and {}; give 16 to {} pixels", width, height, most));
    if (!(margin >= 0 && margin < 0.5)) throw InputError(fmt::format("margin is {}; give 0 to below 0.5", margin));
}

FacePainter::FacePainter(const geometry::Mesh& mesh, io::Image texture, const ShadedFaceOptions& options)
    : options_(options), colours_(mesh.colours), texture_(std::move(texture)) {
    options.check();
    // One triangle mesh of the polygons; texture corners go along as one more set of indices.
    if (mesh.faces.size() == 0) throw InputError("the face to be drawn has no surface; give a mesh with faces");
    const bool textured = texture_.width > 0 && !mesh.texture_coordinates.empty();
    std::vector<Point> corners;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto face = mesh.faces[f];
        corners.clear();
        for (const auto v : face) corners.push_back(mesh.vertices_mm[v]);
        for (const auto& t : geometry::cut_polygon(corners)) {
            triangles_.push_back({face[t[0]], face[t[1]], face[t[2]]});
            for (std::size_t k = 0; k < 3 && textured; ++k) {
                const auto at = mesh.faces.first[f] + t[k];
                const auto uv =
                    mesh.faces.texture_corners.empty() ? mesh.faces.corners[at] : mesh.faces.texture_corners[at];
                texture_coordinates_.push_back(mesh.texture_coordinates[uv]);
            }
        }
    }
    Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const auto& t : triangles_)
        for (const auto v : t) {
            low = low.cwiseMin(mesh.vertices_mm[v].head<2>());
            high = high.cwiseMax(mesh.vertices_mm[v].head<2>());
        }
    const Eigen::Vector2d size = (high - low).cwiseMax(1e-6);
    middle_mm_ = 0.5 * (low + high);
    pixels_per_mm_ = (1 - 2 * options.margin) * std::min(options.width / size.x(), options.height / size.y());
}

Eigen::Vector3d FacePainter::colour(std::size_t triangle, const Eigen::Vector3d& shares) const {
    if (!texture_coordinates_.empty()) {
        geometry::TextureCoordinate uv = geometry::TextureCoordinate::Zero();
        for (std::size_t k = 0; k < 3; ++k)
            uv += shares[static_cast<Eigen::Index>(k)] * texture_coordinates_[3 * triangle + k];
        const auto pixel = [](double share, int count) {
            return std::clamp(static_cast<int>(share * count), 0, count - 1);
        };
        const auto at = 3 * (static_cast<std::size_t>(pixel(1 - uv.y(), texture_.height)) *
                                 static_cast<std::size_t>(texture_.width) +
                             static_cast<std::size_t>(pixel(uv.x(), texture_.width)));
        return {static_cast<double>(texture_.rgb[at]), static_cast<double>(texture_.rgb[at + 1]),
                static_cast<double>(texture_.rgb[at + 2])};
    }
    if (colours_.empty())
        return {static_cast<double>(painted_skin[0]), static_cast<double>(painted_skin[1]),
                static_cast<double>(painted_skin[2])};
    Eigen::Vector3d mixed = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
        const auto& c = colours_[triangles_[triangle][k]];
        mixed += shares[static_cast<Eigen::Index>(k)] * Eigen::Vector3d(c[0], c[1], c[2]);
    }
    return mixed;
}

io::Image FacePainter::picture(std::span<const Point> vertices_mm) const {
    const auto normals = geometry::vertex_normals(vertices_mm, triangles_);
    const int width = options_.width, height = options_.height;
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    io::Image image{width, height, std::vector<std::uint8_t>(3 * pixels, 246)};
    std::vector<double> depth(pixels, -std::numeric_limits<double>::infinity());
    const Vector light = Vector(-0.35, 0.45, 1).normalized();
    const auto on_screen = [&](const Point& p) {
        return Eigen::Vector2d(0.5 * width + pixels_per_mm_ * (p.x() - middle_mm_.x()),
                               0.5 * height - pixels_per_mm_ * (p.y() - middle_mm_.y()));
    };
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        const auto& corners = triangles_[t];
        std::array<Eigen::Vector2d, 3> at;
        for (std::size_t k = 0; k < 3; ++k) at[k] = on_screen(vertices_mm[corners[k]]);
        const Eigen::Vector2d a = at[1] - at[0], b = at[2] - at[0];
        const double area = a.x() * b.y() - a.y() * b.x();
        if (!(std::abs(area) > 1e-9)) continue;
        const auto bound = [](double value, int count) {
            return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(count)));
        };
        const auto [left, right] = std::minmax({at[0].x(), at[1].x(), at[2].x()});
        const auto [top, bottom] = std::minmax({at[0].y(), at[1].y(), at[2].y()});
        for (int row = bound(std::floor(top), height); row < bound(std::ceil(bottom), height); ++row)
            for (int col = bound(std::floor(left), width); col < bound(std::ceil(right), width); ++col) {
                const Eigen::Vector2d p = Eigen::Vector2d(col + 0.5, row + 0.5) - at[0];
                const double s = (p.x() * b.y() - p.y() * b.x()) / area, u = (a.x() * p.y() - a.y() * p.x()) / area;
                if (s < 0 || u < 0 || s + u > 1) continue;
                const Eigen::Vector3d shares(1 - s - u, s, u);
                double z = 0;
                Vector normal = Vector::Zero();
                for (std::size_t k = 0; k < 3; ++k) {
                    const double share = shares[static_cast<Eigen::Index>(k)];
                    z += share * vertices_mm[corners[k]].z();
                    normal += share * normals[corners[k]];
                }
                const auto pixel =
                    static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(col);
                if (z <= depth[pixel]) continue;
                depth[pixel] = z;
                // Scans are open surfaces, so both sides are lit.
                const double lit = 0.25 + 0.75 * std::abs(normal.normalized().dot(light));
                const Eigen::Vector3d shown = colour(t, shares) * lit;
                for (std::size_t c = 0; c < 3; ++c)
                    image.rgb[3 * pixel + c] =
                        static_cast<std::uint8_t>(std::clamp(shown[static_cast<Eigen::Index>(c)], 0.0, 255.0));
            }
    }
    return image;
}

}  // namespace mimik::report
