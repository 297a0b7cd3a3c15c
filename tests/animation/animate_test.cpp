#include "animation/animate.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "animation/face_export.h"
#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "geometry/face_axes.h"
#include "io/image.h"
#include "io/mesh_io.h"
#include "tests/animation/analytic_smile.h"
#include "tests/database/temporary_folder.h"
#include "tests/support/analytic_workspace.h"
#include "tests/support/dense_spline.h"
#include "tests/support/expressions.h"
#include "tests/support/glb_faults.h"

namespace mimik::animation {
namespace {

using geometry::Point;
using geometry::Vector;
using modeling::ExpressionModel;
using testing::HasSubstr;

class Animate : public AnalyticSmile {};

TEST_F(Animate, the_average_face_is_called_so) {
    auto average = target_->neutral;
    average.id = {};
    EXPECT_EQ(PreparedTarget(average).name(), "the average face");
    EXPECT_EQ(PreparedTarget(target_->neutral).name(), target_->neutral.id.name());
}

TEST_F(Animate, at_magnitude_zero_is_the_neutral_face) {
    const auto model = smile();
    const PreparedTarget target(target_->neutral);
    const WeightedExpression nothing{&model, 0.0};
    const auto animated = animate(target, std::span(&nothing, 1));
    EXPECT_EQ(animated.extent.largest_displacement_mm, 0);
}

TEST_F(Animate, moves_a_face_of_other_size_most_of_the_way_to_its_own_smile) {
    const auto model = smile();
    const PreparedTarget target(target_->neutral);
    const WeightedExpression weighted{&model, 1.0};
    const auto animated = animate(target, std::span(&weighted, 1));
    AnimatedFace still;
    still.field = geometry::DisplacementField::still(target_->neutral.grid.size());
    const double nothing_mm = smile_error_mm(still, target_->neutral, 1.1, 6.0);
    const double animated_mm = smile_error_mm(animated, target_->neutral, 1.1, 6.0);
    EXPECT_GT(nothing_mm, 2.0);
    // Projection sees motion across the surface only where there is relief, so the tangential part is a guess of the
    // landmark spline: some of it stays wrong even for a target of the source's own shape.
    EXPECT_LT(animated_mm, 0.5 * nothing_mm);
}

TEST_F(Animate, lower_face_units_leave_the_brows_alone) {
    const auto model = smile();
    const PreparedTarget target(target_->neutral);
    const WeightedExpression weighted{&model, 1.0};
    const auto animated = animate(target, std::span(&weighted, 1));
    const double brow_y = target_->neutral.landmarks.position_mm("brow_middle_left").y();
    for (std::size_t v = 0; v < target_->neutral.grid.size(); ++v)
        if (target_->neutral.grid.inside(v) && target_->neutral.grid.vertices_mm[v].y() > brow_y) {
            ASSERT_EQ(animated.field.mm[v].norm(), 0) << v;
        }
}

TEST_F(Animate, one_side_of_a_unit_moves_that_side_only) {
    const auto model = smile({}, "12L");
    const PreparedTarget target(target_->neutral);
    const WeightedExpression weighted{&model, 1.0};
    const auto animated = animate(target, std::span(&weighted, 1));
    const auto& grid = target_->neutral.grid;
    const Point left = target_->neutral.landmarks.position_mm("mouth_corner_left");
    const Point right = target_->neutral.landmarks.position_mm("mouth_corner_right");
    double at_left = 0, at_right = 0;
    for (std::size_t v = 0; v < grid.size(); ++v) {
        if (!grid.measured(v)) continue;
        if ((grid.vertices_mm[v] - left).norm() < 3) at_left = std::max(at_left, animated.field.mm[v].norm());
        if ((grid.vertices_mm[v] - right).norm() < 3) at_right = std::max(at_right, animated.field.mm[v].norm());
    }
    EXPECT_GT(at_left, 3.0);
    EXPECT_LT(at_right, 0.1 * at_left);
}

TEST_F(Animate, the_same_unit_twice_doubles_as_a_sum_and_does_not_in_parallel) {
    const auto model = smile();
    const PreparedTarget target(target_->neutral);
    const WeightedExpression once{&model, 1.0};
    const std::array twice = {once, once};
    const auto single = animate(target, std::span(&once, 1));
    const auto sum = animate(target, twice);
    AnimationOptions options;
    options.combination = Combination::parallel;
    const auto parallel = animate(target, twice, options);
    EXPECT_NEAR(sum.extent.largest_displacement_mm, 2 * single.extent.largest_displacement_mm, 1e-9);
    EXPECT_NEAR(parallel.extent.largest_displacement_mm, single.extent.largest_displacement_mm, 1e-9);
}

TEST_F(Animate, beyond_magnitude_one_a_remark_says_so) {
    const auto model = smile();
    const PreparedTarget target(target_->neutral);
    const WeightedExpression strong{&model, 1.5};
    EXPECT_THAT(animate(target, std::span(&strong, 1)).remarks, testing::Contains(HasSubstr("exaggerates")));
}

/// The similarity that brings a target to the average face.
const geometry::Transform& to_average(const PreparedTarget& target) {
    return target.average_from_target(modeling::Normalisation::similarity);
}

/// Nothing was measured between the lips in so much of the mouth's width.
preprocessing::Face with_gap(preprocessing::Face face, double share) {
    const Point left = face.landmarks.position_mm("mouth_corner_left"),
                right = face.landmarks.position_mm("mouth_corner_right"),
                seam = face.landmarks.position_mm("upper_lip_inner");
    for (std::size_t v = 0; v < face.grid.size(); ++v) {
        const auto& p = face.grid.vertices_mm[v];
        if (std::abs(p.x() - (left.x() + right.x()) / 2) < share / 2 * std::abs(left.x() - right.x()) &&
            std::abs(p.y() - seam.y()) < 1)
            face.grid.origin[v] = geometry::VertexOrigin::bridged;
    }
    return face;
}

TEST_F(Animate, who_opens_a_closed_mouth_is_told_that_it_stays_one_piece) {
    // As AU 27 does: all below the seam of the lips goes down, all above it stays.
    auto opening = smile();
    opening.expression = test::expression("27");
    const double seam_y =
        (opening.landmarks.position_mm("upper_lip_inner").y() + opening.landmarks.position_mm("lower_lip_inner").y()) /
        2;
    for (auto& point : opening.points) point.displacement_mm = {0, point.position_mm.y() < seam_y ? -10.0 : 0.0, 0};
    auto moved_as_one = opening;
    for (auto& point : moved_as_one.points) point.displacement_mm.y() = -10;
    EXPECT_EQ(lip_parting_mm(opening), 10);
    EXPECT_EQ(lip_parting_mm(moved_as_one), 0);
    EXPECT_LT(lip_parting_mm(smile()), 0.5);  // both lips go with the corners

    const auto told = [](const ExpressionModel& model, double magnitude, const preprocessing::Face& neutral) {
        const PreparedTarget target(neutral);
        const WeightedExpression weighted{&model, magnitude};
        std::size_t remarks = 0;
        for (const auto& remark : animate(target, std::span(&weighted, 1)).remarks)
            remarks +=
                remark.starts_with("AU27 pulls the lips apart, but those of " + neutral.id.name() + " are closed");
        return remarks;
    };
    const auto &closed = target_->neutral, open = with_gap(closed, 0.6);
    const auto closed_lips = [](const preprocessing::Face& face) {
        return lips_closed(geometry::face_surface(face.grid, face.landmarks));
    };
    EXPECT_EQ(closed_lips(closed), true);
    EXPECT_EQ(closed_lips(with_gap(closed, 0.2)), true);  // 0.2 of the 0.5 that are looked at: less than half
    EXPECT_EQ(closed_lips(with_gap(closed, 0.3)), false);
    EXPECT_EQ(closed_lips(open), false);
    auto no_grid = geometry::face_surface(closed.grid, closed.landmarks);
    no_grid.grid.reset();
    EXPECT_EQ(lips_closed(no_grid), std::nullopt);
    EXPECT_EQ(told(opening, 1.0, closed), 1U);
    EXPECT_EQ(told(opening, 0.1, closed), 0U);  // a millimetre
    EXPECT_EQ(told(opening, 1.0, open), 0U);
    EXPECT_EQ(told(moved_as_one, 1.0, closed), 0U);
}

TEST_F(Animate, anybodys_mesh_moves_as_the_scan_of_the_same_surface_does_and_keeps_its_faces_and_texture) {
    const auto model = smile();
    const auto& neutral = target_->neutral;
    const PreparedTarget target(neutral);
    const WeightedExpression weighted{&model, 1.0};
    const auto animated = animate(target, std::span(&weighted, 1));

    std::vector<std::uint32_t> kept;
    auto mesh = geometry::to_mesh(neutral.grid, geometry::BridgedVertices::keep, &kept);
    mesh.texture_coordinates.assign(mesh.vertices_mm.size(), {0.25, 0.75});
    const auto moved = animate_mesh(mesh, neutral.landmarks, *average_, std::span(&weighted, 1));
    ASSERT_EQ(moved.vertices_mm.size(), mesh.vertices_mm.size());
    EXPECT_EQ(moved.faces.corners, mesh.faces.corners);
    EXPECT_EQ(moved.texture_coordinates, mesh.texture_coordinates);
    double most_mm = 0;
    for (std::size_t k = 0; k < kept.size(); ++k)
        most_mm = std::max(most_mm, (moved.vertices_mm[k] - mesh.vertices_mm[k] - animated.field.mm[kept[k]]).norm());
    EXPECT_GT(animated.extent.largest_displacement_mm, 4);
    EXPECT_LT(most_mm, 1e-6);  // rounding: the same splines on the same surface
}

TEST_F(Animate, a_landmark_without_a_partner_is_told_and_left_out) {
    auto neutral = target_->neutral;
    std::vector<geometry::Landmark> marks(neutral.landmarks.all().begin(), neutral.landmarks.all().end());
    std::erase_if(marks, [](const auto& mark) { return mark.name == "brow_inner_left"; });
    marks.push_back({"ear_lobe_left", marks.front().position_mm + Vector(40, 0, -60), ""});
    neutral.landmarks = geometry::Landmarks(marks);
    const auto model = smile();
    const WeightedExpression weighted{&model, 1.0};
    const auto animated = animate(PreparedTarget(neutral), std::span(&weighted, 1));
    EXPECT_THAT(animated.remarks, testing::Contains(HasSubstr("landmark 'brow_inner_left' of the model is not on")));
    EXPECT_THAT(animated.remarks, testing::Contains(HasSubstr("'ear_lobe_left' of bs000_N_N_0 is not in the model")));
}

TEST_F(Animate, the_thesis_warp_equals_a_direct_dense_solve_of_its_system) {
    const auto options = AnimationOptions::thesis();
    const auto model = smile(modeling::ModelOptions::thesis());
    const PreparedTarget target(target_->neutral);
    std::vector<CarriedPoint> points;
    const auto field = expression_field(target, model, options, &points);
    const auto& normalised = target.normalised(modeling::Normalisation::affine);
    const auto& to_affine = normalised.average_from_target;

    std::vector<Point> from, to;
    for (const auto& point : points) {
        from.emplace_back(to_affine * point.position_mm);
        to.emplace_back(from.back() + to_affine.linear() * point.displacement_mm);
    }
    const test::DenseSpline dense(from, to);
    double worst = 0;
    std::size_t compared = 0;
    for (std::size_t v = 0; v < field.size(); v += 17) {
        if (field.mm[v].norm() == 0) continue;
        const Point& x = normalised.vertices_mm[v];
        worst = std::max(worst, (dense(x) - x - to_affine.linear() * field.mm[v]).norm());
        ++compared;
    }
    EXPECT_GT(compared, 100U);
    // The issue is solving, not rounding: 1e-9 mm is far above the error of a well-posed solve in double and far below
    // anything a scanner sees.
    EXPECT_LT(worst, 1e-9);
}

TEST_F(Animate, exports_leave_out_what_is_no_measured_surface_and_keep_the_displacement) {
    const auto model = smile();
    auto neutral = target_->neutral;
    // A vertex whose four neighbours in the rows and columns were not measured: no quad can use it.
    auto& grid = neutral.grid;
    std::uint32_t lone = 0;
    for (int row = 2; row + 2 < grid.rows && lone == 0; ++row)
        for (int col = 2; col + 2 < grid.cols && lone == 0; ++col)
            if (grid.measured(grid.index(row, col)) && grid.measured(grid.index(row + 1, col + 1)) &&
                grid.measured(grid.index(row - 1, col - 1)))
                lone = grid.index(row, col);
    ASSERT_NE(lone, 0U);
    const auto cols = static_cast<std::uint32_t>(grid.cols);
    for (const auto v : {lone - 1, lone + 1, lone - cols, lone + cols})
        grid.origin[v] = geometry::VertexOrigin::bridged;
    const PreparedTarget target(neutral);
    const WeightedExpression weighted{&model, 1.0};
    const auto animated = animate(target, std::span(&weighted, 1));
    const auto mesh = to_mesh(animated, neutral);
    std::vector<char> used(mesh.vertices_mm.size(), 0);
    for (const auto corner : mesh.faces.corners) used[corner] = 1;
    EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0);
    std::set<std::uint32_t> in_quads;
    for (const auto corner : geometry::quads(grid, geometry::BridgedVertices::leave_out).corners)
        in_quads.insert(corner);
    EXPECT_FALSE(in_quads.contains(lone));
    EXPECT_EQ(mesh.vertices_mm.size(), in_quads.size());
    ASSERT_EQ(mesh.attributes.size(), 2U);
    EXPECT_EQ(mesh.attributes[0].name, "displacement_mm");
    EXPECT_EQ(mesh.attributes[0].values.size(), 3 * in_quads.size());
    EXPECT_THROW(write_animated_face("face.stl", animated, neutral, {}, {}), InputError);
}

TEST_F(Animate, lengths_are_those_of_the_frame_that_they_are_asked_in) {
    const auto model = smile();
    const PreparedTarget target(target_->neutral);
    const WeightedExpression weighted{&model, 1.0};
    const auto animated = animate(target, std::span(&weighted, 1));
    // A similarity: every length is its scale times that of the scanner's frame.
    const Eigen::Matrix3d turn = to_average(target).linear();
    const double scale = std::cbrt(turn.determinant());
    ASSERT_GT(std::abs(scale - 1), 0.01);
    const auto average = geometry::field_extent(target.surface(), animated.field.mm, turn);
    EXPECT_GT(animated.extent.largest_displacement_mm, 4);
    EXPECT_NEAR(average.largest_displacement_mm, scale * animated.extent.largest_displacement_mm, 1e-9);  // rounding
    EXPECT_NEAR(average.largest_neighbour_step_mm, scale * animated.extent.largest_neighbour_step_mm, 1e-9);
}

TEST_F(Animate, what_is_too_large_for_a_number_is_refused_with_the_name_of_the_expression) {
    const auto model = smile();
    const PreparedTarget target(target_->neutral);
    const auto refused = [&](const ExpressionModel& one, double magnitude) {
        const WeightedExpression weighted{&one, magnitude};
        return database::message_of<NumericalError>([&] { (void)animate(target, std::span(&weighted, 1)); });
    };
    EXPECT_THAT(refused(model, 1e300), HasSubstr("AU12 at magnitude 1e+300"));
    auto huge = model;
    huge.points.front().displacement_mm.x() = 1e300;
    EXPECT_THAT(refused(huge, 1), HasSubstr("AU12"));
}

TEST_F(Animate, the_thesis_landmark_splines_equal_a_direct_dense_solve_too) {
    const auto model = smile(modeling::ModelOptions::thesis());
    // Eq. 5.5, neutral to expressive: the model keeps how far from its nearest vertex each control was carried.
    const auto& neutral = source_->neutral;
    const auto& smiling = source_->smiling;
    const auto expressive_from_neutral =
        test::DenseSpline::between(geometry::transformed(neutral.snapped_landmarks, neutral.average_from_scan_affine),
                                   geometry::transformed(smiling.snapped_landmarks, smiling.average_from_scan_affine));
    ASSERT_GT(model.points.size(), 5U);
    for (const auto& point : model.points) {
        const Point found = point.position_mm + point.displacement_mm;
        EXPECT_NEAR((found - expressive_from_neutral(point.position_mm)).norm(), point.projection_mm, 1e-9)
            << point.name;  // as for the warp
    }
    // Eq. 5.7, model to target.
    const PreparedTarget target(target_->neutral);
    std::vector<CarriedPoint> carried;
    (void)expression_field(target, model, AnimationOptions::thesis(), &carried);
    ASSERT_EQ(carried.size(), model.points.size());
    const auto target_from_model = test::DenseSpline::between(
        model.landmarks,
        geometry::transformed(target_->neutral.snapped_landmarks, target_->neutral.average_from_scan_affine));
    for (std::size_t k = 0; k < carried.size(); ++k) {
        const Point on_face = target.average_from_target(modeling::Normalisation::affine) * carried[k].position_mm;
        EXPECT_NEAR((on_face - target_from_model(model.points[k].position_mm)).norm(), carried[k].projection_mm, 1e-9)
            << carried[k].name;
    }
}

TEST_F(Animate, in_the_thesis_way_landmarks_and_carried_points_are_vertices) {
    const PreparedTarget target(target_->neutral);
    const auto& normalised = target.normalised(modeling::Normalisation::affine);
    for (const auto& mark : target_->neutral.snapped_landmarks.all())
        EXPECT_EQ(normalised.snapped_landmarks.position_mm(mark.name),
                  normalised.average_from_target * mark.position_mm);
    EXPECT_EQ(normalised.landmarks.position_mm("chin"),
              normalised.average_from_target * target_->neutral.landmarks.position_mm("chin"));

    std::vector<CarriedPoint> points;
    (void)expression_field(target, smile(modeling::ModelOptions::thesis()), AnimationOptions::thesis(), &points);
    ASSERT_FALSE(points.empty());
    const auto& grid = target_->neutral.grid;
    for (const auto& point : points) {
        double nearest_mm = 1e9;
        for (std::size_t v = 0; v < grid.size(); ++v)
            if (grid.inside(v)) nearest_mm = std::min(nearest_mm, (grid.vertices_mm[v] - point.position_mm).norm());
        EXPECT_LT(nearest_mm, 1e-9) << point.name;  // rounding: to the average frame and back
    }
}

TEST_F(Animate, lower_face_units_alone_scale_with_the_width_of_the_mouth) {
    auto model = smile();
    const PreparedTarget target(target_->neutral);
    model.mouth_width_mm =
        geometry::mouth_width_mm(target.normalised(modeling::Normalisation::similarity).landmarks) / 1.3;
    const auto ratio_is = [&](double expected) {
        std::vector<CarriedPoint> points;
        (void)expression_field(target, model, {}, &points);
        std::size_t compared = 0;
        for (const auto& point : points)
            for (const auto& own : model.points)
                if (own.name == point.name && own.kind == facs::ControlKind::muscle) {
                    const Vector moved = to_average(target).linear() * point.displacement_mm;
                    EXPECT_LT((moved - expected * own.displacement_mm).norm(), 1e-9) << point.name;  // rounding
                    ++compared;
                }
        EXPECT_GT(compared, 0U);
    };
    ratio_is(1.3);  // Eq. 5.8
    model.moves_upper_face = true;
    ratio_is(1.0);
}

TEST_F(Animate, a_unit_fades_over_the_border_of_its_region) {
    auto model = smile();
    // Something to see at the border: the same large push everywhere.
    for (auto& point : model.points) point.displacement_mm = {0, 3, 1};
    const PreparedTarget target(target_->neutral);
    AnimationOptions options;
    options.mouth_ratio = false;
    const auto faded = expression_field(target, model, options);
    model.moves_upper_face = true;
    const auto whole = expression_field(target, model, options);
    // A quarter of the way from the eyes to the nose tip; the head turns about y alone, so up is y.
    const auto& marks = target_->neutral.landmarks;
    const double eyes = 0.25 * (marks.position_mm("eye_outer_left") + marks.position_mm("eye_outer_right") +
                                marks.position_mm("eye_inner_left") + marks.position_mm("eye_inner_right"))
                                   .y();
    const double border = eyes + 0.25 * (marks.position_mm("nose_tip").y() - eyes);
    double at_3_mm_below = 0, at_3_mm_above = 0;
    int below = 0, above = 0;
    const auto& grid = target_->neutral.grid;
    for (std::size_t v = 0; v < grid.size(); ++v) {
        if (!grid.measured(v) || whole.mm[v].norm() < 1) continue;
        const double height_mm = grid.vertices_mm[v].y() - border;
        const double share = faded.mm[v].norm() / whole.mm[v].norm();
        if (std::abs(height_mm + 3) < 1) at_3_mm_below += share, ++below;
        if (std::abs(height_mm - 3) < 1) at_3_mm_above += share, ++above;
    }
    ASSERT_GT(below, 20);
    ASSERT_GT(above, 20);
    // t = 0.5 +- 3 / 12: t^2 (3 - 2 t) = 0.844 and 0.156. "Up" leans with the chin by a few degrees.
    EXPECT_NEAR(at_3_mm_below / below, 0.844, 0.1);
    EXPECT_NEAR(at_3_mm_above / above, 0.156, 0.1);
}

TEST_F(Animate, a_vertex_keeps_as_much_of_its_displacement_as_it_is_given) {
    const auto model = smile();
    const PreparedTarget target(target_->neutral);
    const auto whole = expression_field(target, model, {});
    AnimationOptions options;
    options.keep.assign(whole.size(), 0.25);
    const auto held = expression_field(target, model, options);
    for (std::size_t v = 0; v < whole.size(); ++v)
        ASSERT_LT((held.mm[v] - 0.25 * whole.mm[v]).norm(), 1e-12) << v;  // rounding
    options.keep.pop_back();
    EXPECT_THROW((void)expression_field(target, model, options), InputError);
}

TEST_F(Animate, points_are_merged_where_they_fall_together_and_only_there) {
    auto model = smile();
    auto point = model.points.front();
    std::vector<modeling::ModelPoint> points{point};
    point.name = "three_millimetres_off";
    point.position_mm.x() += 3;
    points.push_back(point);
    point.name = "on_top";
    point.position_mm.x() -= 2.9;
    points.push_back(point);
    for (const auto& anchor : model.points)
        if (anchor.kind == facs::ControlKind::anchor) points.push_back(anchor);
    model.points = points;
    const PreparedTarget target(target_->neutral);
    std::vector<CarriedPoint> carried;
    std::vector<std::string> remarks;
    (void)expression_field(target, model, {}, &carried, &remarks);
    std::vector<std::string> names;
    for (const auto& one : carried) names.push_back(one.name);
    EXPECT_THAT(names, testing::Contains("three_millimetres_off"));
    EXPECT_THAT(names, testing::Not(testing::Contains("on_top")));
    EXPECT_THAT(remarks, testing::Contains(HasSubstr("'on_top' falls on")));
}

TEST_F(Animate, in_the_average_frame_positions_and_displacements_turn_alike) {
    const auto model = smile();
    const PreparedTarget target(target_->neutral);
    const WeightedExpression weighted{&model, 1.0};
    const auto animated = animate(target, std::span(&weighted, 1));
    const auto mesh = to_mesh(animated, target_->neutral, {.average_from_scan = to_average(target)});
    const auto& moved = mesh.attributes.front();
    ASSERT_EQ(moved.name, "displacement_mm");
    std::size_t k = 0;
    std::set<std::uint32_t> in_quads;
    for (const auto v : geometry::quads(target_->neutral.grid, geometry::BridgedVertices::leave_out).corners)
        in_quads.insert(v);
    for (const auto v : in_quads) {
        const Vector turned = to_average(target).linear() * animated.field.mm[v];
        const Vector written(moved.values[3 * k], moved.values[3 * k + 1], moved.values[3 * k + 2]);
        ASSERT_LT((written - turned).norm(), 1e-9) << v;  // rounding
        ASSERT_LT(
            (mesh.vertices_mm[k] - to_average(target) * (target_->neutral.grid.vertices_mm[v] + animated.field.mm[v]))
                .norm(),
            1e-9)
            << v;
        ++k;
    }
    EXPECT_EQ(k, mesh.vertices_mm.size());
}

/// What a viewer reads of a GLB: its description, and the floats of an accessor.
struct ReadGlb {
    explicit ReadGlb(const std::filesystem::path& file) : bytes(base::read_bytes(file)) {
        std::uint32_t length = 0;
        std::memcpy(&length, bytes.data() + 12, 4);
        json = nlohmann::json::parse(bytes.begin() + 20, bytes.begin() + 20 + length);
        binary = 20 + length + 8;
    }
    [[nodiscard]] std::vector<float> floats(std::size_t accessor) const {
        const auto& view = json["bufferViews"][json["accessors"][accessor]["bufferView"].get<std::size_t>()];
        std::vector<float> values(view["byteLength"].get<std::size_t>() / 4);
        std::memcpy(values.data(), bytes.data() + binary + view["byteOffset"].get<std::size_t>(), 4 * values.size());
        return values;
    }
    /// The largest length of a morph target's displacements.
    [[nodiscard]] double largest_mm(std::size_t morph) const {
        const auto values = floats(json["meshes"][0]["primitives"][0]["targets"][morph]["POSITION"].get<std::size_t>());
        double largest = 0;
        for (std::size_t k = 0; k + 2 < values.size(); k += 3)
            largest = std::max(largest, 1000.0 * std::hypot(values[k], values[k + 1], values[k + 2]));
        return largest;
    }
    std::vector<std::uint8_t> bytes;
    std::size_t binary = 0;
    nlohmann::json json;
};

TEST_F(Animate, every_format_says_of_each_vertex_how_it_moved_and_what_was_measured) {
    const auto model = smile();
    auto neutral = target_->neutral;
    auto& grid = neutral.grid;
    const Point mouth = neutral.landmarks.position_mm("mouth_corner_left");
    for (std::size_t v = 0; v < grid.size(); ++v)
        if (grid.measured(v) && (grid.vertices_mm[v] - mouth).norm() < 5)
            grid.origin[v] = geometry::VertexOrigin::bridged;
    const PreparedTarget target(neutral);
    const WeightedExpression weighted{&model, 0.5};
    const auto animated = animate(target, std::span(&weighted, 1));
    const std::vector<NamedMagnitude> names = {{"AU12", 0.5, "mouthSmile"}};
    const database::TemporaryFolder folder;
    for (const auto bridged : {geometry::BridgedVertices::keep, geometry::BridgedVertices::leave_out}) {
        const ExportOptions options{.average_from_scan = to_average(target), .bridged = bridged};
        const auto mesh = to_mesh(animated, neutral, options);
        const auto& moved = mesh.attributes.at(0).values;
        const auto& origin = mesh.attributes.at(1).values;
        ASSERT_EQ(mesh.attributes[1].name, "origin");
        ASSERT_EQ(std::count(origin.begin(), origin.end(), 2.0) > 0, bridged == geometry::BridgedVertices::keep);

        const auto obj = folder.path() / "face.obj", table = folder.path() / "face_vertices.csv";
        EXPECT_EQ(vertex_values_file(obj), table);
        EXPECT_THAT(write_animated_face(obj, animated, neutral, names, {}, options),
                    testing::ElementsAre(HasSubstr(table.string())));
        const auto text = base::read_text(table);
        base::CsvReader rows(text, table.string());
        EXPECT_EQ(io::read_mesh(obj).vertices_mm.size(), mesh.vertices_mm.size());
        const std::array columns = {rows.column("displacement_mm_x"), rows.column("displacement_mm_y"),
                                    rows.column("displacement_mm_z")};
        for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v) {
            ASSERT_TRUE(rows.next()) << v;
            ASSERT_EQ(rows.number(rows.column("vertex")), static_cast<double>(v + 1));
            ASSERT_EQ(rows.number(rows.column("origin")), origin[v]);
            for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(rows.number(columns[c]), moved[3 * v + c]);
        }
        EXPECT_FALSE(rows.next());

        EXPECT_TRUE(write_animated_face(folder.path() / "face.glb", animated, neutral, names, {}, options).empty());
        const ReadGlb glb(folder.path() / "face.glb");
        EXPECT_THAT(test::glb_faults(glb.bytes), testing::IsEmpty());
        const auto& attributes = glb.json["meshes"][0]["primitives"][0]["attributes"];
        const auto origins = glb.floats(attributes["_ORIGIN"].get<std::size_t>());
        const auto displacements = glb.floats(attributes["_DISPLACEMENT_MM"].get<std::size_t>());
        EXPECT_EQ(origins, std::vector<float>(origin.begin(), origin.end()));
        EXPECT_EQ(displacements, std::vector<float>(moved.begin(), moved.end()));
    }
    for (const char* file : {"face.ply", "face.vtp", "face.glb"}) EXPECT_TRUE(vertex_values_file(file).empty());
}

