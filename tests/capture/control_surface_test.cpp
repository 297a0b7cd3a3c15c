#include "capture/control_surface.h"

#include <algorithm>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "facs/reference_face.h"
#include "tests/support/thrown.h"

namespace mimik::capture {
namespace {

using test::message_of;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> all_names() {
    std::vector<std::string> names;
    for (const auto& marker : builtin_marker_set().markers) names.push_back(marker.name);
    for (const auto& marker : builtin_marker_set().derived) names.push_back(marker.name);
    return names;
}

TEST(ControlSurface, every_marker_is_a_corner_and_left_and_right_are_mirror_images) {
    const auto surface = control_surface(builtin_marker_set(), all_names());
    EXPECT_THAT(surface.left_out, IsEmpty());
    std::set<std::uint32_t> corners;
    std::multiset<std::set<std::string>> triangles, mirrored;
    for (const auto& t : surface.triangles) {
        std::set<std::string> names, other;
        for (const auto c : t) {
            corners.insert(c);
            auto name = surface.corners[c];
            names.insert(name);
            if (name.ends_with("_left"))
                name.replace(name.size() - 4, 4, "right");
            else if (name.ends_with("_right"))
                name.replace(name.size() - 5, 5, "left");
            other.insert(name);
        }
        triangles.insert(names);
        mirrored.insert(other);
    }
    EXPECT_EQ(corners.size(), 76U);
    EXPECT_EQ(triangles, mirrored);
}

TEST(ControlSurface, no_triangle_has_corners_on_both_sides_of_an_opening) {
    // By the names, not by the openings that the set states.
    for (const auto& t : builtin_marker_set().triangles) {
        const auto has = [&](const char* part) {
            return std::any_of(t.begin(), t.end(), [&](const auto& name) { return name.starts_with(part); });
        };
        EXPECT_FALSE(has("lip_upper") && has("lip_lower"));
        EXPECT_FALSE(has("upper_lid") && has("lower_lid"));
    }
}

TEST(ControlSurface, has_three_holes_and_one_rim) {
    // A disc with three holes: vertices - edges + triangles = 1 - 3.
    const auto surface = control_surface(builtin_marker_set(), all_names());
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : surface.triangles)
        for (std::size_t c = 0; c < 3; ++c) ++edges[std::minmax(t[c], t[(c + 1) % 3])];
    EXPECT_EQ(76 - static_cast<int>(edges.size()) + static_cast<int>(surface.triangles.size()), -2);
    for (const auto& [edge, count] : edges) EXPECT_LE(count, 2);
}

TEST(ControlSurface, a_triangle_of_a_lip_lacks_the_bit_of_the_other_lip_alone) {
    const auto& set = builtin_marker_set();
    ASSERT_EQ(set.openings.size(), 3U);
    ASSERT_EQ(set.openings[0].name, "mouth");
    const auto surface = control_surface(set, all_names());
    int upper = 0, lower = 0;
    for (std::size_t k = 0; k < surface.triangles.size(); ++k) {
        bool above = false, below = false;
        for (const auto c : surface.triangles[k]) {
            above = above || surface.corners[c].starts_with("lip_upper");
            below = below || surface.corners[c].starts_with("lip_lower");
        }
        if (above) {
            EXPECT_EQ(surface.parts[k] & 3U, part_bit(0, true));
        }
        if (below) {
            EXPECT_EQ(surface.parts[k] & 3U, part_bit(0, false));
        }
        upper += above ? 1 : 0;
        lower += below ? 1 : 0;
    }
    EXPECT_GT(upper, 8);
    EXPECT_GT(lower, 8);
}

TEST(ControlSurface, triangles_without_all_corners_are_left_out_and_said) {
    auto names = all_names();
    names.erase(std::find(names.begin(), names.end(), "chin"));
    const auto surface = control_surface(builtin_marker_set(), names);
    EXPECT_EQ(surface.left_out, std::vector<std::string>{"chin"});
    EXPECT_LT(surface.triangles.size(), builtin_marker_set().triangles.size());
    const std::vector<std::string> strangers = {"LBRO", "RBRO"};
    EXPECT_THAT(message_of([&] { (void)control_surface(builtin_marker_set(), strangers); }),
                HasSubstr("no triangle of built-in marker set has all its corners"));
}

TEST(ControlSurface, flipped_flat_and_doubled_triangles_are_named) {
    MarkerSet set;
    const geometry::Landmarks places(std::vector<geometry::Landmark>{
        {"a", {0, 0, 0}, ""}, {"b", {10, 0, 0}, ""}, {"c", {0, 10, 0}, ""}, {"d", {20, 0, 0}, ""}});
    set.triangles = {{"a", "b", "c"}};
    EXPECT_THAT(surface_faults(set, places), IsEmpty());
    const auto fault = [&](const std::array<std::string, 3>& triangle) {
        set.triangles = {{"a", "b", "c"}, triangle};
        const auto faults = surface_faults(set, places);
        return faults.empty() ? std::string() : faults.front();
    };
    EXPECT_THAT(fault({"b", "c", "d"}), HasSubstr("is flipped"));
    EXPECT_THAT(fault({"a", "b", "d"}), HasSubstr("has no area"));
    EXPECT_THAT(fault({"b", "c", "a"}), HasSubstr("is there twice"));
    EXPECT_THAT(fault({"a", "a", "c"}), HasSubstr("has a corner twice"));
}

}  // namespace
}  // namespace mimik::capture
