#include "io/range_scan_io.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::io {

using geometry::Mesh;
using geometry::Point;
using geometry::RangeScan;
using geometry::TextureCoordinate;

namespace {

/// How `axis` changes along rows and columns: sums of differences between neighbours that were both measured.
double slope(const RangeScan& scan, Eigen::Index axis, int row_step, int col_step) {
    double sum = 0;
    const auto at = [&](int row, int col) -> const Point& {
        return scan.points_mm[static_cast<std::size_t>(row) * static_cast<std::size_t>(scan.cols) +
                              static_cast<std::size_t>(col)];
    };
    for (int row = 0; row + row_step < scan.rows; ++row)
        for (int col = 0; col + col_step < scan.cols; ++col) {
            const double difference = at(row + row_step, col + col_step)[axis] - at(row, col)[axis];
            if (std::isfinite(difference)) sum += difference;
        }
    return sum;
}

template <class T>
void flip(std::vector<T>& values, int rows, int cols, bool flip_rows, bool flip_cols) {
    if (values.empty()) return;
    const auto row_begin = [&](int row) { return values.begin() + static_cast<std::ptrdiff_t>(row) * cols; };
    if (flip_rows)
        for (int row = 0; row < rows / 2; ++row)
            std::swap_ranges(row_begin(row), row_begin(row + 1), row_begin(rows - 1 - row));
    if (flip_cols)
        for (int row = 0; row < rows; ++row) std::reverse(row_begin(row), row_begin(row + 1));
}

// Less than a pixel of the largest images: digits that an exporter cut.
constexpr double same_position = 1e-4;

/// How many points have more than one texture position: by their corners, or as several points at one place.
std::size_t points_on_seams(const Mesh& mesh) {
    const auto& faces = mesh.faces;
    const auto& corners = faces.texture_corners.empty() ? faces.corners : faces.texture_corners;
    const auto before = [](const Point& a, const Point& b) {
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    };
    std::map<Point, TextureCoordinate, decltype(before)> at_place(before);
    std::vector<char> seam(mesh.vertices_mm.size(), 0);
    std::vector<const TextureCoordinate*> of_point(mesh.vertices_mm.size(), nullptr);
    for (std::size_t k = 0; k < faces.corners.size(); ++k) {
        const auto point = faces.corners[k];
        const auto& position = mesh.texture_coordinates[corners[k]];
        auto& first = of_point[point];
        if (!first) first = &at_place.try_emplace(mesh.vertices_mm[point], position).first->second;
        if ((position - *first).cwiseAbs().maxCoeff() > same_position) seam[point] = 1;
    }
    return static_cast<std::size_t>(std::count(seam.begin(), seam.end(), 1));
}

/// One texture position per point, that of its first corner.
std::vector<TextureCoordinate> texture_per_point(const Mesh& mesh) {
    const auto& faces = mesh.faces;
    if (faces.texture_corners.empty()) return mesh.texture_coordinates;
    std::vector<TextureCoordinate> per_point(mesh.vertices_mm.size(), TextureCoordinate::Zero());
    std::vector<char> seen(per_point.size(), 0);
    for (std::size_t k = 0; k < faces.corners.size(); ++k) {
        const auto point = faces.corners[k];
        if (seen[point] == 0) per_point[point] = mesh.texture_coordinates[faces.texture_corners[k]];
        seen[point] = 1;
    }
    return per_point;
}

/// Images repeat, so positions that all lie in one unit square beside the first are moved into that. @return whether
/// they lie in one square.
bool move_into_unit_square(std::vector<TextureCoordinate>& positions) {
    if (positions.empty()) return true;
    TextureCoordinate low = positions.front(), high = low;
    for (const auto& position : positions) {
        low = low.cwiseMin(position);
        high = high.cwiseMax(position);
    }
    constexpr double slack = 1e-3;
    const TextureCoordinate square = ((low + high) / 2).array().floor();
    if (!square.allFinite() || (low - square).minCoeff() < -slack || (high - square).maxCoeff() > 1 + slack)
        return false;
    if (!square.isZero(0.0))
        for (auto& position : positions) position -= square;
    return true;
}

/// What of a mesh's texture one position per point cannot hold is kept beside it.
void take_texture(MeshFile& file, RangeScan& scan) {
    auto& mesh = file.mesh;
    const bool has_faces = mesh.faces.size() > 0 && !mesh.texture_coordinates.empty();
    scan.texture_file = file.texture_files.empty() ? std::string() : file.texture_files.front();
    if (has_faces) scan.texture_seam_points = points_on_seams(mesh);
    scan.texture_coordinates = texture_per_point(mesh);
    const bool one_square = move_into_unit_square(scan.texture_coordinates);
    if (!has_faces || (scan.texture_seam_points == 0 && one_square && file.face_textures.empty())) return;
    auto faces = mesh.faces;
    if (faces.texture_corners.empty()) faces.texture_corners = faces.corners;
    scan.charts = {mesh.vertices_mm, std::move(faces), std::move(mesh.texture_coordinates), file.texture_files,
                   file.face_textures};
}

}  // namespace

RangeScan to_range_scan(MeshFile file, const std::string& name) {
    RangeScan scan;
    bring_to_lps(file, name);
    take_texture(file, scan);
    file.mesh.faces.texture_corners.clear();
    scan.rows = file.rows;
    scan.cols = file.cols;
    scan.points_mm = std::move(file.mesh.vertices_mm);
    scan.faces = std::move(file.mesh.faces);
    scan.texture_error = std::move(file.texture_error);
    scan.material_files = std::move(file.material_files);
    scan.remarks = std::move(file.remarks);
    if (std::none_of(scan.points_mm.begin(), scan.points_mm.end(), [](const Point& p) { return p.allFinite(); }))
        throw InputError(fmt::format("{}: every point is marked as not measured (NaN)", name));
    if (!scan.organised()) {
        // A bare cloud has no use for cells without a point.
        std::size_t kept = 0;
        for (std::size_t i = 0; i < scan.points_mm.size(); ++i) {
            if (!scan.valid(i)) continue;
            scan.points_mm[kept] = scan.points_mm[i];
            if (!scan.texture_coordinates.empty()) scan.texture_coordinates[kept] = scan.texture_coordinates[i];
            ++kept;
        }
        scan.points_mm.resize(kept);
        if (!scan.texture_coordinates.empty()) scan.texture_coordinates.resize(kept);
        return scan;
    }
    const bool flip_rows = slope(scan, 1, 1, 0) < 0, flip_cols = slope(scan, 0, 0, 1) < 0;
    flip(scan.points_mm, scan.rows, scan.cols, flip_rows, flip_cols);
    flip(scan.texture_coordinates, scan.rows, scan.cols, flip_rows, flip_cols);
    return scan;
}

RangeScan read_range_scan(const std::filesystem::path& file, LengthUnit unit) {
    return to_range_scan(read_mesh_file(file, unit, MeshParts::without_attributes, BadTexture::report), file.string());
}

}  // namespace mimik::io
