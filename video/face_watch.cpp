#include "video/face_watch.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "base/errors.h"
#include "video/picture_memory.h"

namespace mimik::video {
namespace {

constexpr int cell_px = 4;  ///< of the patch: finer detail says nothing of who is there

struct Cells {
    std::vector<float> upper, mouth;
};
Cells cells_of(std::span<const std::uint8_t> grey) {
    const cv::Mat from(patch_height_px, patch_width_px, CV_8UC1, const_cast<std::uint8_t*>(grey.data()));  // NOLINT
    cv::Mat cells;
    cv::resize(from, cells, cv::Size(patch_width_px / cell_px, patch_height_px / cell_px), 0, 0, cv::INTER_AREA);
    Cells made;
    // A box in units of the outer eye corners' distance, from the middle between them.
    const auto take = [&](std::vector<float>& to, double left, double top, double right, double bottom) {
        const Pixel a = patch_from_mean({left, top}) / cell_px, b = patch_from_mean({right, bottom}) / cell_px;
        const int last_row = std::min(cells.rows, static_cast<int>(b.y()));
        const int last_column = std::min(cells.cols, static_cast<int>(b.x()));
        for (int y = std::max(0, static_cast<int>(a.y())); y < last_row; ++y)
            for (int x = std::max(0, static_cast<int>(a.x())); x < last_column; ++x)
                to.push_back(static_cast<float>(cells.at<std::uint8_t>(y, x)));
    };
    take(made.upper, -0.6, -0.38, 0.6, 0.55);
    take(made.mouth, -0.42, 0.58, 0.42, 1.08);
    return made;
}

}  // namespace

bool is_whole_face(const FaceCurves& curves, const FacePlace& place, int width, int height) {
    if (!(place.outer_eyes_px > 8 && place.outer_eyes_px < 2 * width)) return false;
    int outside = 0;
    for (const auto& curve : curves.curve)
        for (const auto& p : curve.control)
            outside += p.x() >= 0 && p.y() >= 0 && p.x() <= width - 1 && p.y() <= height - 1 ? 0 : 1;
    return 10 * outside < static_cast<int>(4 * curve_count);
}

double lip_contrast(const FaceCurves& in_patch, const PatchLevels& levels, const CurveFitOptions& options) {
    const auto& image = levels.feature.back().intensity;
    return 0.5 * (snake_contrast(in_patch[FaceCurve::lip_outer_upper], 1, image, options.snake.offset_px) +
                  snake_contrast(in_patch[FaceCurve::lip_outer_lower], -1, image, options.snake.offset_px));
}

void FaceWatchOptions::check() const {
    const auto share = [](const char* name, double value) {
        if (!(value >= 0 && value <= 1)) throw InputError(fmt::format("{} is {}; give 0 to 1", name, value));
    };
    share("least_alike", least_alike);
    share("least_mouth", least_mouth);
    share("least_lips", least_lips);
    share("newest", newest);
    if (wait_frames < 0) throw InputError(fmt::format("wait_frames is {}; give 0 or more", wait_frames));
}

FaceWatch::FaceWatch(const FaceWatchOptions& options) : options_(options) { options_.check(); }

FaceWatch::Look FaceWatch::look(std::span<const std::uint8_t> patch_grey, double lip_contrast) const {
    if (!knows()) return {};
    const auto cells = cells_of(patch_grey);
    constexpr double least_usual = 0.02;  // lips that never show: nothing is said of them
    return {grey_correlation(cells.upper, upper_), grey_correlation(cells.mouth, mouth_),
            lips_ > least_usual ? lip_contrast / lips_ : 1};
}

void FaceWatch::learn(std::span<const std::uint8_t> patch_grey, double lip_contrast) {
    const auto cells = cells_of(patch_grey);
    was_covered_ = false;
    lost_frames_ = 0;
    if (!knows() || grey_correlation(cells.upper, upper_) < options_.least_alike) {
        upper_ = cells.upper;
        mouth_ = cells.mouth;
        lips_ = lip_contrast;
        return;
    }
    const auto newest = static_cast<float>(options_.newest);
    for (std::size_t k = 0; k < upper_.size(); ++k) upper_[k] += newest * (cells.upper[k] - upper_[k]);
    for (std::size_t k = 0; k < mouth_.size(); ++k) mouth_[k] += newest * (cells.mouth[k] - mouth_[k]);
    lips_ += options_.newest * (lip_contrast - lips_);
}

void FaceWatch::forget() {
    upper_.clear();
    mouth_.clear();
    lips_ = 0;
    was_covered_ = false;
    lost_frames_ = 0;
}

}  // namespace mimik::video
