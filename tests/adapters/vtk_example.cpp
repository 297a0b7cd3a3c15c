// A spline of Mimik's moves a surface of VTK's, without files.
#include <cmath>

#include "adapters/vtk.h"
#include "geometry/thin_plate_spline.h"
#include "tests/adapters/example.h"

using namespace mimik;
using namespace mimik::adapters;

int main() {
    geometry::Mesh plate;
    plate.vertices_mm = {{-10, -10, 0}, {10, -10, 0}, {10, 10, 0}, {-10, 10, 0}};
    plate.faces.add(std::vector<std::uint32_t>{0, 1, 2, 3});
    Remarks remarks;
    const vtkSmartPointer<vtkPolyData> surface = to_vtk(plate, remarks);

    geometry::Mesh mesh = from_vtk(*surface, remarks);
    const std::vector<geometry::Point> from = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}, {-10, -10, -10}};
    std::vector<geometry::Point> to;
    for (const auto& p : from) to.push_back(p + geometry::Vector(1, 2, 3));
    const auto spline = geometry::ThinPlateSpline::fit(from, to);
    for (auto& vertex : mesh.vertices_mm) vertex = spline(vertex);
    const auto moved = to_vtk(mesh, remarks);
    expect(std::abs(moved->GetPoint(2)[0] - 11) < 1e-9 && std::abs(moved->GetPoint(2)[2] - 3) < 1e-9,
           "the plate moved by (1, 2, 3) mm");
    expect(moved->GetNumberOfPolys() == 1, "the quad stays a quad");
    expect(remarks.empty(), "nothing is lost on the way");
    std::cout << "VTK: a surface went through Mimik and back\n";
}
