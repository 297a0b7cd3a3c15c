#include "io/opencv_image.h"

#include <fmt/format.h>

#include "base/companion.h"
#include "base/errors.h"
#include "io/formats/bytes.h"

namespace mimik::io {
namespace {

constexpr std::uint64_t most_pixels = 100'000'000;
constexpr std::size_t size_bytes = 8;

}  // namespace

std::optional<Image> decode_with_opencv(std::span<const std::uint8_t> bytes, const std::string& name) {
    const auto program = base::find_companion("mimik-opencv");
    if (program.empty()) return std::nullopt;
    const auto decoded =
        base::run_companion(program, bytes, {fmt::format("OPENCV_IO_MAX_IMAGE_PIXELS={}", most_pixels)});
    const auto kind = image_kind(bytes);
    const auto refuse = [&](const std::string& why) {
        throw InputError(fmt::format("{}: the {}image cannot be decoded ({}); save it as PNG", name,
                                     kind.empty() ? std::string() : fmt::format("{} ", kind), why));
    };
    if (!decoded.fault.empty()) refuse(decoded.fault.substr(0, 200));
    if (decoded.output.size() < size_bytes) refuse("mimik-opencv gave nothing");
    Image image;
    image.width = formats::load<std::int32_t>(decoded.output.data());
    image.height = formats::load<std::int32_t>(decoded.output.data() + 4);
    if (image.width <= 0 || image.height <= 0 ||
        static_cast<std::uint64_t>(image.width) > most_pixels / static_cast<std::uint64_t>(image.height) ||
        decoded.output.size() - size_bytes !=
            std::size_t{3} * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
        refuse(fmt::format("mimik-opencv gave {} bytes for {} x {} pixels", decoded.output.size(), image.width,
                           image.height));
    image.rgb.assign(decoded.output.begin() + size_bytes, decoded.output.end());
    return image;
}

}  // namespace mimik::io
