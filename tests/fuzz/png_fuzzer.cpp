#include "io/image.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto image = io::decode_png(bytes, "input");
    require(image.rgb.size() ==
                std::size_t{3} * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height),
            "three bytes a pixel");
    if (image.rgb.size() > 100'000) return;
    const auto again = io::decode_png(io::encode_png(image), "again");
    require(again.rgb == image.rgb, "what was written reads back");
}

std::vector<std::string> seeds() {
    std::vector<std::string> files;
    for (const int size : {1, 7, 40}) {
        io::Image image{size, size, {}};
        for (int i = 0; i < 3 * size * size; ++i) image.rgb.push_back(static_cast<std::uint8_t>(i * i));
        const auto bytes = io::encode_png(image);
        files.emplace_back(bytes.begin(), bytes.end());
    }
    return files;
}

}  // namespace mimik::fuzzing
