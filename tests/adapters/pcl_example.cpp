// A mesh and a cloud of PCL's go through Mimik and back, without files.
#include <cmath>
#include <limits>

#include "adapters/pcl.h"
#include "geometry/thin_plate_spline.h"
#include "tests/adapters/example.h"

using namespace mimik;
using namespace mimik::adapters;

namespace {

/// A spline of Mimik's moves a mesh of PCL's.
void warp_a_mesh() {
    pcl::PointCloud<pcl::PointXYZ> corners;
    for (const auto& [x, y] : {std::pair(-10.F, -10.F), {10.F, -10.F}, {10.F, 10.F}, {-10.F, 10.F}})
        corners.push_back(pcl::PointXYZ(x, y, 0));
    pcl::PolygonMesh plate;
    pcl::toPCLPointCloud2(corners, plate.cloud);
    plate.polygons.resize(1);
    plate.polygons[0].vertices = {0, 1, 2, 3};

    Remarks remarks;
    geometry::Mesh mesh = from_pcl(plate, remarks);
    expect(mesh.faces.size() == 1 && mesh.faces[0].size() == 4, "a quad stays a quad");
    const std::vector<geometry::Point> from = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}, {-10, -10, -10}};
    std::vector<geometry::Point> to;
    for (const auto& p : from) to.push_back(p + geometry::Vector(1, 2, 3));
    const auto spline = geometry::ThinPlateSpline::fit(from, to);
    for (auto& vertex : mesh.vertices_mm) vertex = spline(vertex);
    const pcl::PolygonMesh moved = to_pcl(mesh, remarks);
    pcl::fromPCLPointCloud2(moved.cloud, corners);
    expect(std::abs(corners[2].x - 11) < 1e-4 && std::abs(corners[2].z - 3) < 1e-4, "the plate moved by (1, 2, 3) mm");
    expect(moved.polygons[0].vertices == plate.polygons[0].vertices, "the face has the same corners");
    expect(remarks.empty(), "nothing is lost on the way");
}

void clouds_keep_their_lattice() {
    pcl::PointCloud<pcl::PointXYZ> cloud(3, 2);  // three columns, two rows, the upper one first
    for (int row = 0; row < 2; ++row)
        for (int col = 0; col < 3; ++col)
            cloud.at(col, row) =
                pcl::PointXYZ(0.001F * static_cast<float>(col), 0.001F * static_cast<float>(1 - row), 0);
    cloud.at(0, 0).x = std::numeric_limits<float>::quiet_NaN();
    Remarks remarks;
    const auto scan = range_scan_from(cloud, remarks, 1000);
    expect(scan.rows == 2 && scan.cols == 3, "an organised cloud is a lattice");
    expect(std::abs(scan.points_mm[2].x() - 2) < 1e-6 && scan.points_mm[2].y() == 0,
           "metres become mm, rows go upwards");
    expect(!scan.valid(3), "what was not measured keeps its place");
    const auto back = to_pcl<pcl::PointXYZ>(scan, remarks);
    expect(back.width == 3 && back.height == 2 && !back.is_dense && std::isnan(back.at(0, 0).x),
           "and comes back there");
    expect(remarks.empty(), "nothing is lost on the way");

    cloud.height = 1;
    cloud.width = 6;
    expect(range_scan_from(cloud, remarks).points_mm.size() == 5 && says(remarks, "1 point that"),
           "a bare cloud drops it");
    cloud.width = 5;
    expect(refused([&] { (void)range_scan_from(cloud, remarks); }, "5 x 1"), "a false width is refused");
}

void losses_are_said_or_refused() {
    geometry::Mesh mesh;
    mesh.vertices_mm = {{1e6 + 0.03, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.colours = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
    mesh.texture_coordinates.resize(3);
    mesh.attributes.push_back({"distance_mm", 1, {1, 2, 3}});
    mesh.faces.add(std::vector<std::uint32_t>{0, 1, 2});
    mesh.faces.add(std::vector<std::uint32_t>{0, 1});
    Remarks remarks;
    auto out = to_pcl(mesh, remarks);
    for (const auto* words : {"1 face of", "single precision", "texture", "distance_mm"})
        expect(says(remarks, words), std::string("a remark says ") + words);
    expect(from_pcl(out, remarks).colours == mesh.colours, "colours are kept");
    out.polygons[0].vertices[0] = 3;
    expect(refused([&] { (void)from_pcl(out, remarks); }, "face 0 names vertex 3"), "an index too large is refused");
    pcl::PointCloud<pcl::PointNormal> normals(1, 1);
    pcl::PolygonMesh with_normals;
    pcl::toPCLPointCloud2(normals, with_normals.cloud);
    (void)from_pcl(with_normals, remarks);
    expect(says(remarks, "normal_x"), "normals that are left out are named");
    expect(refused([&] { (void)from_pcl(pcl::PolygonMesh(), remarks); }, "no fields"), "no coordinates are refused");
}

}  // namespace

int main() {
    warp_a_mesh();
    clouds_keep_their_lattice();
    losses_are_said_or_refused();
    std::cout << "PCL: a mesh and a cloud went through Mimik and back\n";
}
