#include "report/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/markup.h"
#include "base/quantile.h"

namespace mimik::report {
namespace {

using figures::Colour;

constexpr double letter_px = 7.4;  // mean width of a letter of 13 pixels in DejaVu Sans
constexpr const char* ink = "#202020";

std::string hex(const Colour& c) { return fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]); }

/// Steps of 1, 2 or 5 times a power of ten.
std::vector<double> ticks(double low, double high) {
    const double rough = (high - low) / 5, power = std::pow(10, std::floor(std::log10(rough)));
    const double step = power * (rough / power < 1.5 ? 1 : rough / power < 3.5 ? 2 : rough / power < 7.5 ? 5 : 10);
    std::vector<double> values;
    for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
        values.push_back(k == 0 ? 0 : k * step);
    return values;
}

/// From data to pixels.
struct Scale {
    double low = 0, high = 1, first_px = 0, last_px = 1;
    [[nodiscard]] double px(double value) const {
        return first_px + (value - low) / (high - low) * (last_px - first_px);
    }
};

/// What spans all values with some air; a single value gets air as well.
std::array<double, 2> range_of(double low, double high) {
    if (!(low <= high)) throw InputError("a plot has no finite number to show");
    const double air = high > low ? 0.04 * (high - low) : std::max(0.5, 0.1 * std::abs(high));
    return {low - air, high + air};
}

/// SVG being written.
class Page {
public:
    Page(double width, double height) : width_(width), height_(height) {}
    void text(double x, double y, const std::string& words, const char* anchor = "middle", int size = 13,
              const char* more = "") {
        body_ += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{}\" text-anchor=\"{}\"{}>{}</text>\n", x, y,
                             size, anchor, more, base::markup_text(words));
    }
    void line(double x1, double y1, double x2, double y2, const std::string& colour, double width = 1) {
        body_ += fmt::format(
            "<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" stroke=\"{}\" stroke-width=\"{}\"/>\n", x1,
            y1, x2, y2, colour, width);
    }
    void raw(const std::string& element) { body_ += element + "\n"; }
    [[nodiscard]] std::string finish() const {
        return fmt::format(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
            "{1:.0f}\" font-family=\"DejaVu Sans, sans-serif\" fill=\"{2}\">\n"
            "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{3}</svg>\n",
            width_, height_, ink, body_);
    }

private:
    double width_, height_;
    std::string body_;
};

void x_axis(Page& page, const Scale& x, double top, double bottom, const std::string& label) {
    for (const double value : ticks(x.low, x.high)) {
        page.line(x.px(value), top, x.px(value), bottom, "#e2e2e2");
        page.text(x.px(value), bottom + 18, fmt::format("{:g}", value));
    }
    page.line(x.first_px, bottom, x.last_px, bottom, ink);
    page.text((x.first_px + x.last_px) / 2, bottom + 40, label);
}

void y_axis(Page& page, const Scale& y, double left, double right, const std::string& label) {
    for (const double value : ticks(y.low, y.high)) {
        page.line(left, y.px(value), right, y.px(value), "#e2e2e2");
        page.text(left - 6, y.px(value) + 4.5, fmt::format("{:g}", value), "end");
    }
    page.line(left, y.first_px, left, y.last_px, ink);
    const double middle = (y.first_px + y.last_px) / 2, at = left - 46;
    page.text(at, middle, label, "middle", 13,
              fmt::format(" transform=\"rotate(-90 {:.2f} {:.2f})\"", at, middle).c_str());
}

std::string path_of(const PlotLine& line, const Scale& x, const Scale& y) {
    std::string path;
    bool drawing = false;
    for (const auto& [px, py] : line.points) {
        const bool there = std::isfinite(px) && std::isfinite(py);
        if (there) path += fmt::format("{}{:.2f} {:.2f} ", drawing ? "L" : "M", x.px(px), y.px(py));
        drawing = there;
    }
    return path;
}

