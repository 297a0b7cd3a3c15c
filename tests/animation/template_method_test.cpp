#include "animation/template_method.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "animation/dense_field.h"
#include "animation/scaled_method.h"
#include "base/errors.h"
#include "preprocessing/kept_registrations.h"
#include "tests/animation/analytic_smile.h"

namespace mimik::animation {
namespace {

using geometry::DisplacementField;
using geometry::Vector;

/// Methods beside the default, whose template and motion they share: what they must make of it is known.
class TemplateMethods : public AnalyticSmile {
protected:
    static void SetUpTestSuite() {
        AnalyticSmile::SetUpTestSuite();
        registrations_ = new std::shared_ptr<const preprocessing::KeptRegistrations>(
            std::make_shared<const preprocessing::KeptRegistrations>(*average_));
    }
    static void TearDownTestSuite() {
        delete registrations_;
        AnalyticSmile::TearDownTestSuite();
    }
    static std::unique_ptr<const Transfer> learned(const std::string& method, std::size_t sources = 1) {
        static const auto smile = test::expression("12");
        modeling::Performance performance;
        performance.neutral = source_->neutral;
        performance.expressive = source_->smiling;
        const std::vector performances(sources, performance);
        const LearningTask task{smile, *average_, facs::builtin_catalogue(), *registrations_};
        return learn(*method_by_name(method), task, performances);
    }
    static DisplacementField field(const std::string& method, const preprocessing::Face& on, std::size_t sources = 1) {
        return field_on(*learned(method, sources), PreparedTarget(on));
    }
    /// The largest gap between one field times a factor and another.
    static double gap_mm(const DisplacementField& one, double times, const DisplacementField& other) {
        double largest = 0;
        for (std::size_t v = 0; v < one.size(); ++v)
            largest = std::max(largest, (times * one.mm[v] - other.mm[v]).norm());
        return largest;
    }
    static double largest_mm(const DisplacementField& field) {
        return gap_mm(field, 1.0, DisplacementField::still(field.size()));
    }
    static inline std::shared_ptr<const preprocessing::KeptRegistrations>* registrations_ = nullptr;
};

TEST_F(TemplateMethods, give_the_source_its_own_motion_back) {
    const auto own = field("default", source_->neutral);
    ASSERT_GT(largest_mm(own), 3);  // of the 6 mm of its mouth corners
    // Deformation transfer solves a system for what the others copy.
    EXPECT_LT(gap_mm(field("deformation-transfer", source_->neutral), 1, own), 1e-6);
    EXPECT_LT(gap_mm(field("expression-cloning", source_->neutral), 1, own), 1e-9);
    EXPECT_LT(gap_mm(field("displacement-copy", source_->neutral), 1, own), 1e-9);
}

TEST_F(TemplateMethods, a_copy_keeps_the_sources_millimetres_where_the_default_grows_with_the_face) {
    const auto scale = [](const preprocessing::Face& face) {
        return std::cbrt(face.average_from_scan.linear().determinant());
    };
    const double larger = scale(source_->neutral) / scale(target_->neutral);
    ASSERT_NEAR(larger, 1.1, 0.01);  // landmarks are marked on the grid
    EXPECT_LT(gap_mm(field("displacement-copy", target_->neutral), larger, field("default", target_->neutral)), 1e-9);
}

/// The target is the source, 1.1 times as large; its scan has other noise of the grid, so templates differ a little.
TEST_F(TemplateMethods, know_on_which_lip_a_vertex_lies_as_the_default_does) {
    const PreparedTarget target(source_->neutral);
    const auto by_default = learned("default")->lip_sides(target);
    EXPECT_THAT(by_default, testing::Contains(preprocessing::LipSide::upper));
    EXPECT_THAT(by_default, testing::Contains(preprocessing::LipSide::lower));
    for (const auto* method : {"deformation-transfer", "expression-cloning", "default-80-percent"})
        EXPECT_EQ(learned(method)->lip_sides(target), by_default) << method;
    EXPECT_TRUE(learned("sparse")->lip_sides(target).empty());
}

TEST_F(TemplateMethods, follow_the_size_of_the_face) {
    const auto smile = field("default", target_->neutral);
    for (const auto* name : {"deformation-transfer", "expression-cloning"})
        EXPECT_LT(gap_mm(field(name, target_->neutral), 1, smile), 0.2 * largest_mm(smile)) << name;
}

TEST_F(TemplateMethods, the_mean_of_equal_sources_is_the_one_source) {
    EXPECT_LT(gap_mm(field("deformation-transfer-mean", target_->neutral, 3), 1,
                     field("deformation-transfer", target_->neutral)),
              1e-9);
}

TEST_F(TemplateMethods, scaled_is_the_same_motion_times_the_magnitude) {
    EXPECT_LT(gap_mm(field("default", target_->neutral), 0.8, field("default-80-percent", target_->neutral)), 1e-12);
    EXPECT_THROW(ScaledMethod("none", method_by_name("default"), 0.0), InputError);
}

TEST_F(TemplateMethods, landmarks_alone_go_as_far_as_the_sources_did) {
    // A mesh with a vertex on each landmark.
    auto mesh = geometry::to_mesh(target_->neutral.grid);
    const auto first = mesh.vertices_mm.size();
    std::vector<std::uint32_t> fan;
    for (const auto& mark : target_->neutral.landmarks.all()) {
        fan.push_back(static_cast<std::uint32_t>(mesh.vertices_mm.size()));
        mesh.vertices_mm.push_back(mark.position_mm);
    }
    mesh.faces.add(fan);
    mesh.texture_coordinates.clear();
    mesh.attributes.clear();
    modeling::Performance performance;
    performance.neutral = source_->neutral;
    performance.expressive = source_->smiling;
    const auto smile = test::expression("12");
    const auto transfer =
        learn(*method_by_name("landmarks"), {smile, *average_, facs::builtin_catalogue()}, std::span(&performance, 1));
    const auto moved = animate_mesh(mesh, target_->neutral.landmarks, *average_, *transfer);
    const auto& rest = source_->neutral;
    const auto& there = source_->smiling;
    const Eigen::Matrix3d target_from_average =
        preprocessing::similarity_normalisation(target_->neutral.landmarks, average_->landmarks).linear().inverse();
    std::size_t v = first;
    for (const auto& mark : target_->neutral.landmarks.all()) {
        const Vector way = target_from_average * (there.average_from_scan * there.landmarks.position_mm(mark.name) -
                                                  rest.average_from_scan * rest.landmarks.position_mm(mark.name));
        EXPECT_LT((moved.vertices_mm[v] - mesh.vertices_mm[v] - way).norm(), 1e-6) << mark.name;  // an exact spline
        ++v;
    }
}

}  // namespace
}  // namespace mimik::animation
