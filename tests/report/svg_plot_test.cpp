#include "report/svg_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "report/surface_profile.h"

namespace mimik::report {
namespace {

using testing::HasSubstr;

/// Whether every tag is closed in its order, and nothing but text stands between them.
bool well_formed(const std::string& svg) {
    std::vector<std::string> open;
    for (std::size_t at = svg.find('<'); at != std::string::npos; at = svg.find('<', at + 1)) {
        const auto end = svg.find('>', at);
        if (end == std::string::npos || svg.find('<', at + 1) < end) return false;
        const auto tag = svg.substr(at + 1, end - at - 1);
        if (tag.starts_with("?") || tag.ends_with("/")) continue;
        const auto name = tag.substr(0, tag.find(' '));
        if (!name.starts_with("/")) {
            open.push_back(name);
        } else {
            if (open.empty() || "/" + open.back() != name) return false;
            open.pop_back();
        }
    }
    return open.empty();
}

TEST(SvgPlot, a_box_says_its_numbers_and_a_name_cannot_break_the_file) {
    const std::vector<PlotGroup> groups = {{"a<b & c", {1, 2, 3, 4, 100}}, {"one", {2}}};
    const auto svg = box_plot_svg("Errors", "mm", groups);
    EXPECT_TRUE(well_formed(svg)) << svg;
    EXPECT_THAT(svg, HasSubstr("a&lt;b &amp; c: median 3, quartiles 2 and 4, mean 22, n = 5"));
    EXPECT_THAT(svg, HasSubstr("<circle"));  // 100 lies beyond the whisker
    EXPECT_EQ(svg, box_plot_svg("Errors", "mm", groups));
    EXPECT_THROW((void)box_plot_svg("Errors", "mm", std::vector<PlotGroup>{{"none", {}}}), InputError);
}

TEST(SvgPlot, an_interval_has_its_estimate_and_both_ends) {
    const std::vector<PlotInterval> intervals = {{"default", 0.5, 0.25, 0.75, "n = 12"}};
    const auto svg = interval_plot_svg("Means", "mm", intervals);
    EXPECT_TRUE(well_formed(svg));
    EXPECT_THAT(svg, HasSubstr("0.5 [0.25, 0.75] n = 12"));
}

TEST(SvgPlot, a_line_stops_where_a_number_is_missing_and_its_name_is_in_the_legend_once) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    LinePlot plot{"cut", "x, mm", "y, mm", {{"neutral", {{0, 0}, {1, none}, {2, 2}, {3, 3}}, {0, 0, 0}, false}}};
    const auto svg = line_plots_svg(std::vector<LinePlot>{plot, plot});
    EXPECT_TRUE(well_formed(svg));
    const auto path = svg.substr(svg.find("<path d=\"") + 9);
    const auto drawn = path.substr(0, path.find('"'));
    EXPECT_EQ(std::count(drawn.begin(), drawn.end(), 'M'), 2);
    EXPECT_EQ(std::count(drawn.begin(), drawn.end(), 'L'), 1);
    std::size_t names = 0;
    for (auto at = svg.find(">neutral</text>"); at != std::string::npos; at = svg.find(">neutral</text>", at + 1))
        ++names;
    EXPECT_EQ(names, 1U);
    EXPECT_THROW((void)line_plots_svg({}), InputError);
}

TEST(SvgPlot, the_cumulative_share_of_four_values_rises_by_quarters) {
    const auto steps = cumulative_steps({3, 1, 2, 2});
    ASSERT_EQ(steps.size(), 8U);
    EXPECT_EQ(steps[0], (std::array{1.0, 0.0}));
    EXPECT_EQ(steps[1], (std::array{1.0, 0.25}));
    EXPECT_EQ(steps.back(), (std::array{3.0, 1.0}));
}

TEST(SurfaceProfile, of_a_slope_is_the_slope_and_nothing_beside_the_surface) {
    geometry::Mesh mesh;
    for (const double x : {0.0, 10.0})
        for (const double y : {0.0, 10.0}) mesh.vertices_mm.emplace_back(x, y, 0.5 * x);
    mesh.faces.add(std::array<std::uint32_t, 4>{0, 2, 3, 1});
    const auto profile = surface_profile(mesh, {{-5, 5}, {10, 5}, 4});
    ASSERT_EQ(profile.size(), 4U);
    EXPECT_TRUE(std::isnan(profile[0][1]));  // x = -5: no surface
    // x = 0, 5, 10: half of it, to rounding; the border belongs to the surface.
    EXPECT_NEAR(profile[2][1], 2.5, 1e-9);
    EXPECT_NEAR(profile[2][0], 10, 1e-9);
    EXPECT_THROW((void)surface_profile(mesh, {{1, 1}, {1, 1}, 4}), InputError);
}

}  // namespace
}  // namespace mimik::report
