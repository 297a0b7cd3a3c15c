#include "io/jpeg.h"

#include <csetjmp>
#include <cstdio>  // jpeglib.h needs it
#include <cstring>

#include <fmt/format.h>
#include <jerror.h>
#include <jpeglib.h>

#include "base/errors.h"

namespace mimik::io {
namespace {

constexpr std::uint64_t most_pixels = 100'000'000;
// An empty block of 64 pixels takes four bits or more, and colour may be stored at a quarter of the size.
constexpr std::uint64_t most_pixels_per_byte = 256;
constexpr long most_memory = 512L << 20;
constexpr int most_passes = 500;  // a progressive file may refine the same image without end

/// libjpeg reports errors by a call that must not return; it is left by a jump, so everything that lives across one is
/// plain data.
struct State {
    jpeg_error_mgr errors;  // first: libjpeg hands back a pointer to it
    jpeg_progress_mgr progress;
    std::jmp_buf jump;
    char message[JMSG_LENGTH_MAX] = {};
};

[[noreturn]] void on_error(j_common_ptr info) {
    auto* state = reinterpret_cast<State*>(info->err);
    info->err->format_message(info, state->message);
    std::longjmp(state->jump, 1);
}

/// libjpeg fills what is missing with grey and says so only here.
void on_message(j_common_ptr info, int level) {
    if (level < 0 && info->err->msg_code == JWRN_JPEG_EOF) on_error(info);
}

void on_progress(j_common_ptr info) {
    if (reinterpret_cast<j_decompress_ptr>(info)->input_scan_number <= most_passes) return;
    auto* state = reinterpret_cast<State*>(info->err);
    std::strcpy(state->message, "more than 500 passes over the image");
    std::longjmp(state->jump, 1);
}

void begin(jpeg_decompress_struct& info, State& state, std::span<const std::uint8_t> bytes) {
    info.err = jpeg_std_error(&state.errors);
    state.errors.error_exit = on_error;
    state.errors.emit_message = on_message;
    jpeg_create_decompress(&info);
    info.mem->max_memory_to_use = most_memory;
    state.progress.progress_monitor = on_progress;
    info.progress = &state.progress;
    jpeg_mem_src(&info, bytes.data(), bytes.size());
}

/// No object with a destructor may live in these two: errors jump out of libjpeg.
bool read_header(State& state, std::span<const std::uint8_t> bytes, std::array<int, 2>& size) {
    jpeg_decompress_struct info;
    std::memset(&info, 0, sizeof info);  // destroying what was never created is allowed then
    if (setjmp(state.jump) != 0) {
        jpeg_destroy_decompress(&info);
        return false;
    }
    begin(info, state, bytes);
    jpeg_read_header(&info, TRUE);
    size = {static_cast<int>(info.image_width), static_cast<int>(info.image_height)};
    jpeg_destroy_decompress(&info);
    return true;
}

/// Four inks as light. Adobe's programs, and most others after them, store how much paper is left of each.
void light_of_inks(const JSAMPLE* inks, bool stored_as_paper, JDIMENSION width, std::uint8_t* rgb) {
    for (JDIMENSION i = 0; i < width; ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const unsigned ink = inks[std::size_t{4} * i + c], black = inks[std::size_t{4} * i + 3];
            const unsigned light = stored_as_paper ? ink * black : (255 - ink) * (255 - black);
            rgb[std::size_t{3} * i + c] = static_cast<std::uint8_t>((light + 127) / 255);
        }
}

bool read_pixels(State& state, std::span<const std::uint8_t> bytes, std::uint8_t* rgb) {
    jpeg_decompress_struct info;
    std::memset(&info, 0, sizeof info);
    if (setjmp(state.jump) != 0) {
        jpeg_destroy_decompress(&info);
        return false;
    }
    begin(info, state, bytes);
    jpeg_read_header(&info, TRUE);
    const bool inks = info.jpeg_color_space == JCS_CMYK || info.jpeg_color_space == JCS_YCCK;
    const bool stored_as_paper = info.saw_Adobe_marker != 0;
    info.out_color_space = inks ? JCS_CMYK : JCS_RGB;
    jpeg_start_decompress(&info);
    JSAMPARRAY ink_row = nullptr;  // belongs to libjpeg
    if (inks)
        ink_row = info.mem->alloc_sarray(reinterpret_cast<j_common_ptr>(&info), JPOOL_IMAGE, 4 * info.output_width, 1);
    while (info.output_scanline < info.output_height) {
        JSAMPROW row = rgb + std::size_t{3} * info.output_width * info.output_scanline;
        jpeg_read_scanlines(&info, inks ? ink_row : &row, 1);
        if (inks) light_of_inks(ink_row[0], stored_as_paper, info.output_width, row);
    }
    jpeg_destroy_decompress(&info);
    return true;
}

[[noreturn]] void refuse(const std::string& name, const State& state) {
    if (state.errors.msg_code == JERR_CONVERSION_NOTIMPL)
        throw InputError(
            fmt::format("{}: the JPEG's colours are neither RGB, grey nor CMYK; save it as RGB or PNG", name));
    throw InputError(fmt::format("{}: the JPEG cannot be decoded ({}); it is truncated or damaged: save it anew", name,
                                 state.message));
}

}  // namespace

bool is_jpeg(std::span<const std::uint8_t> bytes) {
    return bytes.size() >= 3 && bytes[0] == 0xFF && bytes[1] == 0xD8 && bytes[2] == 0xFF;
}

std::array<int, 2> jpeg_size(std::span<const std::uint8_t> bytes, const std::string& name) {
    State state{};
    std::array<int, 2> size{};
    if (!read_header(state, bytes, size)) refuse(name, state);
    return size;
}

Image decode_jpeg(std::span<const std::uint8_t> bytes, const std::string& name) {
    const auto [width, height] = jpeg_size(bytes, name);
    const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    if (pixels > most_pixels)
        throw InputError(
            fmt::format("{}: width x height is {} x {}, more than the {} million pixels that are read; scale it "
                        "down",
                        name, width, height, most_pixels / 1'000'000));
    if (pixels > most_pixels_per_byte * bytes.size())
        throw InputError(
            fmt::format("{}: width x height is {} x {}, but the file has only {} bytes; it is truncated or damaged",
                        name, width, height, bytes.size()));
    Image image{width, height, {}};
    image.rgb.resize(3 * pixels);
    State state{};
    if (!read_pixels(state, bytes, image.rgb.data())) refuse(name, state);
    return image;
}

}  // namespace mimik::io
