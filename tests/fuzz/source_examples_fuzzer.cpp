#include "modeling/source_examples.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto source = modeling::decode_source_examples(text_of(bytes), "input");
    source.check();
    const auto again = modeling::decode_source_examples(modeling::encode_source_examples(source), "again");
    require(again.examples == source.examples && again.features == source.features, "names read back");
    for (std::size_t i = 0; i < source.examples.size(); ++i)
        for (std::size_t k = 0; k < source.features.size(); ++k)
            // Six digits behind the point of two positions.
            require((again.displacement_mm[i][k] - source.displacement_mm[i][k]).cwiseAbs().maxCoeff() < 2e-6,
                    "displacements read back");
}

std::vector<std::string> seeds() {
    return {"example,chin_x,chin_y,chin_z\nneutral,0,-100,5\nopen,0,-120,1\n\"a,b\",1,2,3\n"};
}

}  // namespace mimik::fuzzing
