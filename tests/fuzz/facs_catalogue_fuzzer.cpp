#include <algorithm>
#include <cmath>
#include <set>

#include "facs/facs_catalogue.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {
namespace {

void check_sound(const facs::FacsCatalogue& catalogue) {
    std::set<int> numbers;
    for (const auto& unit : catalogue.action_units()) {
        require(unit.number >= 1 && unit.number <= 99 && numbers.insert(unit.number).second, "AUs have own numbers");
        require(!unit.points.empty() && !unit.zone.empty(), "an AU has points and a zone");
        for (const auto& point : unit.points) {
            require(!point.placement.at.empty(), "a point stands at landmarks");
            require(std::isfinite(point.placement.lateral) && std::isfinite(point.placement.up), "offsets are finite");
            for (const auto& [landmark, weight] : point.placement.at)
                require(std::isfinite(weight), "weights are finite");
        }
        for (const auto& zone : unit.zone)
            require(zone.lateral_radius > 0 && zone.up_radius > 0 && std::isfinite(zone.lateral_radius),
                    "zones have radii");
    }
    for (const auto& emotion : catalogue.emotions())
        for (const int number : emotion.action_units) require(catalogue.find(number), "emotions are of known AUs");
}

}  // namespace

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const std::string text(text_of(bytes));
    const auto findings = facs::lint_catalogue(text);
    require(findings.size() <= 1001, "findings do not grow with the file");
    const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
    for (const auto& finding : findings) require(finding.line <= lines, "a finding names a line of the file");
    const bool wrong = std::any_of(findings.begin(), findings.end(), [](const auto& finding) { return finding.error; });
    try {
        check_sound(facs::parse_catalogue(text, "input"));
        require(!wrong, "what the linter calls an error is refused");
    } catch (const InputError&) {
        require(wrong, "what is refused, the linter calls an error");
    }
}

std::vector<std::string> seeds() {
    const std::string unit =
        "[[au]]\nnumber = 12\nname = \"Lip Corner Puller\"\nregion = \"lower\"\nsides = \"paired\"\n"
        "muscles = [{ name = \"zygomaticus major\", source = \"cheek bone to mouth corner\", reference = \"somebody "
        "2000\" }]\narkit = \"mouthSmile\"\n"
        "zone = [{ at = { mouth_corner = 1.0 }, offset = [0.1, 0.1], radii = [0.4, 0.4] }]\n"
        "points = [{ name = \"corner\", kind = \"muscle\", at = { mouth_corner = 1.0 } },\n"
        "  { name = \"fold\", kind = \"wrinkle\", at = { mouth_corner = 0.5, nose_wing = 0.5 }, offset = [0.05, 0.0] "
        "}]\n";
    // Longer than a fuzzer gets by itself: a key of many parts, brackets in brackets.
    std::string parts = "a", brackets = "a = ";
    for (int k = 0; k < 50'000; ++k) parts += ".a";
    brackets.append(50'000, '[');
    return {parts + " = 1\n",
            "[" + parts + "]\n",
            brackets,
            "schema = 1\n" + unit,
            "schema = 1\n[sampling]\ncoverage_spacing = 0.1\nanchor_margin = 0.2\n" + unit +
                "[[emotion]]\nname = \"happy\"\nunits = [12]\n",
            "schema = 1\n[[au]]\nnumber = 1e3\nat = {}\npoints = [{ at = { nowhere = nan } }]\n"};
}

}  // namespace mimik::fuzzing
