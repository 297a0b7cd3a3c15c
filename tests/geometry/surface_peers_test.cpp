#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "bench/bench_scan.h"
#include "bench/peers/closest_point_peer.h"
#include "geometry/surface_index.h"

namespace mimik::geometry {
namespace {

/// A face beside another, as in scoring, and points all around it.
std::vector<Point> queries() {
    auto points = bench::make_surface(2, 4.0).vertices_mm;
    std::mt19937_64 engine(5);
    const auto uniform = [&] { return 2.0 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1.0; };
    for (int i = 0; i < 2000; ++i) points.emplace_back(150 * uniform(), 200 * uniform(), 200 * uniform());
    return points;
}

void expect_same_distances(const peers::ClosestPointPeer& peer, const SurfaceIndex& index) {
    const auto points = queries();
    const auto answers = index.closest(points);
    for (std::size_t i = 0; i < points.size(); ++i)
        // Both compute in double; coordinates of some 200 mm carry 3e-14, and CGAL takes a dozen steps on them.
        ASSERT_NEAR(answers[i].distance_mm, (peer.closest(points[i]) - points[i]).norm(), 1e-12) << i;
}

TEST(SurfaceIndex, agrees_with_the_cgal_tree_on_a_face) {
    const auto face = bench::make_surface(1, 0.0);
    expect_same_distances(*peers::make_cgal_peer(face.vertices_mm, face.triangles),
                          SurfaceIndex(face.vertices_mm, face.triangles));
}

TEST(SurfaceIndex, agrees_with_embree_on_a_face) {
    const auto face = bench::make_surface(1, 0.0);
    expect_same_distances(*peers::make_embree_peer(face.vertices_mm, face.triangles),
                          SurfaceIndex(face.vertices_mm, face.triangles));
}

}  // namespace
}  // namespace mimik::geometry
