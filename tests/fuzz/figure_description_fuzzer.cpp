#include "figures/figure_description.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto description = figures::decode_figure_description(std::string(text_of(bytes)), "input", "folder");
    for (const auto& panel : description.panels)
        require(panel.mesh.empty() || panel.mesh.is_absolute() || panel.mesh.string().starts_with("folder"),
                "paths start at the description's folder");
}

std::vector<std::string> seeds() {
    return {
        R"({"schema": 1, "panels": [{"mesh": "a.ply", "caption": "a", "view": {"yaw_deg": 1}}]})",
        R"({"schema": 1, "columns": 2, "background": "#102030", "framing": "common", "height_mm": 180, "view": "left",
                "panels": [{"markers": [{"file": "m.csv", "colour": "#ff0000", "radius_mm": 3}], "centre_mm": [1, 2, 3],
                            "scalar": {"attribute": "d", "range": [0, 5], "colour_map": "diverging"}}, {}]})"};
}

}  // namespace mimik::fuzzing