double largest_mm(const preprocessing::Face& neutral, const std::vector<Vector>& field) {
    double largest = 0;
    for (std::size_t v = 0; v < field.size(); ++v)
        if (neutral.grid.measured(v)) largest = std::max(largest, field[v].norm());
    return largest;
}

TEST_F(Animate, morph_targets_hold_the_fields_at_magnitude_one_with_the_name_that_arkit_has) {
    const database::TemporaryFolder folder;
    const auto file = folder.path() / "face.glb";
    const auto left = smile({}, "12L"), both = smile();
    const PreparedTarget target(target_->neutral);
    const std::array expressions = {WeightedExpression{&left, 0.5}, WeightedExpression{&both, 0.25}};
    const auto animated = animate(target, expressions);
    std::vector<NamedMagnitude> names = {{"AU12_L", 0.5, "mouthSmileLeft"}, {"AU12", 0.25, ""}};
    EXPECT_TRUE(write_animated_face(file, animated, target_->neutral, names, {}).empty());
    const ReadGlb glb(file);
    EXPECT_THAT(test::glb_faults(glb.bytes), testing::IsEmpty());
    const auto& mesh = glb.json["meshes"][0];
    EXPECT_EQ(mesh["extras"]["targetNames"], nlohmann::json({"AU12_L", "AU12"}));
    EXPECT_EQ(mesh["extras"]["arkitNames"], nlohmann::json({"mouthSmileLeft", ""}));
    EXPECT_EQ(mesh["weights"], nlohmann::json({0.5, 0.25}));
    for (std::size_t k = 0; k < 2; ++k)
        EXPECT_NEAR(glb.largest_mm(k), largest_mm(target_->neutral, animated.shapes[k].mm), 1e-5);  // 32-bit floats
    // Not turned round either: the left corner of the mouth goes to the subject's left.
    const auto values = glb.floats(mesh["primitives"][0]["targets"][0]["POSITION"].get<std::size_t>());
    double sum_x = 0, sum_field_x = 0;
    for (std::size_t k = 0; k < values.size(); k += 3) sum_x += 1000.0 * static_cast<double>(values[k]);
    for (std::size_t v = 0; v < target_->neutral.grid.size(); ++v)
        if (target_->neutral.grid.measured(v)) sum_field_x += animated.shapes[0].mm[v].x();
    EXPECT_GT(sum_x * sum_field_x, 0);
    names[1].name = "AU12_L";
    EXPECT_THAT(database::message_of<InputError>(
                    [&] { (void)write_animated_face(file, animated, target_->neutral, names, {}); }),
                HasSubstr("two morph targets would be called AU12_L"));
}

