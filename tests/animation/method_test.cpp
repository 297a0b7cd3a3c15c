#include "animation/method.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "animation/model_method.h"
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

TEST(ModelMethod, refuses_a_mean_of_points_that_stand_on_each_sources_own_face) {
    EXPECT_THROW(ModelMethod({.name = "thesis-mean",
                              .needs = SourceKind::all_but_target,
                              .model = modeling::ModelOptions::thesis(),
                              .animation = AnimationOptions::thesis()}),
                 InputError);
}

/// Answers on every second vertex alone, with numbers that are of no meaning elsewhere; or with too few.
struct Patchy : Transfer {
    explicit Patchy(bool whole_number) : whole(whole_number) {}
    [[nodiscard]] geometry::DisplacementField on(const PreparedTarget& target) const override {
        auto field = geometry::DisplacementField::still(target.surface().size());
        for (std::size_t v = 0; v < field.size(); ++v) {
            field.answered[v] = v % 2 == 0 ? 1 : 0;
            field.mm[v] = geometry::Vector::Constant(v % 2 == 0 ? 1.0 : std::nan(""));
        }
        if (!whole) field.mm.pop_back();
        return field;
    }
    bool whole;
};

TEST(Transfer, leaves_a_vertex_without_an_answer_where_it_is_and_is_refused_if_it_does_not_fit) {
    const auto average = test::analytic_average();
    const auto target = test::analytic_subject(average, 1.1, 6.0);
    const auto mesh = geometry::to_mesh(target.neutral.grid);
    const auto& landmarks = target.neutral.landmarks;
    const auto moved = animate_mesh(mesh, landmarks, average, Patchy(true));
    for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v)
        EXPECT_EQ(moved.vertices_mm[v],
                  mesh.vertices_mm[v] + geometry::Vector(geometry::Vector::Constant(v % 2 == 0 ? 1.0 : 0.0)));
    EXPECT_THROW((void)animate_mesh(mesh, landmarks, average, Patchy(false)), InputError);
    EXPECT_THROW((void)animate_mesh(mesh, landmarks, average, Patchy(true), -0.5), InputError);
    EXPECT_THROW((void)animate_mesh(mesh, landmarks, average, Patchy(true), std::nan("")), InputError);
}

/// What a target prepares is made once, whoever asks first: for the thread sanitizer.
TEST(PreparedTarget, may_be_asked_by_several_threads_at_once) {
    const auto average = test::analytic_average();
    const PreparedTarget target(test::analytic_subject(average, 1.1, 6.0).neutral);
    std::vector<const NormalisedTarget*> seen(8);
    std::vector<std::thread> threads;
    for (auto& slot : seen)
        threads.emplace_back([&] { slot = &target.normalised(modeling::Normalisation::similarity); });
    for (auto& thread : threads) thread.join();
    for (const auto* one : seen) EXPECT_EQ(one, seen.front());
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
        const auto name = method->name();
        if (name == "nothing") {
            EXPECT_EQ(largest_mm, 0);
        } else if (name == "default" || name == "mean" || name == "thesis") {
            EXPECT_GT(largest_mm, 3) << name;  // the source's mouth corners move by 6 mm
        }
    }
}

}  // namespace
}  // namespace mimik::animation
