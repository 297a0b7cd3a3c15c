#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/landmarks.h"
#include "synthesis/builtin_measurements.h"
#include "synthesis/builtin_sheet.h"
#include "synthesis/face_model.h"

namespace mimik::synthesis {
namespace {

using geometry::Point;
using geometry::Vector;

const FaceModel& model() {
    static const auto built = make_builtin_face_model();
    return *built;
}

const Sheet& sheet() {
    static const Sheet made = make_sheet();
    return made;
}

Identity mean_face(Sex sex) { return model().draw_identity(1, sex, 0); }

Point at(const std::vector<Point>& face, const std::string& landmark) {
    return face[model().landmark_vertices().at(landmark)];
}

TEST(BuiltinFace, has_the_22_standard_landmarks_where_anatomy_puts_them) {
    ASSERT_EQ(model().landmark_vertices().size(), geometry::standard_landmark_names().size());
    const auto face = model().neutral_mm(mean_face(Sex::female));
    for (const auto name : geometry::standard_landmark_names())
        ASSERT_TRUE(model().landmark_vertices().contains(std::string(name))) << name;
    EXPECT_GT(at(face, "eye_outer_left").x(), at(face, "eye_inner_left").x());
    EXPECT_LT(at(face, "eye_outer_right").x(), at(face, "eye_inner_right").x());
    EXPECT_GT(at(face, "brow_middle_left").y(), at(face, "eye_inner_left").y() + 10);
    EXPECT_GT(at(face, "upper_lip_outer").y(), at(face, "upper_lip_inner").y() + 3);
    EXPECT_LT(at(face, "lower_lip_outer").y(), at(face, "lower_lip_inner").y() - 3);
    EXPECT_LT(at(face, "chin").y(), at(face, "lower_lip_outer").y() - 10);
    for (const auto& p : face) EXPECT_LE(p.z(), at(face, "nose_tip").z() + 0.5);
}

TEST(BuiltinFace, the_neutral_face_is_its_own_mirror_image) {
    const auto face = model().neutral_mm(model().draw_identity(5, Sex::male, 1));
    double worst = 0;
    for (std::size_t i = 0; i < face.size(); ++i) {
        const Point& other = face[sheet().mirror[i]];
        worst = std::max(worst, (face[i] - Point(-other.x(), other.y(), other.z())).norm());
    }
    EXPECT_LT(worst, 1e-9);  // the same arithmetic on |s| on both sides
}

TEST(BuiltinFace, one_seed_is_one_face_and_another_seed_is_another) {
    const auto a = model().neutral_mm(model().draw_identity(7, Sex::female, 1));
    const auto b = model().neutral_mm(model().draw_identity(7, Sex::female, 1));
    const auto c = model().neutral_mm(model().draw_identity(8, Sex::female, 1));
    EXPECT_EQ(a, b);
    double apart = 0;
    for (std::size_t i = 0; i < a.size(); ++i) apart += (a[i] - c[i]).norm() / static_cast<double>(a.size());
    EXPECT_GT(apart, 1.0);  // two strangers differ by millimetres
}

TEST(BuiltinFace, a_left_shape_is_the_mirror_image_of_the_right_one) {
    const auto id = mean_face(Sex::male);
    const auto left = model().shape_displacement_mm(id, "mouthSmile_L");
    const auto right = model().shape_displacement_mm(id, "mouthSmile_R");
    for (std::size_t i = 0; i < left.size(); ++i) {
        const Vector& r = right[sheet().mirror[i]];
        ASSERT_LT((left[i] - Vector(-r.x(), r.y(), r.z())).norm(), 1e-12);
    }
    EXPECT_GT(left[model().landmark_vertices().at("mouth_corner_left")].x(), 4);
}

TEST(BuiltinFace, no_shape_moves_the_rim_of_the_sheet) {
    const auto id = mean_face(Sex::female);
    for (const auto& name : model().shapes()) {
        const auto moved = model().shape_displacement_mm(id, name);
        for (std::size_t i = 0; i < moved.size(); ++i) {
            const auto& p = sheet().vertices[i];
            const bool rim = std::abs(p.s) == place::rim || p.v == place::top || p.v == place::bottom;
            ASSERT_TRUE(!rim || moved[i].norm() == 0) << name;
        }
    }
}

TEST(BuiltinFace, a_shape_it_does_not_have_is_refused_by_name) {
    try {
        (void)model().shape_displacement_mm(mean_face(Sex::female), "mouthSmile");
        FAIL() << "accepted";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::HasSubstr("'mouthSmile'"));
        EXPECT_THAT(e.what(), testing::HasSubstr("mouthSmile_L"));
    }
}

TEST(BuiltinFace, an_identity_of_another_model_is_refused_with_both_counts) {
    auto id = mean_face(Sex::female);
    id.coefficients.resize(3);
    try {
        (void)model().neutral_mm(id);
        FAIL() << "accepted";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::HasSubstr("has 3 coefficients"));
    }
}

}  // namespace
}  // namespace mimik::synthesis
