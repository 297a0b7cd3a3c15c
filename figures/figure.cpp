#include "figures/figure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <vtkRenderWindow.h>

#include "base/errors.h"
#include "base/text.h"
#include "figures/canvas.h"
#include "figures/offscreen.h"
#include "figures/panel_scene.h"

namespace mimik::figures {
namespace {

using geometry::Point;
using geometry::Vector;
using Range = std::array<double, 2>;

constexpr Colour ink = {20, 20, 20};

/// Least and greatest coordinate in a view's axes (right, up, towards the viewer).
struct Box {
    Vector low = Vector::Constant(std::numeric_limits<double>::infinity());
    Vector high = Vector::Constant(-std::numeric_limits<double>::infinity());
    void add(const Vector& p) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    [[nodiscard]] bool empty() const { return !(low.x() <= high.x()); }
    [[nodiscard]] Vector middle() const { return 0.5 * (low + high); }
    [[nodiscard]] Vector size() const { return high - low; }
};

/// What a panel draws of its mesh: corners of whole faces, or every finite vertex of a cloud.
template <class Visit>
void visit_drawn(const geometry::Mesh& mesh, const Visit& visit) {
    const auto finite = [&](std::uint32_t v) { return mesh.vertices_mm[v].allFinite(); };
    if (mesh.faces.size() == 0) {
        for (const auto& p : mesh.vertices_mm)
            if (p.allFinite()) visit(p);
        return;
    }
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto face = mesh.faces[f];
        if (std::all_of(face.begin(), face.end(), finite))
            for (const auto v : face) visit(mesh.vertices_mm[v]);
    }
}

Box box_in_view(const Panel& panel) {
    const Eigen::Matrix3d axes = view_axes(panel.view);
    Box box;
    visit_drawn(panel.mesh, [&](const Point& p) { box.add(axes * p); });
    return box;
}

/// Where a panel's colour map begins and ends.
Range scalar_range(const Figure& figure, const Scalar& scalar) {
    if (scalar.range) return *scalar.range;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const auto& panel : figure.panels) {
        if (!panel.scalar || panel.scalar->attribute != scalar.attribute || panel.mesh.vertices_mm.empty()) continue;
        for (const double value : scalar_values(panel.mesh, scalar.attribute)) {
            if (!std::isfinite(value)) continue;
            low = std::min(low, value);
            high = std::max(high, value);
        }
    }
    if (!(low <= high)) return {0, 1};
    if (scalar.map == ColourMap::diverging) {
        high = std::max(std::abs(low), std::abs(high));
        low = -high;
    } else {
        low = std::min(low, 0.0);
    }
    return low < high ? Range{low, high} : Range{low, low + 1};
}

std::string bar_label(const Scalar& scalar) { return scalar.label.empty() ? scalar.attribute : scalar.label; }

/// A panel's colour bar; two panels with equal ones share it.
struct Bar {
    std::string label;
    Range range;
    ColourMap map;
    bool operator==(const Bar&) const = default;
};

/// Steps of 1, 2 or 5 times a power of ten, about five of them.
std::vector<double> ticks(const Range& range) {
    const double rough = (range[1] - range[0]) / 5, power = std::pow(10, std::floor(std::log10(rough)));
    const double step = power * (rough / power < 1.5 ? 1 : rough / power < 3.5 ? 2 : rough / power < 7.5 ? 5 : 10);
    std::vector<double> values;
    for (double k = std::ceil(range[0] / step - 1e-9); k * step <= range[1] + 1e-9 * step; ++k)
        values.push_back(k == 0 ? 0 : k * step);
    return values;
}

std::string tick_text(double value, const Range& range) {
    const double step = (range[1] - range[0]) / 5;
    return fmt::format("{:.{}f}", value, std::clamp(static_cast<int>(std::ceil(0.3 - std::log10(step))), 0, 9));
}

/// Width in pixels that a bar with its numbers and its label takes.
int bar_width(const Bar& bar, int font_px) {
    int numbers = 0;
    for (const double value : ticks(bar.range))
        numbers = std::max(numbers, text_width(tick_text(value, bar.range), font_px));
    return std::max(font_px + font_px / 2 + numbers, text_width(bar.label, font_px)) + font_px;
}

