#include "io/bmp.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include <fmt/format.h>

#include "base/errors.h"
#include "io/formats/bytes.h"

namespace mimik::io {
namespace {

constexpr std::int64_t most_pixels = 100'000'000;
constexpr std::size_t file_header_bytes = 14;

struct Header {
    std::size_t pixels_at = 0, header_bytes = 0;
    std::int64_t width = 0, height = 0;
    bool from_above = false;
    unsigned bits = 0;
    std::uint32_t compression = 0, colours = 0;
};

constexpr std::uint32_t plain = 0, bit_masks = 3, bit_masks_with_alpha = 6;

Header read_header(std::span<const std::uint8_t> bytes, const std::string& name) {
    const auto refuse = [&](const std::string& what) { throw InputError(fmt::format("{}: {}", name, what)); };
    if (bytes.size() < file_header_bytes + 12) refuse("the BMP ends inside its header; it is truncated");
    const auto* at = bytes.data();
    Header header;
    header.pixels_at = formats::load<std::uint32_t>(at + 10);
    header.header_bytes = formats::load<std::uint32_t>(at + 14);
    if (header.header_bytes == 12) {  // OS/2
        header.width = formats::load<std::uint16_t>(at + 18);
        header.height = formats::load<std::uint16_t>(at + 20);
        header.bits = formats::load<std::uint16_t>(at + 24);
    } else {
        if (header.header_bytes < 40 || header.header_bytes > 256 || bytes.size() < file_header_bytes + 40)
            refuse(fmt::format("the BMP's header has {} bytes; it is damaged", header.header_bytes));
        header.width = formats::load<std::int32_t>(at + 18);
        header.height = formats::load<std::int32_t>(at + 22);
        header.bits = formats::load<std::uint16_t>(at + 28);
        header.compression = formats::load<std::uint32_t>(at + 30);
        header.colours = formats::load<std::uint32_t>(at + 46);
        header.from_above = header.height < 0;
        header.height = std::abs(header.height);
    }
    if (header.width <= 0 || header.height <= 0)
        refuse(fmt::format("width x height is {} x {}; the image is empty", header.width, header.height));
    if (header.width > most_pixels / header.height)
        refuse(fmt::format("width x height is {} x {}, more than the {} million pixels that are read; scale it down",
                           header.width, header.height, most_pixels / 1'000'000));
    return header;
}

/// One channel of a pixel that bit masks divide, as 8 bits.
std::uint8_t masked(std::uint32_t pixel, std::uint32_t mask) {
    if (mask == 0) return 0;
    const int shift = std::countr_zero(mask);
    const std::uint64_t largest = mask >> shift;
    return static_cast<std::uint8_t>((std::uint64_t{(pixel & mask) >> shift} * 255 + largest / 2) / largest);
}

class Decoder {
public:
    Decoder(std::span<const std::uint8_t> bytes, const std::string& name)
        : bytes_(bytes), name_(name), header_(read_header(bytes, name)) {
        const bool direct = header_.bits == 16 || header_.bits == 24 || header_.bits == 32;
        if (!direct && header_.bits != 1 && header_.bits != 4 && header_.bits != 8)
            refuse(fmt::format("the BMP has {} bits a pixel; save it as PNG", header_.bits));
        const bool masks = header_.compression == bit_masks || header_.compression == bit_masks_with_alpha;
        if (header_.compression != plain && !(masks && (header_.bits == 16 || header_.bits == 32)))
            refuse("the BMP is compressed, which is not read; save it as PNG");
        if (masks)
            read_masks();
        else if (header_.bits == 16)
            masks_ = {0x7C00, 0x03E0, 0x001F};
        if (!direct) read_palette();
    }

    Image decode() {
        const auto width = static_cast<std::size_t>(header_.width), height = static_cast<std::size_t>(header_.height);
        const auto stride = (width * header_.bits + 31) / 32 * 4;
        if (header_.pixels_at > bytes_.size() || stride * height > bytes_.size() - header_.pixels_at)
            refuse(fmt::format("width x height is {} x {}, but the file has only {} bytes; it is truncated or damaged",
                               width, height, bytes_.size()));
        Image image{static_cast<int>(width), static_cast<int>(height), {}};
        image.rgb.resize(3 * width * height);
        for (std::size_t row = 0; row < height; ++row) {
            const auto* from =
                bytes_.data() + header_.pixels_at + stride * (header_.from_above ? row : height - 1 - row);
            for (std::size_t col = 0; col < width; ++col) {
                const auto colour = pixel(from, col);
                std::copy(colour.begin(), colour.end(),
                          image.rgb.begin() + static_cast<std::ptrdiff_t>(3 * (row * width + col)));
            }
        }
        return image;
    }

private:
    [[noreturn]] void refuse(const std::string& what) const { throw InputError(fmt::format("{}: {}", name_, what)); }

    void read_masks() {
        constexpr std::size_t at = file_header_bytes + 40;  // behind a short header, inside a long one
        if (bytes_.size() < at + 12) refuse("the BMP ends inside its header; it is truncated");
        for (std::size_t c = 0; c < 3; ++c) masks_[c] = formats::load<std::uint32_t>(bytes_.data() + at + 4 * c);
    }

    void read_palette() {
        const std::size_t entry = header_.header_bytes == 12 ? 3 : 4, at = file_header_bytes + header_.header_bytes;
        std::size_t count = std::size_t{1} << header_.bits;
        if (header_.colours > 0) count = std::min<std::size_t>(count, header_.colours);
        if (at > bytes_.size() || entry * count > bytes_.size() - at)
            refuse("the BMP ends inside its palette; it is truncated");
        for (std::size_t k = 0; k < count; ++k)
            for (std::size_t c = 0; c < 3; ++c) palette_[k][c] = bytes_[at + entry * k + 2 - c];
    }

    [[nodiscard]] std::array<std::uint8_t, 3> pixel(const std::uint8_t* row, std::size_t col) const {
        if (header_.bits <= 8) {
            const auto per_byte = 8 / header_.bits;
            const auto shift = header_.bits * (per_byte - 1 - col % per_byte);
            return palette_[row[col / per_byte] >> shift & ((1U << header_.bits) - 1)];
        }
        if (masks_ != std::array<std::uint32_t, 3>{}) {
            const auto value = header_.bits == 16 ? formats::load<std::uint16_t>(row + 2 * col)
                                                  : formats::load<std::uint32_t>(row + 4 * col);
            return {masked(value, masks_[0]), masked(value, masks_[1]), masked(value, masks_[2])};
        }
        const auto* bgr = row + header_.bits / 8 * col;
        return {bgr[2], bgr[1], bgr[0]};
    }

    std::span<const std::uint8_t> bytes_;
    const std::string& name_;
    Header header_;
    std::array<std::uint32_t, 3> masks_{};
    std::array<std::array<std::uint8_t, 3>, 256> palette_{};
};

}  // namespace

Image decode_bmp(std::span<const std::uint8_t> bytes, const std::string& name) { return Decoder(bytes, name).decode(); }

bool is_run_length_bmp(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < file_header_bytes + 20) return false;
    const auto compression = formats::load<std::uint32_t>(bytes.data() + 30);
    return formats::load<std::uint32_t>(bytes.data() + 14) >= 40 && (compression == 1 || compression == 2);
}

std::array<int, 2> bmp_size(std::span<const std::uint8_t> bytes, const std::string& name) {
    const auto header = read_header(bytes, name);
    return {static_cast<int>(header.width), static_cast<int>(header.height)};
}

}  // namespace mimik::io
