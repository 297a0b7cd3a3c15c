#include <array>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "cli/command.h"
#include "io/json_values.h"
#include "report/figure_description.h"

namespace mimik::cli {
namespace {

using report::PanelDescription;

/// What is given once for each panel, or once for all of them.
struct PerPanel {
    std::vector<std::string> meshes, captions, landmarks, controls, arrows, textures, views;
    std::string unit = "mm";
    bool textured = false;
    std::string scalar, label, colour_map = "sequential";
    std::vector<double> range;
};

/// The value of panel p of `count`; "-" and nothing at all are no value.
std::string value_for(const std::vector<std::string>& values, std::size_t p, std::size_t count, const char* option) {
    if (values.empty()) return {};
    if (values.size() != 1 && values.size() != count)
        throw InputError(
            fmt::format("{} is given {} times for {} panels; give it once, or once for each panel ('-' for "
                        "none)",
                        option, values.size(), count));
    const auto& value = values.size() == 1 ? values[0] : values[p];
    return value == "-" ? std::string() : value;
}

std::vector<PanelDescription> panels_of(const PerPanel& given) {
    const auto count = given.meshes.size();
    if (given.captions.size() > count)
        throw InputError(fmt::format("--caption is given {} times for {} panels", given.captions.size(), count));
    std::vector<PanelDescription> panels(count);
    for (std::size_t p = 0; p < count; ++p) {
        auto& panel = panels[p];
        if (given.meshes[p] != "-") panel.mesh = given.meshes[p];
        panel.unit = io::parse_length_unit(given.unit);
        if (p < given.captions.size()) panel.caption = given.captions[p];
        panel.landmarks = value_for(given.landmarks, p, count, "--landmarks");
        panel.controls = value_for(given.controls, p, count, "--controls");
        panel.arrows = value_for(given.arrows, p, count, "--arrows");
        panel.texture = value_for(given.textures, p, count, "--texture");
        panel.textured = given.textured;
        if (const auto view = value_for(given.views, p, count, "--view"); !view.empty())
            panel.view = figures::parse_view(view);
        if (given.scalar.empty()) continue;
        panel.scalar = figures::Scalar{
            .attribute = given.scalar, .label = given.label, .map = figures::parse_colour_map(given.colour_map)};
        if (!given.range.empty()) panel.scalar->range = std::array{given.range[0], given.range[1]};
    }
    return panels;
}

void parse_size(const std::string& text, figures::Figure& page) {
    const auto cross = text.find('x');
    const std::string_view words = text;
    const auto width = base::parse_integer(words.substr(0, cross)).value_or(0);
    const auto height = cross == std::string::npos ? 0 : base::parse_integer(words.substr(cross + 1)).value_or(0);
    constexpr std::int64_t most = 100'000;  // Figure::check gives the true limits
    if (width < 1 || height < 1 || width > most || height > most)
        throw InputError(fmt::format("--size is '{}'; give WIDTHxHEIGHT in pixels, such as 400x480", text));
    page.panel_width_px = static_cast<int>(width);
    page.panel_height_px = static_cast<int>(height);
}

void draw(const report::FigureDescription& description, const std::string& output, const Common& common) {
    if (!base::equal_ignoring_case(std::filesystem::path(output).extension().string(), ".png"))
        throw InputError(fmt::format("--output is '{}'; figures are written as .png", output));
    const auto figure = report::load_figure(description);
    const auto image = figures::render(figure);
    io::write_png(output, image);
    if (common.json)
        std::cout << io::json_text(nlohmann::ordered_json{{"output", output},
                                                          {"width_px", image.width},
                                                          {"height_px", image.height},
                                                          {"panels", figure.panels.size()},
                                                          {"drawn_with", figures::drawing_route()}});
    else if (!common.quiet)
        std::cout << fmt::format("{}: {} x {} pixels, {} panels\n", output, image.width, image.height,
                                 figure.panels.size());
}

int run_figure(int argc, char** argv) {
    CLI::App app{"Draws faces side by side, without needing a display.", "mimik-figure"};
    Common common;
    report::FigureDescription description;
    figures::Figure& page = description.page;
    PerPanel given;
    std::string output, file, size, framing = "own";

    app.add_option("panel", given.meshes, "Meshes: PLY, OBJ, STL, PCD, VTP or .bnt; '-' leaves a gap");
    app.add_option("-o,--output", output, "The picture (.png)")->required();
    app.add_option("--description", file, "A JSON file that describes the whole figure");
    // What a description says itself.
    const std::vector<CLI::Option*> described = {
        app.add_option("--caption", given.captions, "Text beneath a panel; repeat in the order of the panels")
            ->allow_extra_args(false),
        app.add_option("--landmarks", given.landmarks, "Landmark file, in blue; once, or once a panel")
            ->allow_extra_args(false),
        app.add_option("--controls", given.controls, "CSV name,x,y,z,kind: muscle (red) and wrinkle (orange) controls")
            ->allow_extra_args(false),
        app.add_option("--arrows", given.arrows, "CSV x,y,z,to_x,to_y,to_z")->allow_extra_args(false),
        app.add_option("--texture", given.textures, "PNG or JPEG on the face; once, or once a panel")
            ->allow_extra_args(false),
        app.add_flag("--textured", given.textured, "Use the image that each mesh file names"),
        app.add_option("--unit", given.unit, "Of the files: mm, cm or m")->capture_default_str(),
        app.add_option("--view", given.views,
                       "front, left, right, three-quarter-left, three-quarter-right; once, or once a panel")
            ->allow_extra_args(false),
        app.add_option("--scalar", given.scalar, "Colour by this attribute of the meshes"),
        app.add_option("--range", given.range, "Values at the ends of the colours")->expected(2),
        app.add_option("--colour-map", given.colour_map, "sequential or diverging")->capture_default_str(),
        app.add_option("--label", given.label, "Text of the colour bar, with the unit"),
        app.add_option("--title", page.title, "Text above the panels"),
        app.add_option("--columns", page.columns, "Panels in a row; 0 = chosen")->capture_default_str(),
        app.add_option("--size", size,
                       fmt::format("Of a panel in pixels [{}x{}]", page.panel_width_px, page.panel_height_px)),
        app.add_option("--font-size", page.font_size_px, "Of captions, in pixels")->capture_default_str(),
        app.add_option("--framing", framing, "own: each panel centred on its face; common: all on one point")
            ->capture_default_str(),
        app.add_option("--height-mm", page.height_mm, "Height of a panel in mm; without: every face whole"),
        app.add_option("--scale-bar-mm", page.scale_bar_mm, "Length of a scale bar below the first panel; 0 = none"),
        app.add_flag("--legend", page.legend, "Name the markers beneath the panels"),
        app.add_option("--supersampling", page.supersampling, "1 to 4: smoother edges for print, slower")
            ->capture_default_str()};
    add_common_options(app, common);

    app.callback([&] {
        if (file.empty()) {
            if (given.meshes.empty()) throw InputError("no mesh is given; name one for each panel, or --description");
            if (!given.range.empty() && given.scalar.empty()) throw InputError("--range needs --scalar");
            if (!size.empty()) parse_size(size, page);
            page.framing = figures::parse_framing(framing);
            description.panels = panels_of(given);
        } else {
            if (!given.meshes.empty()) throw InputError("give meshes or --description, not both");
            for (const auto* option : described)
                if (option->count() > 0)
                    throw InputError(option->get_name() + " and --description exclude one another: say it in " + file);
            description = report::read_figure_description(file);
        }
        draw(description, output, common);
    });
    return run(app, argc, argv, exit_done);
}

}  // namespace
}  // namespace mimik::cli

int main(int argc, char** argv) { return mimik::cli::run_figure(argc, argv); }