void draw_bar(Canvas& canvas, const Bar& bar, int x, int y, int height, int font_px) {
    canvas.text(x, y + font_px, bar.label, font_px, 0, ink);
    const int top = y + 2 * font_px, rows = height - 3 * font_px, width = font_px;
    canvas.fill(x - 1, top - 1, width + 2, rows + 2, ink);
    for (int row = 0; row < rows; ++row)
        canvas.fill(x, top + row, width, 1, map_colour(bar.map, 1 - (row + 0.5) / rows));
    for (const double value : ticks(bar.range)) {
        const double t = (value - bar.range[0]) / (bar.range[1] - bar.range[0]);
        const int at = top + static_cast<int>(std::lround((1 - t) * (rows - 1)));
        canvas.fill(x + width, at, std::max(2, font_px / 4), 1, ink);
        canvas.text(x + width + font_px / 2.0, at + static_cast<int>(std::lround(0.36 * font_px)),
                    tick_text(value, bar.range), font_px, 0, ink);
    }
}

struct LegendEntry {
    std::string name;
    Colour colour;
    bool operator==(const LegendEntry&) const = default;
};

std::vector<LegendEntry> legend_entries(const Figure& figure) {
    std::vector<LegendEntry> entries;
    const auto add = [&](const auto& sets) {
        for (const auto& set : sets) {
            const LegendEntry entry{set.name, set.colour};
            if (!set.name.empty() && std::find(entries.begin(), entries.end(), entry) == entries.end())
                entries.push_back(entry);
        }
    };
    for (const auto& panel : figure.panels) {
        add(panel.markers);
        add(panel.arrows);
    }
    return entries;
}

int legend_entry_width(const LegendEntry& entry, int font_px) { return font_px + text_width(entry.name, font_px); }

/// Entries in lines that are no wider than the page; two letters' width between neighbours.
std::vector<std::vector<LegendEntry>> legend_lines(const Figure& figure, int width_px) {
    std::vector<std::vector<LegendEntry>> lines;
    int used = 0;
    if (!figure.legend) return lines;
    for (const auto& entry : legend_entries(figure)) {
        const int width = legend_entry_width(entry, figure.font_size_px) + 2 * figure.font_size_px;
        if (lines.empty() || used + width > width_px + 2 * figure.font_size_px) {
            lines.emplace_back();
            used = 0;
        }
        lines.back().push_back(entry);
        used += width;
    }
    return lines;
}

/// Everything about the page that does not need drawing.
struct Layout {
    int columns = 1, rows = 1;
    int margin = 0;
    int line_height = 0, title_line_height = 0;
    std::vector<std::string> title;
    std::vector<std::vector<LegendEntry>> legend;
    std::vector<std::vector<std::string>> captions;  ///< lines per panel
    std::vector<int> row_height;                     ///< panel and caption
    std::vector<std::optional<Bar>> bars;            ///< per panel
    std::optional<Bar> shared_bar;                   ///< at the right of all panels
    int scale_strip = 0;                             ///< below the panels of the first row, so that no face is under it
    int cell_width = 0, bar_strip = 0;               ///< bar_strip: beside each panel, or once at the right
    int width = 0, height = 0;

    [[nodiscard]] int title_height() const {
        return title.empty() ? 0 : static_cast<int>(title.size()) * title_line_height + margin;
    }
    [[nodiscard]] int legend_height() const {
        return legend.empty() ? 0 : static_cast<int>(legend.size()) * line_height + margin;
    }
};

int title_font_px(const Figure& figure) { return figure.font_size_px * 13 / 10; }
int bar_font_px(const Figure& figure) { return std::max(9, figure.font_size_px * 85 / 100); }

int chosen_columns(const Figure& figure) {
    const int count = static_cast<int>(figure.panels.size());
    if (figure.columns > 0) return std::min(figure.columns, count);
    return count <= 4 ? count : static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
}