void draw_line_plot(Page& page, const LinePlot& plot, double left, double top, double width, double height) {
    double x_low = std::numeric_limits<double>::infinity(), x_high = -x_low, y_low = x_low, y_high = -x_low;
    for (const auto& line : plot.lines)
        for (const auto& [x, y] : line.points) {
            if (!std::isfinite(x) || !std::isfinite(y)) continue;
            x_low = std::min(x_low, x);
            x_high = std::max(x_high, x);
            y_low = std::min(y_low, y);
            y_high = std::max(y_high, y);
        }
    const auto xs = range_of(x_low, x_high), ys = range_of(y_low, y_high);
    const Scale x{xs[0], xs[1], left, left + width}, y{ys[0], ys[1], top + height, top};
    page.text(left + width / 2, top - 12, plot.title, "middle", 14);
    x_axis(page, x, top, top + height, plot.x_label);
    y_axis(page, y, left, left + width, plot.y_label);
    for (const auto& line : plot.lines)
        page.raw(
            fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\" stroke-linejoin=\"round\""
                        "{}><title>{}</title></path>",
                        path_of(line, x, y), hex(line.colour), line.dashed ? " stroke-dasharray=\"6 4\"" : "",
                        base::markup_text(line.name)));
}

/// Rows with names on the left, an axis of numbers beneath.
struct RowsLayout {
    double left, width, top = 46, row = 34, bottom, page_width;
    RowsLayout(std::size_t longest, std::size_t rows)
        : left(24 + letter_px * static_cast<double>(longest)),
          width(520),
          bottom(46 + 34 * static_cast<double>(rows)),
          page_width(left + width + 24) {}
    [[nodiscard]] double middle(std::size_t k) const { return top + row * (static_cast<double>(k) + 0.5); }
};

}  // namespace

Colour plot_colour(std::size_t k) {
    static constexpr std::array<Colour, 7> colours = {
        {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0}, {86, 180, 233}, {90, 90, 90}}};
    return colours[k % colours.size()];
}

std::string line_plots_svg(std::span<const LinePlot> plots) {
    if (plots.empty()) throw InputError("there is no plot to draw");
    constexpr double width = 400, height = 280, left = 76, top = 44, gap = 100;
    std::vector<const PlotLine*> legend;
    for (const auto& plot : plots)
        for (const auto& line : plot.lines)
            if (std::none_of(legend.begin(), legend.end(), [&](const auto* known) { return known->name == line.name; }))
                legend.push_back(&line);
    const double page_width = left + static_cast<double>(plots.size()) * (width + gap) - gap + 24;
    constexpr double legend_row = 22;
    std::vector<std::array<double, 2>> places;  // of the legend's entries
    double x = left, y = top + height + 70;
    for (const auto* line : legend) {
        const double wide = 44 + letter_px * static_cast<double>(line->name.size()) + 16;
        if (x > left && x + wide > page_width) {
            x = left;
            y += legend_row;
        }
        places.push_back({x, y});
        x += wide;
    }
    Page page(page_width, y + 16);
    for (std::size_t k = 0; k < plots.size(); ++k)
        draw_line_plot(page, plots[k], left + static_cast<double>(k) * (width + gap), top, width, height);
    for (std::size_t k = 0; k < legend.size(); ++k) {
        const auto [at, base] = places[k];
        page.raw(
            fmt::format("<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" stroke=\"{}\" "
                        "stroke-width=\"2.4\"{}/>",
                        at, base - 4.5, at + 34, base - 4.5, hex(legend[k]->colour),
                        legend[k]->dashed ? " stroke-dasharray=\"6 4\"" : ""));
        page.text(at + 40, base, legend[k]->name, "start");
    }
    return page.finish();
}

