#include "remeshing/hausdorff.h"

#include <string>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <fmt/format.h>

#include "adapters/cgal.h"
#include "base/errors.h"
#include "remeshing/surface.h"

namespace mimik::remeshing {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

/// CGAL's bounds divide by the area.
Surface with_area(const geometry::Mesh& mesh) {
    std::vector<std::string> unsaid;  // where it is cut changes no distance
    adapters::Remarks none;           // nothing but the surface is handed over
    auto surface = adapters::to_cgal<Kernel::Point_3>(bare_surface(mesh, unsaid).mesh, none);
    std::vector<Surface::Face_index> flat;
    for (const auto f : surface.faces()) {
        const auto h = surface.halfedge(f);
        if (CGAL::collinear(surface.point(surface.source(h)), surface.point(surface.target(h)),
                            surface.point(surface.target(surface.next(h)))))
            flat.push_back(f);
    }
    for (const auto f : flat) CGAL::Euler::remove_face(surface.halfedge(f), surface);
    if (surface.number_of_faces() == 0) throw InputError("the mesh has no face of any area; give a surface");
    surface.collect_garbage();
    return surface;
}

}  // namespace

Hausdorff hausdorff(const geometry::Mesh& first, const geometry::Mesh& second, double error_bound_mm) {
    if (!(error_bound_mm > 0)) throw InputError(fmt::format("error_bound_mm is {}; give more than 0", error_bound_mm));
    const auto a = with_area(first), b = with_area(second);
    Hausdorff result;
    result.error_bound_mm = error_bound_mm;
    result.first_to_second_mm = PMP::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(a, b, error_bound_mm);
    result.second_to_first_mm = PMP::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(b, a, error_bound_mm);
    return result;
}

}  // namespace mimik::remeshing
