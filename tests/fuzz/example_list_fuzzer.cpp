#include "animation/facial_examples.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto list = animation::decode_example_list(text_of(bytes), "input");
    require(!list.neutral.empty() && !list.entries.empty() && list.entries.size() <= animation::most_examples,
            "nothing is empty in silence");
    for (const auto& entry : list.entries)
        require(!entry.name.empty() && entry.file.find('/') == std::string::npos, "files lie in the folder");
}

std::vector<std::string> seeds() {
    return {
        "schema = 1\nneutral = \"n.ply\"\ntexture = \"t.png\"\nfeatures = \"f.csv\"\n[[example]]\nname = \"a\"\n"
        "file = \"a.ply\"\narkit = [\"jawOpen\"]\n[feature_vertices]\nchin = 2\n"};
}

}  // namespace mimik::fuzzing
