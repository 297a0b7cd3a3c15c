#include <cmath>

#include "evaluation/experiment_file.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {

void fuzz_one(std::span<const std::uint8_t> bytes) {
    try {
        const auto file = evaluation::parse_experiment(text_of(bytes), "input");
        require(!file.expressions.empty() && !file.methods.empty(), "an experiment has expressions and methods");
        for (const double magnitude : file.magnitudes)
            require(std::isfinite(magnitude) && magnitude > 0, "magnitudes are numbers above 0");
        require(file.confidence >= 0.5 && file.confidence < 1, "a confidence is a share");
        require(file.resamples >= 100 && file.sources.next >= 0, "counts are in their range");
        require(file.database.empty() || file.workspace.empty(), "an experiment has one folder");
    } catch (const InputError& e) {
        require(std::string(e.what()).starts_with("input"), "a refusal names the file");
    }
}

std::vector<std::string> seeds() {
    const std::string shortest = "schema = 1\nexpressions = [\"12\"]\nmethods = [\"mean\"]\n";
    std::string brackets = "magnitudes = ";
    brackets.append(50'000, '[');
    return {shortest, shortest + brackets,
            shortest +
                "database = \"db\"\nunit = \"cm\"\nmagnitudes = [0.5, 1]\nseed = 7\n[subjects]\ntargets = "
                "[\"a\"]\nsources = { next = 4 }\n[evaluation]\nzones = \"data\"\nestimators = "
                "[\"signed\"]\nregions = [\"nose\"]\nmetrics = [\"rms\"]\nalignment = \"none\"\n[statistics]\n"
                "resamples = 500\nconfidence = 0.9\n"};
}

}  // namespace mimik::fuzzing
