#include "capture/label_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/capture/curved_sheet.h"
#include "tests/support/thrown.h"

namespace mimik::capture {
namespace {

using geometry::Landmarks;
using geometry::Point;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Landmarks first_of(const Landmarks& marks, std::size_t count) {
    return Landmarks({marks.all().begin(), marks.all().begin() + static_cast<std::ptrdiff_t>(count)});
}

TEST(LabelFit, on_an_affine_image_of_the_reference_every_label_is_where_it_belongs) {
    const test::CurvedSheet sheet;
    geometry::Transform there = geometry::Transform::Identity();
    there.linear() = Eigen::Vector3d(1.1, 0.95, 1.05).asDiagonal();
    there.translation() = geometry::Vector(12, -30, 7);
    auto moved = sheet.vertices_mm;
    for (auto& p : moved) p = there * p;
    const geometry::SurfaceIndex target(moved, sheet.triangles);
    const auto truth = geometry::transformed(sheet.labels, there);
    const auto start = start_labels(sheet.index(), sheet.labels, target, geometry::transformed(sheet.points(), there));
    EXPECT_THAT(start.remarks, IsEmpty());
    const auto fitted = fit_labels(start, sheet.labels, target, builtin_marker_set(), SurfaceMinimiser::levenberg);
    ASSERT_EQ(fitted.labels.size(), 76U);
    EXPECT_EQ(fitted.corners.size(), 76U);
    // An affine motion is the map's own; what is left is rounding, and of the ray that meets the surface.
    EXPECT_LT(fitted.found.end.total, 1e-5);
    for (const auto& label : fitted.labels.all())
        EXPECT_LT((label.position_mm - truth.position_mm(label.name)).norm(), 1e-3) << label.name;
}

TEST(LabelFit, points_placed_by_hand_stay_and_labels_end_on_the_surface) {
    const test::CurvedSheet sheet;
    auto bent = sheet.vertices_mm;
    for (auto& p : bent) p += Point(0.04 * p.y(), 0, 0.002 * p.x() * p.x() - 0.001 * p.y() * p.y());
    const geometry::SurfaceIndex target(bent, sheet.triangles);
    std::vector<geometry::Landmark> list;
    const auto points = sheet.points();
    for (const auto& point : points.all())
        list.push_back({point.name, target.closest(point.position_mm).position_mm, ""});
    const Landmarks by_hand(list);
    LabelFitOptions options;
    const auto start = start_labels(sheet.index(), sheet.labels, target, by_hand, options);
    const auto fitted =
        fit_labels(start, sheet.labels, target, builtin_marker_set(), SurfaceMinimiser::levenberg, options);
    EXPECT_LE(fitted.found.end.total, fitted.found.start.total);
    for (const auto& label : fitted.labels.all()) {
        EXPECT_LT(target.closest(label.position_mm).distance_mm, 1e-6) << label.name;
        if (const auto* point = by_hand.find(label.name)) {
            EXPECT_LT((label.position_mm - point->position_mm).norm(), 1e-6) << label.name;
        }
    }
}

TEST(LabelFit, points_that_say_no_map_are_named_with_their_mend) {
    const test::CurvedSheet sheet;
    const auto skin = sheet.index();
    const auto refusal = [&](const Landmarks& points) {
        return test::message_of([&] { (void)start_labels(skin, sheet.labels, skin, points); });
    };
    EXPECT_THAT(refusal(first_of(sheet.points(), 3)),
                AllOf(HasSubstr("3 points are placed by hand"), HasSubstr("4 are the least")));
    EXPECT_THAT(refusal(Landmarks(std::vector<geometry::Landmark>{{"nose", {0, 0, 0}, ""}})),
                AllOf(HasSubstr("no label 'nose'"), HasSubstr("nose_tip")));
    const auto points = sheet.points();
    std::vector<geometry::Landmark> off(points.all().begin(), points.all().end());
    off[5].position_mm.z() += 30;
    EXPECT_THAT(refusal(Landmarks(off)), AllOf(HasSubstr("1 point lies off the target (of 12)"),
                                               HasSubstr("'nose_tip'"), HasSubstr("5 is the most")));
    const geometry::Transform far(Eigen::Translation3d(0, 0, 500));
    EXPECT_THAT(test::message_of(
                    [&] { (void)start_labels(skin, geometry::transformed(sheet.labels, far), skin, sheet.points()); }),
                HasSubstr("76 points lie off the reference (of 76)"));
    const auto few = start_labels(skin, sheet.labels, skin, first_of(sheet.points(), 6));
    EXPECT_THAT(few.remarks, ElementsAre(HasSubstr("6 points are placed by hand; 10 to 12")));
}

TEST(LabelFit, a_mesh_of_another_unit_or_turned_inside_out_is_refused_by_name) {
    const test::CurvedSheet sheet;
    auto larger = sheet.vertices_mm;
    for (auto& p : larger) p *= 2.54;
    geometry::Transform scaled = geometry::Transform::Identity();
    scaled.linear() *= 2.54;
    EXPECT_THAT(test::message_of<InputError>([&] {
                    (void)start_labels(sheet.index(), sheet.labels, {larger, sheet.triangles},
                                       geometry::transformed(sheet.points(), scaled));
                }),
                AllOf(HasSubstr("2.54 times as far apart"), HasSubstr("unit")));
    auto turned = sheet.triangles;
    for (auto& t : turned) std::swap(t[1], t[2]);
    EXPECT_THAT(test::message_of<InputError>([&] {
                    (void)start_labels(sheet.index(), sheet.labels, {sheet.vertices_mm, turned}, sheet.points());
                }),
                AllOf(HasSubstr("the target is turned inside out"), HasSubstr("76 of 76")));
    EXPECT_THAT(test::message_of<InputError>([&] {
                    (void)start_labels({sheet.vertices_mm, turned}, sheet.labels, sheet.index(), sheet.points());
                }),
                HasSubstr("the reference is turned inside out"));
}

TEST(LabelFit, labels_that_are_no_corners_go_where_the_start_puts_them) {
    const test::CurvedSheet sheet;
    const auto skin = sheet.index();
    std::vector<geometry::Landmark> list(sheet.labels.all().begin(), sheet.labels.all().end());
    const Point mole = skin.closest(Point(20, 10, 0)).position_mm;
    list.push_back({"mole", mole, ""});
    const Landmarks labels(list);
    const auto start = start_labels(skin, labels, skin, sheet.points());
    const auto fitted = fit_labels(start, labels, skin, builtin_marker_set(), SurfaceMinimiser::levenberg);
    EXPECT_EQ(fitted.corners.size(), 76U);
    EXPECT_LT((fitted.labels.position_mm("mole") - mole).norm(), 1e-3);
}

}  // namespace
}  // namespace mimik::capture
