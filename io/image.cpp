#include "io/image.h"

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <png.h>

#include "base/errors.h"
#include "base/file.h"
#include "io/bmp.h"
#include "io/jpeg.h"
#include "io/opencv_image.h"

namespace mimik::io {
namespace {

constexpr std::uint64_t most_pixels = 100'000'000;
// Deflate cannot shrink more than this, so a short file that promises more is damaged or hostile.
constexpr std::uint64_t best_deflate_ratio = 1032;

struct Input {
    const std::uint8_t* data = nullptr;
    std::size_t size = 0, at = 0;
};

/// What libpng's callbacks may touch. libpng reports errors by a jump, so everything that lives across one is plain
/// data.
struct PngState {
    std::jmp_buf jump;
    char message[128] = {};
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
    auto* state = static_cast<PngState*>(png_get_error_ptr(png));
    std::strncpy(state->message, message, sizeof(state->message) - 1);
    std::longjmp(state->jump, 1);
}

void on_warning(png_structp, png_const_charp) {}

void read_input(png_structp png, png_bytep out, std::size_t length) {
    auto* input = static_cast<Input*>(png_get_io_ptr(png));
    if (length > input->size - input->at) png_error(png, "the file ends inside its data");
    std::memcpy(out, input->data + input->at, length);
    input->at += length;
}

void append_output(png_structp png, png_bytep data, std::size_t length) {
    auto* bytes = static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
    try {
        bytes->insert(bytes->end(), data, data + length);
    } catch (...) {
        png_error(png, "out of memory");
    }
}

struct PngHeader {
    std::uint32_t width = 0, height = 0;
};

PngHeader parse_png_header(std::span<const std::uint8_t> bytes, const std::string& name) {
    if (bytes.size() < 33 || png_sig_cmp(bytes.data(), 0, 8) != 0 || std::memcmp(bytes.data() + 12, "IHDR", 4) != 0)
        throw InputError(fmt::format("{}: is no PNG image (no signature and header); save it as PNG", name));
    const auto big_endian = [&](std::size_t at) {
        return std::uint32_t{bytes[at]} << 24 | std::uint32_t{bytes[at + 1]} << 16 | std::uint32_t{bytes[at + 2]} << 8 |
               bytes[at + 3];
    };
    const PngHeader header{big_endian(16), big_endian(20)};
    if (header.width == 0 || header.height == 0)
        throw InputError(
            fmt::format("{}: width x height is {} x {}; the image is empty", name, header.width, header.height));
    if (std::uint64_t{header.width} * header.height > most_pixels)
        throw InputError(
            fmt::format("{}: width x height is {} x {}, more than the {} million pixels that are read; scale it "
                        "down",
                        name, header.width, header.height, most_pixels / 1'000'000));
    return header;
}

/// No object with a destructor may live in this function: errors jump out of libpng. `rgb` has 3 * width * height
/// bytes.
bool decode_rows(Input& input, PngState& state, std::uint32_t width, std::uint32_t height, std::uint8_t* rgb) {
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &state, on_error, on_warning);
    if (!png) return false;
    png_infop info = png_create_info_struct(png);
    if (!info || setjmp(state.jump) != 0) {
        png_destroy_read_struct(&png, &info, nullptr);
        return false;
    }
    png_set_read_fn(png, &input, read_input);
    png_set_user_limits(png, width, height);
    png_set_chunk_malloc_max(png, 1 << 20);
    png_set_chunk_cache_max(png, 64);
    png_read_info(png, info);
    png_set_expand(png);
    png_set_scale_16(png);
    png_set_strip_alpha(png);
    png_set_gray_to_rgb(png);
    const int passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    if (png_get_rowbytes(png, info) != std::size_t{3} * width)
        png_error(png, "the pixels cannot be turned into 8-bit RGB");
    for (int pass = 0; pass < passes; ++pass)
        for (std::uint32_t row = 0; row < height; ++row) png_read_row(png, rgb + std::size_t{3} * width * row, nullptr);
    // Chunks behind the pixels are text and times; a file that was cut there still has its picture.
    png_destroy_read_struct(&png, &info, nullptr);
    return true;
}

/// A file cut behind its pixels can be decoded, but is no PNG to others.
bool ends_as_png(std::span<const std::uint8_t> bytes) {
    static constexpr std::array<std::uint8_t, 12> last_chunk = {0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xAE, 0x42, 0x60, 0x82};
    return bytes.size() >= last_chunk.size() &&
           std::equal(last_chunk.begin(), last_chunk.end(), bytes.end() - last_chunk.size());
}

bool encode_rows(std::vector<std::uint8_t>& bytes, PngState& state, const Image& image) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &state, on_error, on_warning);
    if (!png) return false;
    png_infop info = png_create_info_struct(png);
    if (!info || setjmp(state.jump) != 0) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_set_write_fn(png, &bytes, append_output, nullptr);
    // Against libpng's defaults: a shaded face of 960 x 520 in 14 instead of 63 ms, a noisy texture of 1600 x 1200 in
    // 140 instead of 1660 ms, both about 20 % larger.
    png_set_compression_level(png, 2);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB | PNG_FILTER_UP);
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (int row = 0; row < image.height; ++row)
        png_write_row(png, image.rgb.data() +
                               std::size_t{3} * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(row));
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return true;
}

}  // namespace

