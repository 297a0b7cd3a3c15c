#include "io/bmp.h"
#include "io/image.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const bool bmp = bytes.size() > 1 && bytes[0] == 'B' && bytes[1] == 'M';
    const auto image = bmp ? io::decode_bmp(bytes, "input") : io::decode_png(bytes, "input");
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
    for (const char bits : {1, 4, 8, 16, 24, 32}) {
        std::string bmp(14 + 40 + 1024 + 4 * 4 * 4, '\5');
        bmp.replace(0, 14, std::string("BM\0\0\0\0\0\0\0\0\x36\4\0\0", 14));
        bmp.replace(14, 40, std::string(40, '\0'));
        bmp[14] = 40;
        bmp[18] = bmp[22] = 4;
        bmp[28] = bits;
        files.push_back(std::move(bmp));
    }
    return files;
}

}  // namespace mimik::fuzzing
