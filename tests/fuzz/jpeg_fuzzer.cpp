#include "io/jpeg.h"
#include "tests/fuzz/fuzzing.h"
#include "tests/support/jpeg_of.h"

namespace mimik::fuzzing {

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto size = io::jpeg_size(bytes, "input");
    const auto image = io::decode_jpeg(bytes, "input");
    require(image.width == size[0] && image.height == size[1], "the header's size is the image's");
    require(image.rgb.size() ==
                std::size_t{3} * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height),
            "three bytes a pixel");
    require(image.rgb.size() <= 3 * 256 * bytes.size(), "memory is bounded by the length of the file");
}

std::vector<std::string> seeds() {
    std::vector<std::string> files;
    for (const bool progressive : {false, true})
        for (const int channels : {1, 3, 4}) files.push_back(test::jpeg_of(24, 17, channels, progressive));
    return files;
}

}  // namespace mimik::fuzzing
