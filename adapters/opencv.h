#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

#include "adapters/remarks.h"
#include "base/text.h"
#include "geometry/range_scan.h"
#include "io/image.h"

namespace mimik::adapters {

/// A range image of Mimik's scan: CV_64FC3, one (x, y, z) in millimetres per lattice point, NaN in all three where
/// nothing was measured. OpenCV's row 0 is the top of an image, Mimik's the chin side: rows are turned over,
/// coordinates are not touched. Texture coordinates are left out with a remark.
/// @throws InputError if the scan is not organised.
[[nodiscard]] inline cv::Mat to_opencv(const geometry::RangeScan& scan, Remarks& remarks) {
    if (!scan.organised())
        throw InputError("cv::Mat: a range image needs a scan on a lattice; this one has " +
                         std::to_string(scan.points_mm.size()) + " points in no order: take its grid");
    cv::Mat image(scan.rows, scan.cols, CV_64FC3);
    for (int row = 0; row < scan.rows; ++row)
        for (int col = 0; col < scan.cols; ++col) {
            const auto index =
                static_cast<std::size_t>(row) * static_cast<std::size_t>(scan.cols) + static_cast<std::size_t>(col);
            const auto& p = scan.points_mm[index];
            image.at<cv::Vec3d>(scan.rows - 1 - row, col) = cv::Vec3d(p.x(), p.y(), p.z());
        }
    if (!scan.texture_coordinates.empty())
        remarks.push_back(
            base::counted(scan.texture_coordinates.size(), "texture coordinate is", "texture coordinates are") +
            " left out: a range image holds none");
    return image;
}

/// Mimik's scan of a range image, CV_64FC3 or CV_32FC3 (x, y, z in millimetres, row 0 at the top). A point with one
/// coordinate that is not finite was not measured; where only some of the three are so, a remark counts them.
/// @throws InputError if the image is empty or of another type.
[[nodiscard]] inline geometry::RangeScan range_scan_from(const cv::Mat& image, Remarks& remarks) {
    if (image.empty() || image.dims != 2 || (image.type() != CV_64FC3 && image.type() != CV_32FC3))
        throw InputError("cv::Mat: a range image is CV_64FC3 or CV_32FC3 with x, y, z in millimetres; this one is " +
                         std::to_string(image.rows) + " x " + std::to_string(image.cols) + " of " +
                         std::to_string(image.channels()) + " channels, depth " + std::to_string(image.depth()) +
                         "; use convertTo() and merge()");
    geometry::RangeScan scan;
    scan.rows = image.rows;
    scan.cols = image.cols;
    std::size_t torn = 0;
    for (int row = image.rows - 1; row >= 0; --row)
        for (int col = 0; col < image.cols; ++col) {
            const cv::Vec3d p =
                image.type() == CV_64FC3 ? image.at<cv::Vec3d>(row, col) : cv::Vec3d(image.at<cv::Vec3f>(row, col));
            scan.points_mm.emplace_back(p[0], p[1], p[2]);
            auto& point = scan.points_mm.back();
            if (point.allFinite()) continue;
            if (!point.array().isNaN().all()) ++torn;
            point.setConstant(std::numeric_limits<double>::quiet_NaN());
        }
    if (torn > 0)
        remarks.push_back(base::counted(torn, "point with some finite coordinates counts",
                                        "points with some finite coordinates count") +
                          " as not measured");
    return scan;
}

/// OpenCV's image (CV_8UC3, blue first) of Mimik's texture.
[[nodiscard]] inline cv::Mat to_opencv(const io::Image& image) {
    cv::Mat result(image.height, image.width, CV_8UC3);
    for (int row = 0; row < image.height; ++row)
        for (int col = 0; col < image.width; ++col) {
            const auto* rgb =
                image.rgb.data() + (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                                    static_cast<std::size_t>(col)) *
                                       3;
            result.at<cv::Vec3b>(row, col) = cv::Vec3b(rgb[2], rgb[1], rgb[0]);
        }
    return result;
}

/// Mimik's texture of OpenCV's image: CV_8UC3 (blue first, as imread gives it), CV_8UC1 (grey becomes RGB) or CV_8UC4,
/// whose transparency is left out with a remark if there is any.
/// @throws InputError if the image is empty or not of bytes.
[[nodiscard]] inline io::Image image_from(const cv::Mat& image, Remarks& remarks) {
    const int channels = image.channels();
    if (image.empty() || image.dims != 2 || image.depth() != CV_8U || channels == 2 || channels > 4)
        throw InputError("cv::Mat: a texture has 8 bits and 1, 3 or 4 channels; this one has depth " +
                         std::to_string(image.depth()) + " and " + std::to_string(channels) +
                         " channels: use convertTo(), of 16 bits with the factor 1 / 257");
    io::Image result{image.cols, image.rows, {}};
    std::size_t transparent = 0;
    for (int row = 0; row < image.rows; ++row) {
        const std::uint8_t* pixel = image.ptr<std::uint8_t>(row);
        for (int col = 0; col < image.cols; ++col, pixel += channels) {
            for (const int channel : {2, 1, 0}) result.rgb.push_back(pixel[channels == 1 ? 0 : channel]);
            if (channels == 4 && pixel[3] != 255) ++transparent;
        }
    }
    if (transparent > 0) remarks.push_back("transparency of " + base::counted(transparent, "pixel") + " is left out");
    return result;
}

}  // namespace mimik::adapters
