#include "capture/control_surface.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"

namespace mimik::capture {
namespace {

using Names = std::array<std::string, 3>;

bool touches(const Names& triangle, const std::vector<std::string>& part) {
    return std::any_of(triangle.begin(), triangle.end(), [&](const std::string& corner) {
        return std::find(part.begin(), part.end(), corner) != part.end();
    });
}

constexpr double flattest = 0.01;  // a planar bone divides by the height

/// Empty: nothing is wrong with its shape.
const char* fault_of_shape(const std::array<geometry::Point, 3>& at) {
    const geometry::Vector normal = (at[1] - at[0]).cross(at[2] - at[0]);
    double longest = 0;
    for (std::size_t c = 0; c < 3; ++c) longest = std::max(longest, (at[(c + 1) % 3] - at[c]).norm());
    if (!(normal.norm() > flattest * longest * longest)) return "has no area";
    // Under the jaw the skin looks down and a little back.
    constexpr double turned_back = -0.3;
    if (normal.z() < turned_back * normal.norm()) return "is flipped: its corners run clockwise seen from outside";
    return "";
}

}  // namespace

ControlSurface control_surface(const MarkerSet& set, std::span<const std::string> markers) {
    ControlSurface surface;
    surface.corners.assign(markers.begin(), markers.end());
    std::map<std::string, std::uint32_t> place;
    for (std::size_t k = 0; k < markers.size(); ++k) place.emplace(markers[k], static_cast<std::uint32_t>(k));
    std::uint32_t all = 0;
    for (std::size_t k = 0; k < set.openings.size(); ++k) all |= part_bit(k, true) | part_bit(k, false);
    if (set.openings.empty()) all = 1;
    std::set<std::string> left_out;
    for (const auto& names : set.triangles) {
        geometry::Triangle triangle{};
        bool whole = true;
        for (std::size_t c = 0; c < 3; ++c) {
            const auto it = place.find(names[c]);
            if (it == place.end()) {
                left_out.insert(names[c]);
                whole = false;
            } else {
                triangle[c] = it->second;
            }
        }
        if (!whole) continue;
        auto parts = all;
        for (std::size_t k = 0; k < set.openings.size(); ++k) {
            if (touches(names, set.openings[k].upper)) parts &= ~part_bit(k, false);
            if (touches(names, set.openings[k].lower)) parts &= ~part_bit(k, true);
        }
        surface.triangles.push_back(triangle);
        surface.parts.push_back(parts);
    }
    surface.left_out.assign(left_out.begin(), left_out.end());
    if (surface.triangles.empty())
        throw InputError(
            fmt::format("no triangle of {} has all its corners among the markers; name the markers as the set does "
                        "('mimik mocap markers'), or give a set with triangles between yours",
                        set.name.empty() ? "the marker set" : set.name));
    return surface;
}

std::vector<std::string> surface_faults(const MarkerSet& set, const geometry::Landmarks& places) {
    std::vector<std::string> faults;
    std::map<std::pair<std::string, std::string>, std::size_t> edges;
    std::set<Names> seen;
    for (const auto& names : set.triangles) {
        const auto all = fmt::format("{}", fmt::join(names, ", "));
        if (names[0] == names[1] || names[1] == names[2] || names[0] == names[2]) {
            faults.push_back(fmt::format("the triangle {} has a corner twice", all));
            continue;
        }
        auto sorted = names;
        std::sort(sorted.begin(), sorted.end());
        if (!seen.insert(sorted).second) faults.push_back(fmt::format("the triangle {} is there twice", all));
        for (std::size_t c = 0; c < 3; ++c) {
            const auto edge = std::minmax(names[c], names[(c + 1) % 3]);
            if (++edges[{edge.first, edge.second}] == 3)
                faults.push_back(fmt::format("more than two triangles have the edge {}, {}", edge.first, edge.second));
        }
        std::array<geometry::Point, 3> at;
        bool there = true;
        for (std::size_t c = 0; c < 3; ++c) {
            const auto* mark = places.find(names[c]);
            there = there && mark;
            if (mark) at[c] = mark->position_mm;
        }
        if (!there) continue;
        if (const std::string fault = fault_of_shape(at); !fault.empty())
            faults.push_back(fmt::format("the triangle {} {}", all, fault));
    }
    return faults;
}

}  // namespace mimik::capture
