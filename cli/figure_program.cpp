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
#include "base/file.h"
#include "base/output_folder.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/error_report.h"
#include "cli/figure_options.h"
#include "cli/notes.h"
#include "cli/terminal.h"
#include "figures/png_resolution.h"
#include "io/json_values.h"
#include "report/figure_description.h"

namespace mimik::cli {
namespace {

using report::PanelDescription;

/// The value of panel p of `count`; "-" and nothing at all are no value.
std::string value_for(const std::vector<std::string>& values, std::size_t p, std::size_t count, const char* option) {
    if (values.empty()) return {};
    if (values.size() != 1 && values.size() != count)
        throw InputError(
            fmt::format("{} is given {} times for {}; give it once, or once for each panel ('-' for "
                        "none)",
                        option, values.size(), base::counted(count, "panel")));
    const auto& value = values.size() == 1 ? values[0] : values[p];
    return value == "-" ? std::string() : value;
}

std::vector<PanelDescription> panels_of(const PerPanel& given) {
    const auto count = given.meshes.size();
    if (given.captions.size() > count)
        throw InputError(
            fmt::format("--caption is given {} times for {}", given.captions.size(), base::counted(count, "panel")));
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

/// A fault of the page names the option that sets it, or the description that does.
io::Image render(const figures::Figure& figure, const std::string& description) {
    if (!description.empty()) return naming(description, [&] { return figures::render(figure); });
    io::Image image;
    check_by_option({{"columns", "--columns"},
                     {"panel_width_px", "--size"},
                     {"panel_height_px", "--size"},
                     {"font_size_px", "--font-size"},
                     {"height_mm", "--height-mm"},
                     {"scale_bar_mm", "--scale-bar-mm"},
                     {"supersampling", "--supersampling"}},
                    [&] { image = figures::render(figure); });
    return image;
}

void draw(const FigureArguments& arguments) {
    const auto& output = arguments.output;
    if (!base::equal_ignoring_case(std::filesystem::path(output).extension().string(), ".png"))
        throw InputError(fmt::format("--output is '{}'; figures are written as .png", output));
    std::vector<std::filesystem::path> inputs(arguments.given.meshes.begin(), arguments.given.meshes.end());
    if (!arguments.file.empty()) inputs = {arguments.file};
    const auto figure = naming_any(inputs, [&] { return report::load_figure(arguments.description); });
    if (!arguments.common.quiet) say_notes(figure.remarks);
    const auto image = render(figure, arguments.file);
    const auto png = figures::with_resolution(io::encode_png(image), figure.dots_per_inch);
    base::write_atomically(base::where_links_lead(output),
                           std::string_view(reinterpret_cast<const char*>(png.data()), png.size()));
    if (arguments.common.json)
        std::cout << io::json_text(nlohmann::ordered_json{{"schema", 1},
                                                          {"output", output},
                                                          {"width_px", image.width},
                                                          {"height_px", image.height},
                                                          {"panels", figure.panels.size()},
                                                          {"drawn_with", figures::drawing_route()}});
    else if (!arguments.common.quiet)
        std::cout << fmt::format("{}: {} x {} pixels, {}\n", output, image.width, image.height,
                                 base::counted(figure.panels.size(), "panel"));
}

int run_figure(int argc, char** argv) {
    prepare_standard_streams();
    CLI::App app{"Draws faces side by side, without needing a display.", "mimik-figure"};
    app.set_help_flag("-h,--help", "Print this help and stop");
    FigureArguments arguments;
    add_figure_options(app, arguments);
    app.callback([&] {
        check_figure_options(arguments);
        auto& page = arguments.description.page;
        if (arguments.file.empty()) {
            if (!arguments.size.empty()) parse_size(arguments.size, page);
            page.framing = figures::parse_framing(arguments.framing);
            arguments.description.panels = panels_of(arguments.given);
        } else {
            arguments.description =
                naming(arguments.file, [&] { return report::read_figure_description(arguments.file); });
        }
        draw(arguments);
    });
    return run(app, argc, argv, exit_done);
}

}  // namespace
}  // namespace mimik::cli

int main(int argc, char** argv) { return mimik::cli::run_figure(argc, argv); }