Image decode_png(std::span<const std::uint8_t> bytes, const std::string& name) {
    const auto header = parse_png_header(bytes, name);
    const std::uint64_t pixels = std::uint64_t{header.width} * header.height;
    // One bit is the least that a pixel has before compression.
    if (pixels / 8 > best_deflate_ratio * bytes.size())
        throw InputError(
            fmt::format("{}: width x height is {} x {}, but the file has only {} bytes; it is truncated or damaged",
                        name, header.width, header.height, bytes.size()));
    Image image;
    image.width = static_cast<int>(header.width);
    image.height = static_cast<int>(header.height);
    image.rgb.resize(3 * pixels);
    Input input{bytes.data(), bytes.size(), 0};
    PngState state;
    if (!decode_rows(input, state, header.width, header.height, image.rgb.data()))
        throw InputError(
            fmt::format("{}: the PNG cannot be decoded ({}); it is truncated or damaged", name, state.message));
    return image;
}

Image read_png(const std::filesystem::path& file) { return decode_png(base::read_bytes(file), file.string()); }

std::vector<std::uint8_t> encode_png(const Image& image) {
    const auto size = std::int64_t{3} * image.width * image.height;
    if (image.width <= 0 || image.height <= 0 || size != static_cast<std::int64_t>(image.rgb.size()))
        throw InputError(
            fmt::format("an image of {} x {} pixels with {} bytes cannot be written; it needs 3 bytes a pixel",
                        image.width, image.height, image.rgb.size()));
    std::vector<std::uint8_t> bytes;
    PngState state;
    if (!encode_rows(bytes, state, image))
        throw InputError(fmt::format("an image of {} x {} pixels cannot be written as PNG ({})", image.width,
                                     image.height, state.message));
    return bytes;
}

void write_png(const std::filesystem::path& file, const Image& image) {
    const auto bytes = encode_png(image);
    base::write_atomically(file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

std::string_view image_kind(std::span<const std::uint8_t> bytes) {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 15> beginnings = {
        {{"\x89PNG\r\n\x1A\n", "PNG"},
         {"\xFF\xD8\xFF", "JPEG"},
         {"BM", "BMP"},
         {std::string_view("II*\0", 4), "TIFF"},
         {std::string_view("MM\0*", 4), "TIFF"},
         {std::string_view("II+\0", 4), "TIFF"},
         {"GIF87a", "GIF"},
         {"GIF89a", "GIF"},
         {"\x76\x2F\x31\x01", "OpenEXR"},
         {"8BPS", "Photoshop"},
         {"DDS ", "DDS"},
         {std::string_view("\0\0\0\x0CjP  ", 8), "JPEG 2000"},
         {std::string_view("\xFF\x4F\xFF\x51", 4), "JPEG 2000"},
         {"\x59\xA6\x6A\x95", "Sun raster"},
         {"#?RADIANCE", "HDR"}}};
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("RIFF") && text.size() >= 12 && text.substr(8, 4) == "WEBP") return "WebP";
    constexpr std::array netpbm = {"PBM", "PGM", "PPM", "PBM", "PGM", "PPM", "PAM"};
    if (text.size() > 2 && text[0] == 'P' && text[1] >= '1' && text[1] <= '7' &&
        std::string_view(" \t\r\n").find(text[2]) != std::string_view::npos)
        return netpbm[static_cast<std::size_t>(text[1] - '1')];
    for (const auto& [beginning, kind] : beginnings)
        if (text.starts_with(beginning)) return kind;
    return {};
}

Image decode_image(std::span<const std::uint8_t> bytes, const std::string& name) {
    const auto kind = image_kind(bytes);
    if (kind == "JPEG") return decode_jpeg(bytes, name);
    if (kind == "PNG") return decode_png(bytes, name);
    if (kind == "BMP" && !is_run_length_bmp(bytes)) return decode_bmp(bytes, name);
    if (!kind.empty()) {
        if (auto image = decode_with_opencv(bytes, name)) return *std::move(image);
        throw InputError(
            fmt::format("{}: is a {} image, which is not read; save it as PNG or JPEG, or install "
                        "libopencv-dev and build mimik-opencv, which reads it",
                        name, kind == "BMP" ? "compressed BMP" : kind));
    }
    throw InputError(fmt::format("{}: is neither a PNG, a JPEG nor a BMP image; save it as PNG", name));
}

Image read_image(const std::filesystem::path& file) { return decode_image(base::read_bytes(file), file.string()); }

std::array<int, 2> image_size(const std::filesystem::path& file) {
    const auto text = base::read_text_head(file, 64);
    const std::span head(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    const auto kind = image_kind(head);
    if (kind == "JPEG") return jpeg_size(base::read_bytes(file), file.string());  // may stand behind a thumbnail
    if (kind == "BMP") return bmp_size(head, file.string());
    if (kind != "PNG") {
        const auto image = read_image(file);  // or it says what it is
        return {image.width, image.height};
    }
    const auto header = parse_png_header(head, file.string());
    return {static_cast<int>(header.width), static_cast<int>(header.height)};
}

std::vector<std::uint8_t> read_as_png(const std::filesystem::path& file) {
    auto bytes = base::read_bytes(file);
    const auto image = decode_image(bytes, file.string());
    return image_kind(bytes) == "PNG" && ends_as_png(bytes) ? bytes : encode_png(image);
}

void check_is_image(std::span<const std::uint8_t> bytes, const std::string& name) {
    const auto kind = image_kind(bytes);
    if (kind.empty() || kind == "PNG" || kind == "JPEG" || kind == "BMP") (void)decode_image(bytes, name);
}

}  // namespace mimik::io
