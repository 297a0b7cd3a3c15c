#include "video/face_patch.h"

#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace mimik::video {

double FloatImage::sample(const Pixel& p) const {
    const double x = std::clamp(p.x(), 0.0, width - 1.001), y = std::clamp(p.y(), 0.0, height - 1.001);
    const auto column = static_cast<int>(x), row = static_cast<int>(y);
    const auto fx = static_cast<float>(x - column), fy = static_cast<float>(y - row);
    const float* top = values.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + column;
    const float* bottom = top + width;
    return (1 - fy) * ((1 - fx) * top[0] + fx * top[1]) + fy * ((1 - fx) * bottom[0] + fx * bottom[1]);
}

Pixel patch_from_mean(const Pixel& at) { return patch_outer_eyes_px * at + Pixel(patch_middle_x, patch_middle_y); }

Pixel FacePlace::frame_from_patch(const Pixel& at) const {
    const Pixel p = (at - Pixel(patch_middle_x, patch_middle_y)) * (outer_eyes_px / patch_outer_eyes_px);
    return middle + Eigen::Rotation2Dd(roll_rad) * p;
}

Pixel FacePlace::patch_from_frame(const Pixel& at) const {
    const Pixel p = Eigen::Rotation2Dd(-roll_rad) * Pixel(at - middle);
    return p * (patch_outer_eyes_px / outer_eyes_px) + Pixel(patch_middle_x, patch_middle_y);
}

FacePlace place_between(const Pixel& right_corner, const Pixel& left_corner) {
    const Pixel across = left_corner - right_corner;
    return {0.5 * (left_corner + right_corner), across.norm(), std::atan2(across.y(), across.x())};
}

io::Image cut_patch(const io::Image& frame, const FacePlace& place) {
    const Pixel origin = place.frame_from_patch({0, 0});
    const Pixel along = place.frame_from_patch({1, 0}) - origin, down = place.frame_from_patch({0, 1}) - origin;
    const cv::Matx23d frame_from_patch(along.x(), down.x(), origin.x(), along.y(), down.y(), origin.y());
    io::Image patch;
    patch.width = patch_width_px;
    patch.height = patch_height_px;
    patch.rgb.resize(std::size_t{3} * patch_width_px * patch_height_px);
    // The frame is only read: OpenCV has no matrix of constant bytes.
    const cv::Mat from(frame.height, frame.width, CV_8UC3, const_cast<std::uint8_t*>(frame.rgb.data()));  // NOLINT
    cv::Mat to(patch.height, patch.width, CV_8UC3, patch.rgb.data());
    cv::warpAffine(from, to, frame_from_patch, to.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                   cv::BORDER_REPLICATE);
    return patch;
}

std::vector<std::uint8_t> grey_of(const io::Image& image) {
    std::vector<std::uint8_t> grey(image.rgb.size() / 3);
    const cv::Mat from(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data()));  // NOLINT
    cv::Mat to(image.height, image.width, CV_8UC1, grey.data());
    cv::cvtColor(from, to, cv::COLOR_RGB2GRAY);
    return grey;
}

}  // namespace mimik::video
