#include <gtest/gtest.h>

#include "tests/support/analytic_workspace.h"

// [sample]
#include "animation/animate.h"

using namespace mimik;

/// Anybody's mesh with half of a source's smile. The landmarks lie on the mesh and bear Mimik's names.
geometry::Mesh half_smiling(const geometry::Mesh& mesh, const geometry::Landmarks& landmarks,
                            const preprocessing::AverageFace& average, const preprocessing::Face& source_neutral,
                            const preprocessing::Face& source_smiling) {
    const auto& catalogue = facs::builtin_catalogue();
    const auto smile =
        modeling::measure_expression(catalogue, catalogue.expression("AU12"), average, source_neutral, source_smiling);
    const animation::WeightedExpression half[] = {{&smile, 0.5}};
    return animation::animate_mesh(mesh, landmarks, average, half);
}
// [end]

TEST(Samples, a_mesh_of_another_size_smiles_with_its_mouth_and_not_with_its_brows) {
    const auto average = test::analytic_average();
    const auto source = test::analytic_subject(average, 1.0, 6.0);
    const test::AnalyticFace face{1.05};
    const auto lines_x = test::AnalyticFace::lines(-60, 60, 2), lines_y = test::AnalyticFace::lines(-68, 76, 2);
    const auto scan = face.mesh(lines_x, lines_y);
    geometry::Mesh mesh;
    mesh.vertices_mm = scan.points_mm;
    mesh.faces = scan.faces;
    const auto smiling = half_smiling(mesh, face.landmarks(), average, source.neutral, source.smiling);
    double mouth_mm = 0, brows_mm = 0;
    for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v) {
        const double moved_mm = (smiling.vertices_mm[v] - mesh.vertices_mm[v]).norm();
        if (mesh.vertices_mm[v].y() < -20) mouth_mm = std::max(mouth_mm, moved_mm);
        if (mesh.vertices_mm[v].y() > 48) brows_mm = std::max(brows_mm, moved_mm);
    }
    EXPECT_GT(mouth_mm, 1.5);  // of 3.15 mm that half a smile moves the corners of this mouth
    EXPECT_LT(brows_mm, 0.1);
}
