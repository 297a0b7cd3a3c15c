#include "capture/stick_markers.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "facs/reference_face.h"

namespace mimik::capture {
namespace {

using geometry::Point;

/// Skin 4 mm before a marker's place: a sheet with a ridge along the midline whose sides are steep, as those of a nose.
struct Ridge {
    static constexpr double before_mm = 4;
    geometry::Landmarks places = place_markers(builtin_marker_set(), facs::reference_landmarks());
    std::vector<Point> vertices_mm;
    std::vector<geometry::Triangle> triangles;

    explicit Ridge(const char* name = "nose_root") {
        const double depth = places.position_mm(name).z();
        add_sheet(-120, 120, [&](double x) { return depth + before_mm - 2.5 * std::abs(x); });
    }
    template <class Depth>
    void add_sheet(double left, double right, const Depth& depth) {
        const auto first = static_cast<std::uint32_t>(vertices_mm.size());
        constexpr std::uint32_t columns = 121;
        for (const double y : {-200.0, 200.0})
            for (std::uint32_t k = 0; k < columns; ++k) {
                const double x = left + (right - left) * k / (columns - 1);
                vertices_mm.emplace_back(x, y, depth(x));
            }
        for (std::uint32_t k = first; k + 1 < first + columns; ++k) {
            triangles.push_back({k, k + 1, k + columns});
            triangles.push_back({k + 1, k + columns + 1, k + columns});
        }
    }
    [[nodiscard]] geometry::Landmarks stuck() const {
        const geometry::SurfaceIndex skin(vertices_mm, triangles);
        return stick_markers(builtin_marker_set(), facs::reference_landmarks(), skin).landmarks();
    }
};

TEST(StickMarkers, markers_between_landmarks_of_the_midline_stay_on_it) {
    for (const char* name : {"nose_root", "nose_bridge"}) {
        const Ridge ridge(name);
        const auto there = ridge.places.position_mm(name), label = ridge.stuck().position_mm(name);
        EXPECT_NEAR(label.x(), there.x(), 1e-9) << name;
        EXPECT_NEAR(label.y(), there.y(), 1e-9) << name;
        EXPECT_NEAR(label.z(), there.z() + Ridge::before_mm, 1e-9) << name;
    }
}

TEST(StickMarkers, markers_of_lids_before_an_eyeball_are_on_the_margin_of_the_skin) {
    // Skin of 1 mm cells with a hole before the left eye, whose upper margin is 2 mm above the place of the marker.
    const auto lid = place_markers(builtin_marker_set(), facs::reference_landmarks()).position_mm("upper_lid_left");
    constexpr std::uint32_t columns = 201, rows = 301;
    std::vector<Point> vertices_mm;
    std::vector<geometry::Triangle> triangles;
    for (std::uint32_t row = 0; row < rows; ++row)
        for (std::uint32_t column = 0; column < columns; ++column)
            vertices_mm.emplace_back(lid.x() - 100 + column, lid.y() + 2 - 150 + row, lid.z() + 3);
    for (std::uint32_t row = 0; row + 1 < rows; ++row)
        for (std::uint32_t column = 0; column + 1 < columns; ++column) {
            if (column >= 90 && column < 110 && row >= 138 && row < 150) continue;
            const auto v = row * columns + column;
            triangles.push_back({v, v + 1, v + columns + 1});
            triangles.push_back({v, v + columns + 1, v + columns});
        }
    const auto ball = static_cast<std::uint32_t>(vertices_mm.size());
    for (const double y : {-20.0, 20.0})
        for (const double x : {-20.0, 20.0}) vertices_mm.emplace_back(lid.x() + x, lid.y() + y, lid.z() + 0.5);
    triangles.push_back({ball, ball + 1, ball + 3});
    triangles.push_back({ball, ball + 3, ball + 2});
    const geometry::SurfaceIndex surface(vertices_mm, triangles);
    const auto stuck = stick_markers(builtin_marker_set(), facs::reference_landmarks(), surface);
    const auto label = stuck.landmarks().position_mm("upper_lid_left");
    EXPECT_NEAR(label.x(), lid.x(), 1e-9);
    EXPECT_NEAR(label.y(), lid.y() + 2, 1e-9);
    EXPECT_NEAR(label.z(), lid.z() + 3, 1e-9);
    // The place is said by the triangle, too: who follows it as the skin moves is not led to the eyeball.
    const auto k = static_cast<std::size_t>(std::find(stuck.names.begin(), stuck.names.end(), "upper_lid_left") -
                                            stuck.names.begin());
    for (const auto corner : triangles[stuck.places[k].triangle]) EXPECT_LT(corner, ball);
}

TEST(StickMarkers, where_nothing_is_seen_from_the_front_the_nearest_point_is_taken) {
    Ridge far;
    far.vertices_mm.clear();
    far.triangles.clear();
    far.add_sheet(-120, 120, [](double) { return -300.0; });
    EXPECT_NEAR(far.stuck().position_mm("nose_root").z(), -300, 1e-9);
}

TEST(StickMarkers, names_are_those_of_the_set_in_its_order_and_then_the_derived_ones) {
    const Ridge ridge;
    const geometry::SurfaceIndex skin(ridge.vertices_mm, ridge.triangles);
    const auto stuck = stick_markers(builtin_marker_set(), facs::reference_landmarks(), skin);
    ASSERT_EQ(stuck.names.size(), 76U);
    EXPECT_EQ(stuck.names.front(), builtin_marker_set().markers.front().name);
    EXPECT_EQ(stuck.names.back(), builtin_marker_set().derived.back().name);
}

}  // namespace
}  // namespace mimik::capture
