#include <gtest/gtest.h>

#include "tests/support/analytic_workspace_files.h"
#include "tests/support/temporary_folder.h"

// [sample]
#include "animation/animate.h"
#include "animation/method.h"
#include "evaluation/performance.h"
#include "io/landmark_io.h"
#include "io/mesh_io.h"
#include "modeling/source_expression.h"
#include "preprocessing/workspace.h"

using namespace mimik;

/// Half of a subject's smile on anybody's mesh. `work` is what `mimik preprocess` made; the landmarks lie on the mesh
/// and bear Mimik's names.
void half_smile(const std::filesystem::path& work, const std::string& subject, const std::filesystem::path& mesh,
                const std::filesystem::path& landmarks, const std::filesystem::path& out) {
    const preprocessing::Workspace workspace(work);
    const auto& catalogue = facs::builtin_catalogue();
    const auto smile =
        modeling::model_from_workspace(workspace, catalogue, catalogue.expression("AU12"), {subject, {}});
    const animation::WeightedExpression half[] = {{&smile, 0.5}};
    io::write_mesh(
        out, animation::animate_mesh(io::read_mesh(mesh), io::read_landmarks(landmarks), workspace.average(), half));
}

/// The same by any method, learned from every subject who smiles.
geometry::Mesh smile_by(const animation::Method& method, const preprocessing::Workspace& workspace,
                        const geometry::Mesh& mesh, const geometry::Landmarks& landmarks) {
    const auto& catalogue = facs::builtin_catalogue();
    const auto smile = catalogue.expression("AU12");
    const evaluation::PerformanceReader reader(workspace);
    std::vector<modeling::Performance> performances;
    for (const auto& subject : workspace.shown_subjects())
        if (const auto scan = workspace.scan_of(subject, smile)) performances.push_back(reader.read(*scan));
    const auto transfer = animation::learn(method, {smile, workspace.average(), catalogue}, performances);
    return animation::animate_mesh(mesh, landmarks, workspace.average(), *transfer, 0.5);
}
// [end]

TEST(Samples, a_mesh_of_another_size_smiles_with_its_mouth_and_not_with_its_brows) {
    const test::TemporaryFolder folder;
    const auto workspace = test::analytic_workspace(folder.path());
    const test::AnalyticFace face{1.05};
    const auto lines_x = test::AnalyticFace::lines(-60, 60, 2), lines_y = test::AnalyticFace::lines(-68, 76, 2);
    const auto scan = face.mesh(lines_x, lines_y);
    geometry::Mesh mesh;
    mesh.vertices_mm = scan.points_mm;
    mesh.faces = scan.faces;
    const auto file = [&](const char* name) { return folder.path() / name; };
    io::write_mesh(file("mine.ply"), mesh);
    io::write_landmarks(file("mine.csv"), face.landmarks());
    half_smile(workspace.root(), "bs000", file("mine.ply"), file("mine.csv"), file("smiling.ply"));
    const auto mean = animation::method_by_name("mean");
    for (const auto& smiling :
         {io::read_mesh(file("smiling.ply")), smile_by(*mean, workspace, mesh, face.landmarks())}) {
        double mouth_mm = 0, brows_mm = 0;
        for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v) {
            const double moved_mm = (smiling.vertices_mm[v] - mesh.vertices_mm[v]).norm();
            if (mesh.vertices_mm[v].y() < -20) mouth_mm = std::max(mouth_mm, moved_mm);
            if (mesh.vertices_mm[v].y() > 48) brows_mm = std::max(brows_mm, moved_mm);
        }
        EXPECT_GT(mouth_mm, 1.5);  // half a smile moves the corners of this mouth by 3 mm
        EXPECT_LT(brows_mm, 0.2);
    }
}