std::string box_plot_svg(const std::string& title, const std::string& label, std::span<const PlotGroup> groups) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    std::size_t longest = 0;
    for (const auto& group : groups) {
        if (group.values.empty()) throw InputError(fmt::format("'{}' has no number to show", group.name));
        longest = std::max(longest, group.name.size());
        low = std::min(low, *std::min_element(group.values.begin(), group.values.end()));
        high = std::max(high, *std::max_element(group.values.begin(), group.values.end()));
    }
    const auto range = range_of(low, high);
    const RowsLayout rows(longest, groups.size());
    const Scale x{range[0], range[1], rows.left, rows.left + rows.width};
    Page page(rows.page_width, rows.bottom + 56);
    page.text(rows.page_width / 2, 24, title, "middle", 14);
    x_axis(page, x, rows.top, rows.bottom, label);
    for (std::size_t k = 0; k < groups.size(); ++k) {
        const auto& values = groups[k].values;
        const double q1 = base::quantile(values, 0.25), median = base::quantile(values, 0.5),
                     q3 = base::quantile(values, 0.75), reach = 1.5 * (q3 - q1), y = rows.middle(k);
        double first = q1, last = q3, mean = 0;
        for (const double value : values) {
            mean += value / static_cast<double>(values.size());
            if (value >= q1 - reach) first = std::min(first, value);
            if (value <= q3 + reach) last = std::max(last, value);
        }
        const auto colour = hex(plot_colour(k));
        page.text(rows.left - 10, y + 4.5, groups[k].name, "end");
        page.line(x.px(first), y, x.px(q1), y, colour, 1.4);
        page.line(x.px(q3), y, x.px(last), y, colour, 1.4);
        for (const double end : {first, last}) page.line(x.px(end), y - 6, x.px(end), y + 6, colour, 1.4);
        page.raw(
            fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"20\" fill=\"{}\" "
                        "fill-opacity=\"0.25\" stroke=\"{}\"><title>{}: median {:.3g}, quartiles {:.3g} and "
                        "{:.3g}, mean {:.3g}, n = {}</title></rect>",
                        x.px(q1), y - 10, x.px(q3) - x.px(q1), colour, colour, base::markup_text(groups[k].name),
                        median, q1, q3, mean, values.size()));
        page.line(x.px(median), y - 10, x.px(median), y + 10, colour, 2.4);
        page.raw(fmt::format("<path d=\"M{0:.2f} {1:.2f}l4 4l-4 4l-4 -4z\" fill=\"{2}\"/>", x.px(mean), y - 4, ink));
        for (const double value : values)
            if (value < first || value > last)
                page.raw(fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"2.2\" fill=\"none\" stroke=\"{}\"/>",
                                     x.px(value), y, colour));
    }
    return page.finish();
}

std::string interval_plot_svg(const std::string& title, const std::string& label,
                              std::span<const PlotInterval> intervals) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    std::size_t longest = 0;
    for (const auto& one : intervals) {
        low = std::min({low, one.low, one.estimate});
        high = std::max({high, one.high, one.estimate});
        longest = std::max(longest, one.name.size());
    }
    const auto range = range_of(low, high);
    const RowsLayout rows(longest, intervals.size());
    constexpr double numbers_px = 230;
    const Scale x{range[0], range[1], rows.left, rows.left + rows.width};
    Page page(rows.page_width + numbers_px, rows.bottom + 56);
    page.text((rows.page_width + numbers_px) / 2, 24, title, "middle", 14);
    x_axis(page, x, rows.top, rows.bottom, label);
    for (std::size_t k = 0; k < intervals.size(); ++k) {
        const auto& one = intervals[k];
        const double y = rows.middle(k);
        const auto colour = hex(plot_colour(k));
        page.text(rows.left - 10, y + 4.5, one.name, "end");
        page.line(x.px(one.low), y, x.px(one.high), y, colour, 2);
        for (const double end : {one.low, one.high}) page.line(x.px(end), y - 6, x.px(end), y + 6, colour, 2);
        page.raw(
            fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"4.5\" fill=\"{}\"/>", x.px(one.estimate), y, colour));
        page.text(rows.left + rows.width + 14, y + 4.5,
                  fmt::format("{:.3g} [{:.3g}, {:.3g}] {}", one.estimate, one.low, one.high, one.note), "start");
    }
    return page.finish();
}

std::vector<std::array<double, 2>> cumulative_steps(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    std::vector<std::array<double, 2>> steps;
    const auto n = static_cast<double>(values.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
        steps.push_back({values[k], static_cast<double>(k) / n});
        steps.push_back({values[k], static_cast<double>(k + 1) / n});
    }
    return steps;
}

}  // namespace mimik::report
