#include "preprocessing/bake_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/polygon_triangles.h"
#include "geometry/surface_index.h"

namespace mimik::preprocessing {
namespace {

using geometry::Point;
using geometry::QuadGrid;
using geometry::TextureCoordinate;
using geometry::Triangle;
using Colour = std::array<double, 3>;

constexpr std::array<std::uint8_t, 3> skin = {204, 158, 135};

/// A triangle's texture positions, moved by whole numbers so that they lie near the unit square.
struct ChartTriangle {
    std::array<TextureCoordinate, 3> uv;
    std::uint32_t image = 0;  ///< beyond the images: none
    bool repeats = false;     ///< reaches into a neighbouring copy of the image
};

/// An image and which of its pixels charts cover.
class ChartImage {
public:
    explicit ChartImage(const io::Image& image)
        : image_(image),
          covered_(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height), 0),
          budget_(64 * static_cast<double>(covered_.size())) {}

    /// Marks the pixels whose centres lie in the triangle or just beside it.
    void cover(const ChartTriangle& t) {
        if (budget_ < 0) return;
        std::array<Eigen::Vector2d, 3> p;
        for (std::size_t k = 0; k < 3; ++k) p[k] = pixel_of(t.uv[k]);
        const Eigen::Vector2d low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
        budget_ -= (high.x() - low.x() + 1) * (high.y() - low.y() + 1);
        if (!(budget_ >= 0)) {  // positions that no atlas has: any pixel will do
            budget_ = -1;
            std::fill(covered_.begin(), covered_.end(), 1);
            return;
        }
        const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
            return a.x() * b.y() - a.y() * b.x();
        };
        const double turn = cross(p[1] - p[0], p[2] - p[0]) < 0 ? -1 : 1;
        for (auto y = std::llround(low.y()); y <= std::llround(high.y()); ++y)
            for (auto x = std::llround(low.x()); x <= std::llround(high.x()); ++x) {
                const Eigen::Vector2d centre(static_cast<double>(x), static_cast<double>(y));
                bool inside = true;
                for (std::size_t k = 0; k < 3 && inside; ++k) {
                    const Eigen::Vector2d edge = p[(k + 1) % 3] - p[k];
                    // Rounding apart: a pixel on the edge belongs to the chart.
                    inside = turn * cross(edge, centre - p[k]) >= -1e-9 * (1 + edge.norm());
                }
                if (inside) covered_[at(x, y, t.repeats)] = 1;
            }
    }

    [[nodiscard]] Colour colour(const TextureCoordinate& uv, bool repeats) const {
        const auto p = pixel_of(uv);
        const double left = std::floor(p.x()), top = std::floor(p.y());
        Colour sum{}, nearest{};
        double weights = 0, nearest_weight = -1;
        for (const int dy : {0, 1})
            for (const int dx : {0, 1}) {
                const double weight = (1 - std::abs(p.x() - left - dx)) * (1 - std::abs(p.y() - top - dy));
                const auto pixel =
                    at(static_cast<std::int64_t>(left) + dx, static_cast<std::int64_t>(top) + dy, repeats);
                const double counted = covered_[pixel] != 0 ? weight : 0;
                weights += counted;
                for (std::size_t c = 0; c < 3; ++c) sum[c] += counted * image_.rgb[3 * pixel + c];
                if (weight <= nearest_weight) continue;
                nearest_weight = weight;
                for (std::size_t c = 0; c < 3; ++c) nearest[c] = image_.rgb[3 * pixel + c];
            }
        if (weights < 1e-6) return nearest;
        for (auto& channel : sum) channel /= weights;
        return sum;
    }

private:
    /// Pixel centres are whole numbers; rows from above.
    [[nodiscard]] Eigen::Vector2d pixel_of(const TextureCoordinate& uv) const {
        return {uv.x() * image_.width - 0.5, (1.0 - uv.y()) * image_.height - 0.5};
    }
    [[nodiscard]] std::size_t at(std::int64_t x, std::int64_t y, bool repeats) const {
        const std::int64_t width = image_.width, height = image_.height;
        const auto wrapped = [&](std::int64_t i, std::int64_t n) {
            return repeats ? ((i % n) + n) % n : std::clamp<std::int64_t>(i, 0, n - 1);
        };
        return static_cast<std::size_t>(wrapped(y, height) * width + wrapped(x, width));
    }

    const io::Image& image_;
    std::vector<std::uint8_t> covered_;
    double budget_;
};

/// The scan's surface with its charts.
class ChartSurface {
public:
    ChartSurface(const geometry::TextureCharts& charts, std::span<const std::optional<io::Image>> images) {
        // Polygons of corner numbers: a triangle then knows its texture positions and its face.
        const auto& faces = charts.faces;
        geometry::Faces numbered;
        numbered.first = faces.first;
        std::vector<std::uint32_t> face_of_corner;
        std::vector<Point> corner_points_mm;
        for (std::uint32_t f = 0; f < faces.size(); ++f)
            for (auto k = faces.first[f]; k < faces.first[f + 1]; ++k) {
                numbered.corners.push_back(k);
                face_of_corner.push_back(f);
                corner_points_mm.push_back(charts.points_mm[faces.corners[k]]);
            }
        std::vector<Triangle> triangles;
        for (const auto& t : geometry::triangulate(numbered, corner_points_mm)) {
            triangles.push_back({faces.corners[t[0]], faces.corners[t[1]], faces.corners[t[2]]});
            ChartTriangle chart;
            chart.image = charts.image_of_face.empty() ? 0 : charts.image_of_face[face_of_corner[t[0]]];
            for (std::size_t k = 0; k < 3; ++k) chart.uv[k] = charts.positions[faces.texture_corners[t[k]]];
            move_near_unit_square(chart);
            charts_.push_back(chart);
        }
        index_.emplace(charts.points_mm, triangles);
        for (const auto& image : images) {
            images_.emplace_back();
            if (image) images_.back().emplace(*image);
        }
        for (const auto& chart : charts_)
            if (chart.image < images_.size() && images_[chart.image]) images_[chart.image]->cover(chart);
    }

