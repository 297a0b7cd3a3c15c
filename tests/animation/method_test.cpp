#include "animation/method.h"

#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "animation/sparse_method.h"
#include "base/errors.h"
#include "tests/support/analytic_workspace.h"
#include "tests/support/expressions.h"

namespace mimik::animation {
namespace {

TEST(Methods, have_names_of_their_own_that_can_be_typed) {
    std::set<std::string> names;
    for (const auto& method : known_methods()) {
        const auto name = method->name();
        EXPECT_TRUE(names.insert(name).second) << name;
        EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"), std::string::npos) << name;
        EXPECT_EQ(method_by_name(name)->name(), name);
    }
    EXPECT_THAT(names,
                testing::IsSupersetOf({"nothing", "thesis", "default", "mean", "true-field", "true-field-mean"}));
}

TEST(SparseMethod, refuses_a_mean_of_points_that_stand_on_each_sources_own_face) {
    EXPECT_THROW(SparseMethod({.name = "thesis-mean",
                               .needs = SourceKind::all_but_target,
                               .model = modeling::ModelOptions::thesis(),
                               .animation = AnimationOptions::thesis()}),
                 InputError);
}

/// Every method that needs no truth, learned from one smile and put on a mesh that is no grid.
TEST(Methods, put_an_expression_on_anybodys_mesh_by_one_call) {
    const auto average = test::analytic_average();
    const auto source = test::analytic_subject(average, 1.0, 6.0), target = test::analytic_subject(average, 1.1, 6.0);
    modeling::Performance performance;
    performance.neutral = source.neutral;
    performance.expressive = source.smiling;
    const std::vector performances = {performance};
    const auto smile = test::expression("12");
    // Triangles, a vertex that no face uses, and every third face gone.
    const auto whole = geometry::to_mesh(target.neutral.grid);
    geometry::Mesh mesh;
    mesh.vertices_mm = whole.vertices_mm;
    std::size_t kept = 0;
    for (const auto& triangle : geometry::triangulate(whole.faces))
        if (++kept % 3 != 0) mesh.faces.add(triangle);
    mesh.vertices_mm.emplace_back(geometry::Point::Constant(std::nan("")));
    for (const auto& method : known_methods()) {
        if (method->needs_truth()) continue;
        const auto transfer = learn(*method, {smile, average, facs::builtin_catalogue()}, performances);
        const auto once = animate_mesh(mesh, target.neutral.landmarks, average, *transfer);
        const auto half = animate_mesh(mesh, target.neutral.landmarks, average, *transfer, 0.5);
        double largest_mm = 0, worst_mm = 0;
        for (std::size_t v = 0; v + 1 < mesh.vertices_mm.size(); ++v) {
            const geometry::Vector way = once.vertices_mm[v] - mesh.vertices_mm[v];
            largest_mm = std::max(largest_mm, way.norm());
            worst_mm = std::max(worst_mm, (2 * (half.vertices_mm[v] - mesh.vertices_mm[v]) - way).norm());
        }
        EXPECT_LT(worst_mm, 1e-9) << method->name();  // rounding
        if (method->name() == "nothing")
            EXPECT_EQ(largest_mm, 0);
        else
            EXPECT_GT(largest_mm, 3) << method->name();  // the source's mouth corners move by 6 mm
    }
}

}  // namespace
}  // namespace mimik::animation