TEST_F(Animate, a_parallel_resultant_is_one_morph_target_and_a_remark_says_so) {
    const database::TemporaryFolder folder;
    const auto file = folder.path() / "face.glb";
    const auto left = smile({}, "12L"), both = smile();
    const PreparedTarget target(target_->neutral);
    const std::array expressions = {WeightedExpression{&left, 1.0}, WeightedExpression{&both, 1.0}};
    AnimationOptions options;
    options.combination = Combination::parallel;
    const auto animated = animate(target, expressions, options);
    const std::vector<NamedMagnitude> names = {{"AU12_L", 1.0, "mouthSmileLeft"}, {"AU12", 1.0, ""}};
    EXPECT_THAT(write_animated_face(file, animated, target_->neutral, names, {}),
                testing::ElementsAre(HasSubstr("one, AU12_L+AU12")));
    const ReadGlb glb(file);
    EXPECT_THAT(test::glb_faults(glb.bytes), testing::IsEmpty());
    EXPECT_EQ(glb.json["meshes"][0]["extras"]["targetNames"], nlohmann::json({"AU12_L+AU12"}));
    EXPECT_EQ(glb.json["meshes"][0]["weights"], nlohmann::json({1.0}));
    EXPECT_NEAR(glb.largest_mm(0), largest_mm(target_->neutral, animated.field.mm), 1e-5);  // 32-bit floats
}

