#include "animation/lid_field.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "facs/facs_catalogue.h"
#include "tests/support/analytic_workspace.h"
#include "tests/support/lidded_face.h"

namespace mimik::animation {
namespace {

using geometry::DisplacementField;
using geometry::Point;
using geometry::Vector;
using test::LiddedFace;

const preprocessing::AverageFace& average() {
    static const auto made = test::analytic_average();
    return made;
}

facs::Expression expression(const char* text) { return *facs::parse_expression(text); }

/// The field of an expression whose model says that nothing moves.
DisplacementField lids_alone(const PreparedTarget& target, const char* text) {
    auto field = DisplacementField::still(target.surface().size());
    slide_lids(target, expression(text), field);
    return field;
}

/// Vertices of the border of a margin of one side, in the middle 80 % of the eye.
std::vector<std::size_t> rim(const geometry::FaceSurface& face, double side, bool upper) {
    std::vector<std::uint8_t> used(face.size(), 0);
    for (const auto& t : face.triangles)
        for (const auto v : t) used[v] = 1;
    std::vector<std::size_t> found;
    for (std::size_t v = 0; v < face.size(); ++v) {
        const auto& p = face.vertices_mm[v];
        if (!used[v] || p.x() * side < 0 || p.z() < LiddedFace::centre().z() ||
            std::abs(std::abs(p.x()) - LiddedFace::middle_x) > 0.8 * LiddedFace::half_width_mm)
            continue;
        const double off_mm = upper ? p.y() - LiddedFace::margins_y(p.x())[1] : LiddedFace::margins_y(p.x())[0] - p.y();
        if (off_mm >= 0 && off_mm < LiddedFace::step_mm) found.push_back(v);
    }
    return found;
}

/// The share of the upper margin's vertices that end so near to the lower lid's, beside half a step along it.
double closed_share(const geometry::FaceSurface& face, const DisplacementField& field, double side,
                    double within_mm = 0.5) {
    const auto upper = rim(face, side, true), lower = rim(face, side, false);
    double closed = 0;
    for (const auto v : upper) {
        double gap = 1e9;
        for (const auto w : lower)
            gap = std::min(gap, (face.vertices_mm[v] + field.mm[v] - face.vertices_mm[w] - field.mm[w]).norm());
        closed += gap < std::hypot(within_mm, LiddedFace::step_mm / 2) ? 1.0 : 0.0;
    }
    return closed / static_cast<double>(upper.size());
}

class LidsOf : public testing::TestWithParam<LiddedFace::Eyes> {};

TEST_P(LidsOf, closed_eyes_meet) {
    const auto face = LiddedFace{GetParam()}.surface();
    const PreparedTarget target(face, average());
    const auto still = DisplacementField::still(face.size());
    for (const double side : {1.0, -1.0}) {
        EXPECT_LT(closed_share(face, still, side), 0.1);
        // Where lids and eyeball are one surface, the margins are known to a step and a half of its lattice, and not in
        // the corners, where the lids hardly stand off the eyeball.
        const bool one_surface = GetParam() == LiddedFace::Eyes::surface;
        EXPECT_GT(closed_share(face, lids_alone(target, "43"), side, one_surface ? 1.5 * LiddedFace::step_mm : 0.5),
                  one_surface ? 0.7 : 0.9);
    }
}

TEST_P(LidsOf, closing_eyes_stay_out_of_eyeballs_at_every_magnitude_and_leave_them_still) {
    const auto face = LiddedFace{GetParam()}.surface();
    const PreparedTarget target(face, average());
    const auto& margins = lid_margins(target);
    const auto sheets = lid_sheets(target);
    for (const double magnitude : {0.5, 1.0}) {
        auto field = lids_alone(target, "43");
        for (auto& mm : field.mm) mm *= magnitude;
        keep_lids_off_eyeballs(target, field.mm);
        for (std::size_t v = 0; v < face.size(); ++v) {
            if (!face.present[v]) continue;
            if (sheets[v] == LidSheet::eyeball) {
                EXPECT_EQ(field.mm[v].norm(), 0.0);
            }
            for (const auto* eye : {&margins.left, &margins.right}) {
                // Nearly the identity: the face has the landmarks of the average one.
                const auto& to_average = target.average_from_target(modeling::Normalisation::similarity);
                const double before = (to_average * face.vertices_mm[v] - eye->centre_mm).norm();
                const double after = (to_average * (face.vertices_mm[v] + field.mm[v]) - eye->centre_mm).norm();
                EXPECT_GT(after, std::min(before, eye->radius_mm) - 1e-6);
            }
        }
    }
}

TEST_P(LidsOf, one_closed_eye_leaves_the_other_side_alone) {
    const auto face = LiddedFace{GetParam()}.surface();
    const PreparedTarget target(face, average());
    for (const char* wink : {"43L", "46L"}) {
        const auto field = lids_alone(target, wink);
        double left = 0, right = 0;
        for (std::size_t v = 0; v < face.size(); ++v)
            if (face.present[v]) {
                auto& most = face.vertices_mm[v].x() > 0 ? left : right;
                most = std::max(most, field.mm[v].norm());
            }
        EXPECT_GT(left, 7.0) << wink;  // of an opening of 10 mm
        EXPECT_EQ(right, 0.0) << wink;
    }
}

INSTANTIATE_TEST_SUITE_P(EveryKind, LidsOf,
                         testing::Values(LiddedFace::Eyes::hole, LiddedFace::Eyes::ball, LiddedFace::Eyes::surface));

TEST(Lids, do_not_fold_the_skin) {
    const auto face = LiddedFace{}.surface();
    const PreparedTarget target(face, average());
    for (const char* text : {"43", "5", "7", "42"}) {
        const auto field = lids_alone(target, text);
        std::size_t turned = 0, moving = 0;
        for (const auto& t : face.triangles) {
            moving += field.mm[t[0]].norm() > 0.1 ? 1U : 0U;
            const auto normal = [&](double share) -> Vector {
                const auto at = [&](std::uint32_t v) -> Point { return face.vertices_mm[v] + share * field.mm[v]; };
                return (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
            };
            turned += normal(0).dot(normal(1)) < 0 ? 1U : 0U;
        }
        // The steps of the lattice at the margins, where the opening is cut out of it.
        EXPECT_LT(static_cast<double>(turned), 0.02 * static_cast<double>(moving)) << text << ", of " << moving;
    }
}

TEST(Lids, a_raised_upper_lid_opens_the_eye_and_a_tightened_one_narrows_it_from_below) {
    const auto face = LiddedFace{}.surface();
    const PreparedTarget target(face, average());
    const auto mean_rise_mm = [&](const char* text, bool upper) {
        const auto field = lids_alone(target, text);
        double sum = 0;
        const auto vertices = rim(face, 1.0, upper);
        for (const auto v : vertices) sum += field.mm[v].y();
        return sum / static_cast<double>(vertices.size());
    };
    EXPECT_GT(mean_rise_mm("5", true), 1.0);
    EXPECT_LT(std::abs(mean_rise_mm("5", false)), 0.5);
    EXPECT_GT(mean_rise_mm("7", false), 1.0);
    EXPECT_GT(mean_rise_mm("7", false), -mean_rise_mm("7", true));
}

TEST(Lids, that_are_not_found_leave_the_motion_of_the_model_and_say_why) {
    const auto face = LiddedFace{LiddedFace::Eyes::none}.surface();
    const PreparedTarget target(face, average(), "somebody");
    auto field = DisplacementField::still(face.size());
    for (auto& mm : field.mm) mm = Vector(0, 1, 0);
    std::vector<std::string> remarks;
    slide_lids(target, expression("43"), field, &remarks);
    for (const auto& mm : field.mm) EXPECT_EQ(mm, Vector(0, 1, 0));
    ASSERT_EQ(remarks.size(), 2U);
    EXPECT_NE(remarks.front().find("left eye of somebody"), std::string::npos) << remarks.front();
    EXPECT_FALSE(lids_slide(target, expression("43")));
}

TEST(Lids, expressions_of_other_parts_do_not_touch_them) {
    const PreparedTarget target(LiddedFace{}.surface(), average());
    const auto field = lids_alone(target, "12");
    EXPECT_TRUE(std::all_of(field.mm.begin(), field.mm.end(), [](const Vector& mm) { return mm.norm() == 0; }));
    EXPECT_FALSE(lids_slide(target, expression("12")));
}

TEST(Lids, a_face_between_lid_and_eyeball_is_torn_where_they_part) {
    const std::vector<LidSheet> sheets = {LidSheet::upper, LidSheet::eyeball, LidSheet::neither};
    const std::vector<Vector> closing = {Vector(0, -8, 0), Vector(0, 0, 0), Vector(0, -5, 0)};
    const std::vector<Vector> hardly = {Vector(0, -1, 0), Vector(0, 0, 0), Vector(0, -5, 0)};
    EXPECT_TRUE(torn_lids(sheets, closing, std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_FALSE(torn_lids(sheets, hardly, std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_FALSE(torn_lids(sheets, closing, std::vector<std::uint32_t>{0, 2}));
    EXPECT_FALSE(torn_lids({}, closing, std::vector<std::uint32_t>{0, 1}));
}

}  // namespace
}  // namespace mimik::animation
