#include "builtin/builtin_expressions.h"

#include <cstdint>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "preprocessing/face_template.h"

namespace mimik::builtin {
namespace {

using geometry::Vector;
using testing::HasSubstr;

const facs::FacsCatalogue& catalogue() { return facs::builtin_catalogue(); }

class BuiltinFaces : public testing::Test {
protected:
    static void SetUpTestSuite() {
        made_ = std::make_unique<const BuiltinExpressions>(BuiltinExpressionOptions{.people = 3});
    }
    static void TearDownTestSuite() { made_.reset(); }
    static modeling::ExpressionModel model(const char* name) {
        return made_->model(catalogue(), catalogue().expression(name));
    }
    /// Where the model takes a landmark of the template.
    static Vector motion_mm(const modeling::ExpressionModel& model, const std::string& landmark) {
        Vector sum = Vector::Zero();
        for (const auto& mark : model.dense->face_template().landmarks)
            if (mark.name == landmark)
                for (std::size_t c = 0; c < 3; ++c)
                    sum += mark.weights[static_cast<Eigen::Index>(c)] * model.dense->motion_mm[mark.corners[c]];
        return sum;
    }
    static Vector mean_mm(const modeling::ExpressionModel& model, const std::vector<std::uint32_t>& vertices) {
        Vector sum = Vector::Zero();
        for (const auto v : vertices) sum += model.dense->motion_mm[v] / static_cast<double>(vertices.size());
        return sum;
    }
    static std::unique_ptr<const BuiltinExpressions> made_;
};
std::unique_ptr<const BuiltinExpressions> BuiltinFaces::made_;

TEST_F(BuiltinFaces, a_jaw_that_drops_takes_the_lower_lip_along_and_leaves_the_upper_one) {
    const auto drop = model("27");
    const auto& face_template = drop.dense->face_template();
    // The jaw of AU 27 opens a mouth by 20 to 40 mm; of the line both ends, the corners, belong to both lips.
    const auto lower = mean_mm(drop, face_template.lower_lip_line), upper = mean_mm(drop, face_template.upper_lip_line);
    EXPECT_LT(lower.y(), -10);
    EXPECT_GT(upper.y(), 0.25 * lower.y());
    EXPECT_GT(motion_mm(drop, "nose_tip").y(), -0.5);  // held by the skull
}

TEST_F(BuiltinFaces, a_smile_lifts_both_corners_alike_and_a_one_sided_one_only_its_own) {
    const auto both = model("12"), left = model("12L");
    const auto on_left = motion_mm(both, "mouth_corner_left"), on_right = motion_mm(both, "mouth_corner_right");
    EXPECT_GT(on_left.y(), 2);  // zygomaticus major: up, back and outwards
    EXPECT_GT(on_left.x(), 0);
    // People are not quite symmetric: a tenth of the motion.
    EXPECT_LT((on_left - Vector(-on_right.x(), on_right.y(), on_right.z())).norm(), 0.1 * on_left.norm());
    EXPECT_GT(motion_mm(left, "mouth_corner_left").norm(), 0.8 * on_left.norm());
    EXPECT_LT(motion_mm(left, "mouth_corner_right").norm(), 0.3 * on_left.norm());
    EXPECT_LT(motion_mm(both, "eye_inner_left").norm(), 0.5);
}

TEST_F(BuiltinFaces, models_of_points_follow_the_same_motion) {
    modeling::ModelOptions points;
    points.correspondence = modeling::Correspondence::sparse;
    const auto smile = catalogue().expression("12");
    EXPECT_FALSE(made_->model(catalogue(), smile, points).dense);
    EXPECT_GT(made_->model(catalogue(), smile, points).largest_displacement_mm(), 3);
}

TEST_F(BuiltinFaces, what_nobody_shows_is_refused_with_what_there_is) {
    const auto word = facs::parse_expression("sneer");
    ASSERT_TRUE(word);
    EXPECT_FALSE(made_->shows(*word));
    EXPECT_TRUE(made_->shows(catalogue().expression("HAPPY")));
    try {
        (void)made_->model(catalogue(), *word);
        FAIL() << "no error";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("SNEER"));
        EXPECT_THAT(e.what(), HasSubstr("12"));
    }
    modeling::ModelOptions on_a_source;
    on_a_source.place_on_average = false;
    EXPECT_THROW((void)made_->model(catalogue(), catalogue().expression("12"), on_a_source), InputError);
}

TEST(BuiltinExpressionOptions, a_mean_needs_two_people) { EXPECT_THROW(BuiltinExpressions({.people = 1}), InputError); }

TEST(BuiltinFacesOnThreads, numbers_are_the_same_on_any_number_of_threads) {
    std::vector<std::vector<Vector>> motions;
    for (const int threads : {1, 2}) {
        base::set_thread_count(threads);
        const BuiltinExpressions made({.people = 2});
        motions.push_back(made.model(catalogue(), catalogue().expression("4")).dense->motion_mm);
    }
    base::set_thread_count(0);
    EXPECT_EQ(motions[0], motions[1]);
}

}  // namespace
}  // namespace mimik::builtin