Layout lay_out(const Figure& figure) {
    Layout page;
    const int count = static_cast<int>(figure.panels.size());
    page.columns = chosen_columns(figure);
    page.rows = (count + page.columns - 1) / page.columns;
    page.margin = std::max(4, figure.font_size_px / 2);
    page.line_height = figure.font_size_px * 125 / 100;
    page.title_line_height = title_font_px(figure) * 125 / 100;
    if (figure.scale_bar_mm > 0) page.scale_strip = bar_font_px(figure) * 125 / 100;

    bool one_for_all = true;
    const Bar* first = nullptr;
    page.bars.resize(figure.panels.size());
    for (std::size_t p = 0; p < figure.panels.size(); ++p) {
        const auto& panel = figure.panels[p];
        page.captions.push_back(wrapped(panel.caption, figure.font_size_px, figure.panel_width_px));
        if (!panel.scalar || panel.mesh.vertices_mm.empty()) continue;
        page.bars[p] = Bar{bar_label(*panel.scalar), scalar_range(figure, *panel.scalar), panel.scalar->map};
        page.bar_strip = std::max(page.bar_strip, bar_width(*page.bars[p], bar_font_px(figure)));
        if (first == nullptr) first = &*page.bars[p];
        one_for_all = one_for_all && *page.bars[p] == *first;
    }
    if (first != nullptr && one_for_all) page.shared_bar = *first;
    page.cell_width = figure.panel_width_px + (page.shared_bar ? 0 : page.bar_strip);

    for (int row = 0; row < page.rows; ++row) {
        std::size_t lines = 0;
        for (int p = row * page.columns; p < std::min(count, (row + 1) * page.columns); ++p)
            lines = std::max(lines, page.captions[static_cast<std::size_t>(p)].size());
        page.row_height.push_back(
            figure.panel_height_px +
            (lines == 0 ? 0 : static_cast<int>(lines) * page.line_height + figure.font_size_px / 2) +
            (row == 0 ? page.scale_strip : 0));
        page.height += page.row_height.back();
    }
    page.width =
        page.columns * page.cell_width + (page.columns + 1) * page.margin + (page.shared_bar ? page.bar_strip : 0);
    const int inner_width = page.width - 2 * page.margin;
    page.title = wrapped(figure.title, title_font_px(figure), inner_width);
    page.legend = legend_lines(figure, inner_width);
    page.height += (page.rows + 1) * page.margin + page.title_height() + page.legend_height();
    constexpr std::int64_t most_pixels = 100'000'000;  // what the PNG reader takes, too
    if (std::int64_t{page.width} * page.height > most_pixels)
        throw InputError(
            fmt::format("the figure would be {} x {} pixels; give smaller or fewer panels (at most {} "
                        "pixels in all)",
                        page.width, page.height, most_pixels));
    return page;
}

/// One scale for all panels, and the middle of each.
std::vector<PanelCamera> aim_cameras(const Figure& figure) {
    std::vector<PanelCamera> cameras(figure.panels.size());
    std::vector<Box> boxes;
    for (const auto& panel : figure.panels) boxes.push_back(box_in_view(panel));

    Box everything;  // in the frame of the faces
    if (figure.framing == Framing::common)
        for (const auto& panel : figure.panels) visit_drawn(panel.mesh, [&](const Point& p) { everything.add(p); });

    double mm_per_px = 0;
    for (std::size_t p = 0; p < figure.panels.size(); ++p) {
        const auto& panel = figure.panels[p];
        cameras[p].view = panel.view;
        if (boxes[p].empty()) continue;
        const Eigen::Matrix3d axes = view_axes(panel.view);
        if (panel.centre_mm)
            cameras[p].centre_mm = *panel.centre_mm;
        else if (figure.framing == Framing::common)
            cameras[p].centre_mm = everything.middle();
        else
            cameras[p].centre_mm = axes.transpose() * boxes[p].middle();
        const Vector centre = axes * cameras[p].centre_mm;
        const Vector reach = (boxes[p].high - centre).cwiseMax(centre - boxes[p].low);
        constexpr double air = 1.04;  // a face that touches the edge looks cut
        mm_per_px = std::max(
            {mm_per_px, 2 * air * reach.x() / figure.panel_width_px, 2 * air * reach.y() / figure.panel_height_px});
    }
    if (figure.height_mm) mm_per_px = *figure.height_mm / figure.panel_height_px;
    if (!(mm_per_px > 0)) mm_per_px = 1;
    for (auto& camera : cameras) camera.mm_per_px = mm_per_px;
    return cameras;
}

void draw_legend(Canvas& canvas, const Figure& figure, const Layout& page) {
    const int font = figure.font_size_px, gap = 2 * font;
    int baseline = page.height - page.margin - font / 3 - static_cast<int>(page.legend.size() - 1) * page.line_height;
    for (const auto& line : page.legend) {
        int width = -gap;
        for (const auto& entry : line) width += legend_entry_width(entry, font) + gap;
        double x = (page.width - width) / 2.0;
        for (const auto& entry : line) {
            canvas.disc(x + 0.35 * font, baseline - 0.36 * font, 0.3 * font, entry.colour);
            canvas.text(x + font, baseline, entry.name, font, 0, ink);
            x += legend_entry_width(entry, font) + gap;
        }
        baseline += page.line_height;
    }
}

