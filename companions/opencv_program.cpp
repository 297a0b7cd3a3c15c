// mimik-opencv: an image of any format that OpenCV knows, from standard input, as raw RGB on standard output
// (io/opencv_image.cpp). A program, since OpenCV's readers take long to load, and since what a stranger's file does to
// them then ends this program and no other.

#include <cstdint>
#include <cstdio>
#include <exception>
#include <iterator>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sys/resource.h>
#include <unistd.h>

#include "adapters/opencv.h"

namespace {

std::vector<std::uint8_t> standard_input() {
    std::vector<std::uint8_t> bytes;
    std::uint8_t part[1 << 16];
    for (std::size_t got = 0; (got = std::fread(part, 1, sizeof(part), stdin)) > 0;)
        bytes.insert(bytes.end(), part, part + got);
    return bytes;
}

/// A pixel of a texture has 8 bits; where it is a real number nobody says which one is white.
cv::Mat as_bytes(const cv::Mat& image) {
    if (image.depth() == CV_8U) return image;
    if (image.depth() != CV_16U) throw mimik::InputError("its pixels are neither of 8 nor of 16 bits");
    cv::Mat bytes;
    image.convertTo(bytes, CV_8U, 1 / 257.0);
    return bytes;
}

void decode() {
    const auto input = standard_input();
    // Texture coordinates are those of the pixels as they are stored.
    const auto image = cv::imdecode(input, cv::IMREAD_COLOR | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
    if (image.empty()) throw mimik::InputError("OpenCV cannot decode it");
    mimik::adapters::Remarks remarks;
    const auto texture = mimik::adapters::image_from(as_bytes(image), remarks);
    const std::int32_t size[2] = {texture.width, texture.height};
    std::fwrite(size, sizeof(size), 1, stdout);
    std::fwrite(texture.rgb.data(), 1, texture.rgb.size(), stdout);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw mimik::InputError("no memory for its pixels");
}

/// Nobody waits for ever, and nobody's machine is filled.
void set_limits() {
    const rlimit seconds = {60, 60}, memory = {rlim_t{4} << 30, rlim_t{4} << 30}, no_core = {0, 0};
    ::setrlimit(RLIMIT_CPU, &seconds);
    ::setrlimit(RLIMIT_DATA, &memory);
    ::setrlimit(RLIMIT_CORE, &no_core);
}

}  // namespace

int main() {
    set_limits();
    cv::setNumThreads(1);
    try {
        decode();
        return 0;
    } catch (const cv::Exception& e) {
        std::fputs(e.err.c_str(), stdout);
    } catch (const std::exception& e) {
        std::fputs(e.what(), stdout);
    }
    return 2;
}
