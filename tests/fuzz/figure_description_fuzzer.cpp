#include "report/figure_description.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {

/// The description; behind a 'c' a table of control points, behind an 'a' one of arrows.
void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto text = text_of(bytes);
    if (text.starts_with('c')) {
        for (const auto& set : report::decode_controls(text.substr(1), "input", io::LengthUnit::centimetre))
            for (const auto& p : set.positions_mm) require(p.allFinite(), "control points are finite");
        return;
    }
    if (text.starts_with('a')) {
        for (const auto& arrow : report::decode_arrows(text.substr(1), "input", io::LengthUnit::metre).arrows)
            require(arrow.from_mm.allFinite() && arrow.to_mm.allFinite(), "arrows are finite");
        return;
    }
    const auto description = report::decode_figure_description(std::string(text), "input", "folder");
    for (const auto& panel : description.panels)
        require(panel.mesh.empty() || panel.mesh.is_absolute() || panel.mesh.string().starts_with("folder"),
                "paths start at the description's folder");
}

std::vector<std::string> seeds() {
    return {
        R"({"schema": 1, "panels": [{"mesh": "a.ply", "caption": "a", "view": {"yaw_deg": 1}}]})",
        R"({"schema": 1, "columns": 2, "background": "#102030", "framing": "common", "height_mm": 180, "view": "left",
                "panels": [{"markers": [{"file": "m.csv", "colour": "#ff0000", "radius_mm": 3}], "centre_mm": [1, 2, 3],
                            "scalar": {"attribute": "d", "range": [0, 5], "colour_map": "diverging"}}, {}]})",
        "cname,x,y,z,kind\na,1,2,3,muscle\n\"b, c\",4,5,6e1,wrinkle\n", "ax,y,z,to_x,to_y,to_z\n1,2,3,4,5,6\n"};
}

}  // namespace mimik::fuzzing
