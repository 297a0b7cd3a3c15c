#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "figures/colour_map.h"

// Plots as SVG text: the same numbers give the same bytes, and every mark says its numbers when it is pointed at.

namespace mimik::report {

/// Colours that people who see red and green alike tell apart (M. Okabe and K. Ito, "Color universal design", 2008).
[[nodiscard]] figures::Colour plot_colour(std::size_t k);

struct PlotLine {
    std::string name;
    std::vector<std::array<double, 2>> points;  ///< x, y; a NaN interrupts the line
    figures::Colour colour{};
    bool dashed = false;
};
struct LinePlot {
    std::string title, x_label, y_label;  ///< labels with the unit
    std::vector<PlotLine> lines;
};
/// Line plots side by side, each with its own axes; the legend names each line once.
/// @throws InputError if there is no plot, or one without a finite point.
[[nodiscard]] std::string line_plots_svg(std::span<const LinePlot> plots);

/// A name and its numbers.
struct PlotGroup {
    std::string name;
    std::vector<double> values;  ///< finite
};
/// A box per group, one below the other: quartiles and median, whiskers to the last value within 1.5 times the height
/// of the box (Tukey 1977), a dot per value beyond, a diamond at the mean.
/// @throws InputError if there is no group or one is empty.
[[nodiscard]] std::string box_plot_svg(const std::string& title, const std::string& label,
                                       std::span<const PlotGroup> groups);

/// An estimate with its interval.
struct PlotInterval {
    std::string name;
    double estimate = 0, low = 0, high = 0;
    std::string note;  ///< such as "n = 66"; empty: none
};
[[nodiscard]] std::string interval_plot_svg(const std::string& title, const std::string& label,
                                            std::span<const PlotInterval> intervals);

/// The share of values that are not greater than x, as the points of a line of steps.
[[nodiscard]] std::vector<std::array<double, 2>> cumulative_steps(std::vector<double> values);

}  // namespace mimik::report
