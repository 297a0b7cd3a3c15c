#pragma once

#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <pcl/PolygonMesh.h>
#include <pcl/conversions.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include "adapters/remarks.h"
#include "base/text.h"
#include "geometry/range_scan.h"

namespace mimik::adapters {

/// PCL's cloud of Mimik's scan, in the same axes and in millimetres (PCL's own tools often assume metres). On a lattice
/// the cloud is organised: PCL's row 0 is the top, Mimik's the chin side, so rows are turned over. `PclPoint` is
/// pcl::PointXYZ or any point that has x, y and z; its other fields stay as they are made. Faces and texture
/// coordinates are left out with a remark, as is what single precision rounds.
template <class PclPoint>
[[nodiscard]] pcl::PointCloud<PclPoint> to_pcl(const geometry::RangeScan& scan, Remarks& remarks) {
    pcl::PointCloud<PclPoint> cloud;
    const std::size_t count = scan.points_mm.size();
    const std::size_t cols = scan.organised() ? static_cast<std::size_t>(scan.cols) : count;
    const std::size_t rows = scan.organised() ? static_cast<std::size_t>(scan.rows) : 1;
    cloud.points.resize(count);
    cloud.width = static_cast<std::uint32_t>(cols);
    cloud.height = static_cast<std::uint32_t>(rows);
    for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t col = 0; col < cols; ++col) {
            const auto& p = scan.points_mm[row * cols + col];
            auto& point = cloud.points[(rows - 1 - row) * cols + col];
            point.x = static_cast<float>(p.x());
            point.y = static_cast<float>(p.y());
            point.z = static_cast<float>(p.z());
            cloud.is_dense = cloud.is_dense && p.allFinite();
        }
    remark_rounding(scan.points_mm, remarks);
    if (scan.faces.size() > 0)
        remarks.push_back(base::counted(scan.faces.size(), "face is", "faces are") +
                          " left out: pcl::PointCloud holds none");
    if (!scan.texture_coordinates.empty())
        remarks.push_back(
            base::counted(scan.texture_coordinates.size(), "texture coordinate is", "texture coordinates are") +
            " left out: pcl::PointCloud holds none");
    return cloud;
}

/// Mimik's scan of PCL's cloud, whose coordinates are taken for millimetres: who has metres gives 1000 as
/// `mm_per_unit`. An organised cloud becomes a lattice (rows turned over), another one a bare cloud. Points that are
/// not finite were not measured: a lattice keeps their places, a bare cloud leaves them out with a remark. Colours,
/// normals and other fields are not taken over; Mimik makes its own normals.
/// @throws InputError if width times height is not the number of points, or `mm_per_unit` is not above 0.
template <class PclPoint>
[[nodiscard]] geometry::RangeScan range_scan_from(const pcl::PointCloud<PclPoint>& cloud, Remarks& remarks,
                                                  double mm_per_unit = 1.0) {
    const std::size_t rows = cloud.height, cols = cloud.width;
    if (rows * cols != cloud.size())
        throw InputError("pcl::PointCloud: " + std::to_string(cols) + " x " + std::to_string(rows) + " are not its " +
                         std::to_string(cloud.size()) + " points; set width and height");
    if (!(mm_per_unit > 0))
        throw InputError("pcl::PointCloud: mm_per_unit is " + std::to_string(mm_per_unit) +
                         "; give the length of a unit, 1000 for metres");
    geometry::RangeScan scan;
    if (rows > 1) {
        scan.rows = static_cast<int>(rows);
        scan.cols = static_cast<int>(cols);
    }
    std::size_t unmeasured = 0;
    for (std::size_t row = rows; row-- > 0;)
        for (std::size_t col = 0; col < cols; ++col) {
            const auto& p = cloud.points[row * cols + col];
            geometry::Point point(mm_per_unit * p.x, mm_per_unit * p.y, mm_per_unit * p.z);
            if (!point.allFinite()) {
                if (rows <= 1) {
                    ++unmeasured;
                    continue;
                }
                point.setConstant(std::numeric_limits<double>::quiet_NaN());
            }
            scan.points_mm.push_back(point);
        }
    if (unmeasured > 0)
        remarks.push_back(base::counted(unmeasured, "point that is not finite is", "points that are not finite are") +
                          " left out");
    return scan;
}

