#include "cli/figure_options.h"

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::cli {

void add_figure_options(CLI::App& command, FigureArguments& arguments) {
    auto& page = arguments.description.page;
    auto& given = arguments.given;
    command.add_option("panel", given.meshes, "Meshes: PLY, OBJ, STL, PCD, VTP or .bnt; '-' leaves a gap");
    command.add_option("-o,--output", arguments.output, "The picture (.png)")->required();
    command.add_option("--description", arguments.file, "A JSON file that describes the whole figure");
    // What a description says itself.
    arguments.described = {
        command.add_option("--caption", given.captions, "Text beneath a panel; repeat in the order of the panels")
            ->allow_extra_args(false),
        command.add_option("--landmarks", given.landmarks, "Landmark file, in blue; once, or once a panel")
            ->allow_extra_args(false),
        command
            .add_option("--controls", given.controls, "CSV name,x,y,z,kind: muscle (red) and wrinkle (orange) controls")
            ->allow_extra_args(false),
        command.add_option("--arrows", given.arrows, "CSV x,y,z,to_x,to_y,to_z")->allow_extra_args(false),
        command.add_option("--texture", given.textures, "PNG or JPEG on the face; once, or once a panel")
            ->allow_extra_args(false),
        command.add_flag("--textured", given.textured, "Use the image that each mesh file names"),
        command.add_option("--unit", given.unit, "Of the files: mm, cm, m or inch")->capture_default_str(),
        command
            .add_option("--view", given.views,
                        "front, left, right, three-quarter-left, three-quarter-right; once, or once a panel")
            ->allow_extra_args(false),
        command.add_option("--scalar", given.scalar, "Colour by this attribute of the meshes"),
        command.add_option("--range", given.range, "Values at the ends of the colours")->expected(2),
        command.add_option("--colour-map", given.colour_map, "Of --scalar")
            ->check(CLI::IsMember({"sequential", "diverging"}))
            ->capture_default_str(),
        command.add_option("--label", given.label, "Text of the colour bar, with the unit"),
        command.add_option("--title", page.title, "Text above the panels"),
        command.add_option("--columns", page.columns, "Panels in a row; 0 = chosen")->capture_default_str(),
        command.add_option("--size", arguments.size,
                           fmt::format("Of a panel in pixels [{}x{}]", page.panel_width_px, page.panel_height_px)),
        command.add_option("--font-size", page.font_size_px, "Of captions, in pixels")->capture_default_str(),
        command
            .add_option("--framing", arguments.framing, "own: each panel centred on its face; common: all on one point")
            ->check(CLI::IsMember({"own", "common"}))
            ->capture_default_str(),
        command.add_option("--height-mm", page.height_mm, "Height of a panel in mm; without: every face whole"),
        command.add_option("--scale-bar-mm", page.scale_bar_mm,
                           "Length of a scale bar below the first panel; 0 = none"),
        command.add_flag("--legend", page.legend, "Name the markers beneath the panels"),
        command.add_option("--supersampling", page.supersampling, "1 to 4: smoother edges for print, slower")
            ->capture_default_str()};
    add_common_options(command, arguments.common);
}

void check_figure_options(const FigureArguments& arguments) {
    const auto& given = arguments.given;
    if (arguments.file.empty()) {
        if (given.meshes.empty()) throw InputError("no mesh is given; name one for each panel, or --description");
        if (!given.range.empty() && given.scalar.empty()) throw InputError("--range needs --scalar");
        return;
    }
    if (!given.meshes.empty()) throw InputError("give meshes or --description, not both");
    for (const auto* option : arguments.described)
        if (option->count() > 0)
            throw InputError(option->get_name() + " and --description exclude one another: say it in " +
                             arguments.file);
}

}  // namespace mimik::cli
