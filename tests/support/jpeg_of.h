#pragma once

#include <cstdio>  // jpeglib.h needs it
#include <cstdlib>
#include <string>
#include <vector>

#include <jpeglib.h>

namespace mimik::test {

/// A JPEG of one colour from libjpeg itself: grey of 120 (1 channel), red 200, green 100, blue 50 (3), or four inks.
inline std::string jpeg_of(int width, int height, int channels, bool progressive = false) {
    jpeg_compress_struct info;
    jpeg_error_mgr errors;
    info.err = jpeg_std_error(&errors);
    jpeg_create_compress(&info);
    unsigned char* buffer = nullptr;
    unsigned long length = 0;
    jpeg_mem_dest(&info, &buffer, &length);
    info.image_width = static_cast<JDIMENSION>(width);
    info.image_height = static_cast<JDIMENSION>(height);
    info.input_components = channels;
    info.in_color_space = channels == 1 ? JCS_GRAYSCALE : (channels == 3 ? JCS_RGB : JCS_CMYK);
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, 95, TRUE);
    if (progressive) jpeg_simple_progression(&info);
    jpeg_start_compress(&info, TRUE);
    std::vector<unsigned char> row;
    for (int col = 0; col < width; ++col)
        for (int channel = 0; channel < channels; ++channel)
            row.push_back(static_cast<unsigned char>(channels == 1 ? 120 : 200 >> channel));
    for (int k = 0; k < height; ++k) {
        JSAMPROW pixels = row.data();
        jpeg_write_scanlines(&info, &pixels, 1);
    }
    jpeg_finish_compress(&info);
    std::string bytes(reinterpret_cast<const char*>(buffer), length);
    jpeg_destroy_compress(&info);
    std::free(buffer);
    return bytes;
}

}  // namespace mimik::test