/// The bar at x and its label beside it, or in its middle where the page ends before that, in a strip whose top is at
/// y.
void draw_scale_bar(Canvas& canvas, const Figure& figure, int x, int y, double mm_per_px, int end) {
    const int font = bar_font_px(figure), top = y + font * 6 / 10, thick = std::max(2, font / 6);
    const double room_mm = (end - x) * mm_per_px;
    if (figure.scale_bar_mm > room_mm)
        throw InputError(fmt::format("scale_bar_mm is {:g}, but the figure is {:.0f} mm wide; give a shorter bar",
                                     figure.scale_bar_mm, std::floor(room_mm)));
    const int length = static_cast<int>(std::lround(figure.scale_bar_mm / mm_per_px));
    const auto label = fmt::format("{:g} mm", figure.scale_bar_mm);
    const int width = text_width(label, font), gap = font / 2;
    if (x + length + gap + width <= end) {
        canvas.fill(x, top, length, thick, ink);
        canvas.text(x + length + gap, y + font, label, font, 0, ink);
    } else {
        const int side = std::max(0, (length - width) / 2 - gap);
        canvas.fill(x, top, side, thick, ink);
        canvas.text(x + (length - width) / 2.0, y + font, label, font, 0, ink);
        canvas.fill(x + length - side, top, side, thick, ink);
    }
}

/// The numbers of a panel's markers, each beside its ball: to the side that leads away from the panel's middle.
void draw_numbers(Canvas& canvas, const Panel& panel, const PanelCamera& camera, const Figure& figure, int left,
                  int top) {
    const Eigen::Matrix3d axes = view_axes(camera.view);
    const int font = figure.font_size_px * 7 / 10;
    for (const auto& set : panel.markers) {
        if (!set.numbered) continue;
        for (std::size_t k = 0; k < set.positions_mm.size(); ++k) {
            const Vector seen = axes * (set.positions_mm[k] - camera.centre_mm) / camera.mm_per_px;
            const double gap = set.radius_mm / camera.mm_per_px + font / 5.0;
            // Two that fall together, as the inner points of closed lips do, have their numbers on both sides.
            const bool shared =
                std::any_of(set.positions_mm.begin(), set.positions_mm.begin() + static_cast<std::ptrdiff_t>(k),
                            [&](const Point& p) { return (p - set.positions_mm[k]).norm() < 2 * set.radius_mm; });
            const bool to_the_right = (seen.x() >= 0) != shared;
            canvas.outlined_text(
                left + figure.panel_width_px / 2.0 + seen.x() + (to_the_right ? gap : -gap),
                top + static_cast<int>(std::lround(figure.panel_height_px / 2.0 - seen.y() - 0.1 * font)),
                std::to_string(k + 1), font, to_the_right ? 0 : 1, ink);
        }
    }
}

}  // namespace

io::Image render(const Figure& figure) {
    figure.check();
    const Layout page = lay_out(figure);
    const auto cameras = aim_cameras(figure);
    Canvas canvas(page.width, page.height, figure.background);
    int y = page.margin;
    for (const auto& line : page.title) {
        canvas.text(page.width / 2.0, y + title_font_px(figure), line, title_font_px(figure), 0.5, ink);
        y += page.title_line_height;
    }
    y = page.margin + page.title_height();
    for (int row = 0; row < page.rows; ++row) {
        for (int col = 0; col < page.columns; ++col) {
            const int panel_number = row * page.columns + col;
            const auto p = static_cast<std::size_t>(panel_number);
            if (p >= figure.panels.size()) break;
            const auto& panel = figure.panels[p];
            const int x = page.margin + col * (page.cell_width + page.margin);
            if (!panel.mesh.vertices_mm.empty())
                canvas.place(x, y,
                             draw_panel(panel, cameras[p], figure, page.bars[p] ? page.bars[p]->range : Range{0, 1}));
            draw_numbers(canvas, panel, cameras[p], figure, x, y);
            if (page.bars[p] && !page.shared_bar)
                draw_bar(canvas, *page.bars[p], x + figure.panel_width_px + figure.font_size_px / 3, y,
                         figure.panel_height_px, bar_font_px(figure));
            if (p == 0 && figure.scale_bar_mm > 0)
                draw_scale_bar(canvas, figure, x + page.margin, y + figure.panel_height_px, cameras[0].mm_per_px,
                               page.width - page.margin);
            int baseline = y + figure.panel_height_px + (row == 0 ? page.scale_strip : 0) + figure.font_size_px * 5 / 4;
            for (const auto& line : page.captions[p]) {
                canvas.text(x + figure.panel_width_px / 2.0, baseline, line, figure.font_size_px, 0.5, ink);
                baseline += page.line_height;
            }
        }
        if (page.shared_bar && row == 0)
            draw_bar(canvas, *page.shared_bar, page.columns * (page.cell_width + page.margin) + page.margin, y,
                     figure.panel_height_px, bar_font_px(figure));
        y += page.row_height[static_cast<std::size_t>(row)] + page.margin;
    }
    if (!page.legend.empty()) draw_legend(canvas, figure, page);
    return canvas.image();
}

std::string drawing_route() {
    std::string answer;
    with_offscreen_window([&](vtkRenderWindow&, const std::string& route) { answer = route; });
    return answer;
}

}  // namespace mimik::figures