TEST_F(Animate, a_picture_beside_the_face_is_not_overwritten_by_its_texture) {
    const database::TemporaryFolder folder;
    base::write_atomically(folder.path() / "face.png", "picture");
    io::write_png(folder.path() / "scan.png", {1, 1, {10, 20, 30}});
    const auto model = smile();
    const PreparedTarget target(target_->neutral);
    const WeightedExpression weighted{&model, 1.0};
    const auto animated = animate(target, std::span(&weighted, 1));
    write_animated_face(folder.path() / "face.ply", animated, target_->neutral, {}, folder.path() / "scan.png");
    EXPECT_EQ(base::read_text(folder.path() / "face.png"), "picture");
    EXPECT_EQ(base::read_text(folder.path() / "face_texture.png"), base::read_text(folder.path() / "scan.png"));
    EXPECT_THAT(base::read_text(folder.path() / "face.ply").substr(0, 400), HasSubstr("face_texture.png"));
}

TEST_F(Animate, a_texture_that_is_no_picture_is_not_handed_on) {
    const database::TemporaryFolder folder;
    base::write_atomically(folder.path() / "key.png", "a text that is nobody's business");
    const auto model = smile();
    const PreparedTarget target(target_->neutral);
    const WeightedExpression weighted{&model, 1.0};
    const auto animated = animate(target, std::span(&weighted, 1));
    const std::vector<NamedMagnitude> names = {{"AU12", 1.0, ""}};
    for (const char* file : {"face.ply", "face.glb"}) {
        const auto remarks =
            write_animated_face(folder.path() / file, animated, target_->neutral, names, folder.path() / "key.png");
        if (std::string(file) == "face.ply") {  // a GLB asks for no picture where there are no texture positions
            EXPECT_THAT(remarks, testing::Contains(HasSubstr("key.png: is neither a PNG, a JPEG nor a BMP image")));
        }
        EXPECT_EQ(base::read_text(folder.path() / file).find("nobody's business"), std::string::npos) << file;
    }
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "face_texture.png"));
}

TEST(AnimationOptions, defaults_and_the_thesis_are_valid_and_negative_smoothing_is_not) {
    EXPECT_NO_THROW(AnimationOptions{}.check());
    EXPECT_NO_THROW(AnimationOptions::thesis().check());
    AnimationOptions options;
    options.smoothing = -1;
    EXPECT_THROW(options.check(), InputError);
}

}  // namespace
}  // namespace mimik::animation