    [[nodiscard]] std::vector<geometry::SurfacePoint> closest(std::span<const Point> points_mm) const {
        return index_->closest(points_mm);
    }

    [[nodiscard]] Colour colour(const geometry::SurfacePoint& point) const {
        const auto& chart = charts_[point.triangle];
        const auto* image = image_of(chart);
        if (!image) return {skin[0], skin[1], skin[2]};
        TextureCoordinate uv = TextureCoordinate::Zero();
        for (std::size_t k = 0; k < 3; ++k) uv += point.barycentric[static_cast<Eigen::Index>(k)] * chart.uv[k];
        return image->colour(uv, chart.repeats);
    }

private:
    static void move_near_unit_square(ChartTriangle& chart) {
        const TextureCoordinate square = ((chart.uv[0] + chart.uv[1] + chart.uv[2]) / 3).array().floor();
        constexpr double slack = 1e-3;
        for (auto& uv : chart.uv) {
            uv -= square;
            chart.repeats = chart.repeats || uv.minCoeff() < -slack || uv.maxCoeff() > 1 + slack;
        }
        // What is not finite, or so far away that nothing is left behind the point, has no picture.
        for (const auto& uv : chart.uv)
            if (!uv.allFinite() || uv.cwiseAbs().maxCoeff() > 1e4)
                chart.image = std::numeric_limits<std::uint32_t>::max();
    }
    [[nodiscard]] const ChartImage* image_of(const ChartTriangle& chart) const {
        return chart.image < images_.size() && images_[chart.image] ? &*images_[chart.image] : nullptr;
    }

    std::optional<geometry::SurfaceIndex> index_;
    std::vector<ChartTriangle> charts_;
    std::vector<std::optional<ChartImage>> images_;
};

/// Where a place between vertices lies on the grid, from those of its four vertices that are inside; nothing if none
/// is.
std::optional<Point> on_grid(const QuadGrid& grid, double row, double col) {
    const auto first = [](double at, int count) { return std::clamp(static_cast<int>(std::floor(at)), 0, count - 2); };
    const int r = first(row, grid.rows), c = first(col, grid.cols);
    const double fr = row - r, fc = col - c;
    Point place = Point::Zero();
    double depth = 0, weights = 0;
    for (const int dr : {0, 1})
        for (const int dc : {0, 1}) {
            const auto& vertex = grid.vertices_mm[grid.index(r + dr, c + dc)];
            const double weight = (dr == 0 ? 1 - fr : fr) * (dc == 0 ? 1 - fc : fc);
            place.head<2>() += weight * vertex.head<2>();
            if (!grid.inside(grid.index(r + dr, c + dc))) continue;
            const double counted = std::max(weight, 1e-3);  // beside the border, where one weight may be below 0
            depth += counted * vertex.z();
            weights += counted;
        }
    if (weights <= 0) return std::nullopt;
    place.z() = depth / weights;
    return place;
}

}  // namespace

io::Image bake_texture(const geometry::TextureCharts& charts, std::span<const std::optional<io::Image>> images,
                       QuadGrid& grid) {
    const int per_vertex = std::clamp(1024 / std::max(grid.rows, grid.cols), 1, 8);
    io::Image picture{per_vertex * grid.cols, per_vertex * grid.rows, {}};
    const auto width = static_cast<std::size_t>(picture.width);
    picture.rgb.resize(3 * width * static_cast<std::size_t>(picture.height));
    for (std::size_t k = 0; k < picture.rgb.size(); ++k) picture.rgb[k] = skin[k % 3];

    const ChartSurface surface(charts, images);
    constexpr int rows_at_once = 64;  // so that answers take little memory
    std::vector<Point> places_mm;
    std::vector<std::size_t> pixels;
    for (int first = 0; first < picture.height; first += rows_at_once) {
        places_mm.clear();
        pixels.clear();
        for (int y = first; y < std::min(first + rows_at_once, picture.height); ++y)
            for (int x = 0; x < picture.width; ++x) {
                const double row = (picture.height - y - 0.5) / per_vertex - 0.5, col = (x + 0.5) / per_vertex - 0.5;
                const auto place = on_grid(grid, row, col);
                if (!place) continue;
                places_mm.push_back(*place);
                pixels.push_back(static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x));
            }
        const auto nearest = surface.closest(places_mm);
        for (std::size_t k = 0; k < nearest.size(); ++k) {
            const auto colour = surface.colour(nearest[k]);
            for (std::size_t c = 0; c < 3; ++c)
                picture.rgb[3 * pixels[k] + c] = static_cast<std::uint8_t>(std::lround(colour[c]));
        }
    }
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    grid.texture_coordinates.assign(grid.size(), {nan, nan});
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col)
            if (const auto v = grid.index(row, col); grid.inside(v))
                grid.texture_coordinates[v] = {(col + 0.5) / grid.cols, (row + 0.5) / grid.rows};
    return picture;
}

}  // namespace mimik::preprocessing