/// PCL's mesh of Mimik's, in millimetres, with colours if there are any. Faces keep their corners, quads too. Texture
/// coordinates and attributes are left out with a remark, as is what single precision rounds.
/// @throws InputError if there are more vertices than PCL's indices count, or a face names one that is not there.
[[nodiscard]] inline pcl::PolygonMesh to_pcl(const geometry::Mesh& mesh, Remarks& remarks) {
    check_count(mesh.vertices_mm.size(), static_cast<std::size_t>(std::numeric_limits<pcl::index_t>::max()),
                "pcl::PolygonMesh");
    pcl::PolygonMesh result;
    const auto fill = [&](auto cloud) {
        for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v) {
            typename decltype(cloud)::PointType point;
            point.x = static_cast<float>(mesh.vertices_mm[v].x());
            point.y = static_cast<float>(mesh.vertices_mm[v].y());
            point.z = static_cast<float>(mesh.vertices_mm[v].z());
            if constexpr (std::is_same_v<typename decltype(cloud)::PointType, pcl::PointXYZRGB>) {
                point.r = mesh.colours[v][0];
                point.g = mesh.colours[v][1];
                point.b = mesh.colours[v][2];
            }
            cloud.push_back(point);
        }
        pcl::toPCLPointCloud2(cloud, result.cloud);
    };
    if (mesh.colours.empty())
        fill(pcl::PointCloud<pcl::PointXYZ>());
    else
        fill(pcl::PointCloud<pcl::PointXYZRGB>());
    std::size_t small = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        if (mesh.faces[f].size() < 3) {
            ++small;
            continue;
        }
        pcl::Vertices face;
        for (const auto v : mesh.faces[f]) {
            check_index(v, mesh.vertices_mm.size(), f, "pcl::PolygonMesh");
            face.vertices.push_back(static_cast<pcl::index_t>(v));
        }
        result.polygons.push_back(face);
    }
    remark_small_faces(small, remarks);
    remark_rounding(mesh.vertices_mm, remarks);
    remark_texture(mesh, "pcl::PolygonMesh", remarks);
    remark_attributes(mesh, "pcl::PolygonMesh", remarks);
    return result;
}

/// Mimik's mesh of PCL's: polygons as they are, the fields "rgb" or "rgba" as colours, the others (normals) left out
/// with a remark. Units as above.
/// @throws InputError if a polygon names a point that is not there, there is no x, y and z, or one is not finite.
[[nodiscard]] inline geometry::Mesh from_pcl(const pcl::PolygonMesh& mesh, Remarks& remarks, double mm_per_unit = 1.0) {
    if (!(mm_per_unit > 0))
        throw InputError("pcl::PolygonMesh: mm_per_unit is " + std::to_string(mm_per_unit) +
                         "; give the length of a unit, 1000 for metres");
    std::string others;
    bool coloured = false;
    std::size_t coordinates = 0;
    for (const auto& field : mesh.cloud.fields) {
        if (field.name == "x" || field.name == "y" || field.name == "z")
            ++coordinates;
        else if (field.name == "rgb" || field.name == "rgba")
            coloured = true;
        else
            others += (others.empty() ? "" : ", ") + field.name;
    }
    if (coordinates != 3) throw InputError("pcl::PolygonMesh: its cloud has no fields x, y and z; fill them");
    if (!others.empty()) remarks.push_back("fields left out: " + others);
    geometry::Mesh result;
    const auto read = [&](auto cloud) {
        pcl::fromPCLPointCloud2(mesh.cloud, cloud);
        for (const auto& p : cloud.points) {
            result.vertices_mm.emplace_back(mm_per_unit * p.x, mm_per_unit * p.y, mm_per_unit * p.z);
            if (!result.vertices_mm.back().allFinite())
                throw InputError("pcl::PolygonMesh: vertex " + std::to_string(result.vertices_mm.size() - 1) +
                                 " has a coordinate that is not finite; remove it and its polygons");
            if constexpr (std::is_same_v<typename decltype(cloud)::PointType, pcl::PointXYZRGB>)
                result.colours.push_back({p.r, p.g, p.b});
        }
    };
    if (coloured)
        read(pcl::PointCloud<pcl::PointXYZRGB>());
    else
        read(pcl::PointCloud<pcl::PointXYZ>());
    std::size_t small = 0;
    std::vector<std::uint32_t> corners;
    for (std::size_t f = 0; f < mesh.polygons.size(); ++f) {
        corners.clear();
        for (const auto v : mesh.polygons[f].vertices) {
            check_index(static_cast<std::uint64_t>(v), result.vertices_mm.size(), f, "pcl::PolygonMesh");
            corners.push_back(static_cast<std::uint32_t>(v));
        }
        if (corners.size() < 3)
            ++small;
        else
            result.faces.add(corners);
    }
    remark_small_faces(small, remarks);
    return result;
}

}  // namespace mimik::adapters
