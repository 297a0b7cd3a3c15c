// Mimik measures how far the vertices of one mesh of CGAL's lie from another, without files.
#include <cmath>

#include <CGAL/Simple_cartesian.h>

#include "adapters/cgal.h"
#include "geometry/surface_index.h"
#include "tests/adapters/example.h"

using namespace mimik;
using namespace mimik::adapters;
using CgalPoint = CGAL::Simple_cartesian<double>::Point_3;

int main() {
    CGAL::Surface_mesh<CgalPoint> plate;
    const auto a = plate.add_vertex(CgalPoint(0, 0, 0)), b = plate.add_vertex(CgalPoint(10, 0, 0)),
               c = plate.add_vertex(CgalPoint(10, 10, 0)), d = plate.add_vertex(CgalPoint(0, 10, 0));
    plate.add_face(a, b, c, d);

    Remarks remarks;
    geometry::Mesh mesh = from_cgal(plate, remarks);
    const geometry::SurfaceIndex index(mesh.vertices_mm, geometry::triangulate(mesh.faces));
    geometry::VertexAttribute distances{"distance_mm", 1, {}};
    for (auto& vertex : mesh.vertices_mm) {
        vertex.z() += 2;
        distances.values.push_back(index.closest(vertex).distance_mm);
    }
    mesh.attributes.push_back(distances);
    const auto lifted = to_cgal<CgalPoint>(mesh, remarks);
    expect(lifted.number_of_faces() == 1 && lifted.degree(*lifted.faces().begin()) == 4, "a quad stays a quad");
    const auto found = lifted.property_map<CGAL::SM_Vertex_index, double>("v:distance_mm");
    expect(found.second && std::abs(found.first[c] - 2) < 1e-12, "every vertex knows its distance");
    expect(remarks.empty(), "nothing is lost on the way");
    std::cout << "CGAL: a mesh went through Mimik and back with its distances\n";
}
