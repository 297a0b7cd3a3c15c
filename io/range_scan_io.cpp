#include "io/range_scan_io.h"

#include <algorithm>

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

/// One texture position per point, from those per corner. Returns at how many points corners differ.
std::size_t texture_per_point(Mesh& mesh) {
    auto& faces = mesh.faces;
    if (faces.texture_corners.empty()) return 0;
    constexpr double same = 1e-4;  // less than a pixel of the largest images: digits that an exporter cut
    std::vector<TextureCoordinate> per_point(mesh.vertices_mm.size(), TextureCoordinate::Zero());
    std::vector<char> seen(per_point.size(), 0), seam(per_point.size(), 0);
    for (std::size_t k = 0; k < faces.corners.size(); ++k) {
        const auto point = faces.corners[k];
        const auto& position = mesh.texture_coordinates[faces.texture_corners[k]];
        if (seen[point] == 0)
            per_point[point] = position;
        else if ((position - per_point[point]).cwiseAbs().maxCoeff() > same)
            seam[point] = 1;
        seen[point] = 1;
    }
    mesh.texture_coordinates = std::move(per_point);
    faces.texture_corners.clear();
    return static_cast<std::size_t>(std::count(seam.begin(), seam.end(), 1));
}

}  // namespace

RangeScan to_range_scan(MeshFile file, const std::string& name) {
    RangeScan scan;
    scan.texture_seam_points = texture_per_point(file.mesh);
    scan.rows = file.rows;
    scan.cols = file.cols;
    scan.points_mm = std::move(file.mesh.vertices_mm);
    scan.texture_coordinates = std::move(file.mesh.texture_coordinates);
    scan.faces = std::move(file.mesh.faces);
    scan.texture_file = std::move(file.texture_file);
    scan.texture_error = std::move(file.texture_error);
    scan.material_file = std::move(file.material_file);
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
