#include "video/feature_blobs.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "base/errors.h"

namespace mimik::video {
namespace {

/// Otsu's threshold of values in 0..1: what parts them into two groups with the least spread within.
double otsu(const cv::Mat& values) {
    cv::Mat bytes, unused;
    values.convertTo(bytes, CV_8U, 255);
    return cv::threshold(bytes, unused, 0, 255, cv::THRESH_BINARY | cv::THRESH_OTSU) / 255;
}

/// Pixels that can be reached from seeds over steps of at most `radius_px`, all above the threshold.
cv::Mat grow(const cv::Mat& above, double radius_px) {
    cv::Mat blob = cv::Mat::zeros(above.size(), CV_8U);
    const int reach = static_cast<int>(std::floor(radius_px));
    std::vector<cv::Point> open;
    // Seeds: a sparse lattice of the pixels above the threshold; growing finds what lies between.
    for (int y = 0; y < above.rows; y += 2)
        for (int x = 0; x < above.cols; x += 2)
            if (above.at<std::uint8_t>(y, x)) {
                open.emplace_back(x, y);
                blob.at<std::uint8_t>(y, x) = 255;
            }
    while (!open.empty()) {
        const auto at = open.back();
        open.pop_back();
        for (int dy = -reach; dy <= reach; ++dy)
            for (int dx = -reach; dx <= reach; ++dx) {
                const cv::Point next(at.x + dx, at.y + dy);
                if (dx * dx + dy * dy > radius_px * radius_px || next.x < 0 || next.y < 0 || next.x >= above.cols ||
                    next.y >= above.rows || !above.at<std::uint8_t>(next) || blob.at<std::uint8_t>(next))
                    continue;
                blob.at<std::uint8_t>(next) = 255;
                open.push_back(next);
            }
    }
    return blob;
}

}  // namespace

void BlobOptions::check() const {
    if (!(threshold >= 0 && threshold < 1)) throw InputError(fmt::format("threshold is {}; give 0 to 1", threshold));
    if (!(grow_px >= 1)) throw InputError(fmt::format("grow_px is {}; give 1 or more", grow_px));
    if (!(closing_px >= 0)) throw InputError(fmt::format("closing_px is {}; give 0 or more", closing_px));
    if (!(least_share >= 0)) throw InputError(fmt::format("least_share is {}; give 0 or more", least_share));
}

std::optional<FeatureBlob> feature_blob(const FloatImage& intensity, const BlobBox& within,
                                        const BlobOptions& options) {
    const int left = std::max(0, static_cast<int>(std::ceil(within.left)));
    const int top = std::max(0, static_cast<int>(std::ceil(within.top)));
    const int right = std::min(intensity.width - 1, static_cast<int>(std::floor(within.right)));
    const int bottom = std::min(intensity.height - 1, static_cast<int>(std::floor(within.bottom)));
    if (right - left < 2 || bottom - top < 2) return std::nullopt;
    const cv::Mat whole(intensity.height, intensity.width, CV_32FC1,
                        const_cast<float*>(intensity.values.data()));  // NOLINT: only read
    const cv::Mat part = whole(cv::Rect(left, top, right - left + 1, bottom - top + 1));
    double low = 0, high = 0;
    cv::minMaxLoc(part, &low, &high);
    if (!(high - low > 1e-3)) return std::nullopt;
    const cv::Mat scaled = (part - low) / (high - low);
    const double threshold = options.threshold > 0 ? options.threshold : otsu(scaled);
    const cv::Mat above = scaled > threshold;
    cv::Mat blob = grow(above, options.grow_px);
    if (options.closing_px > 0) {
        const int size = 2 * static_cast<int>(std::lround(options.closing_px)) + 1;
        cv::morphologyEx(blob, blob, cv::MORPH_CLOSE,
                         cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(size, size)));
    }
    cv::Mat labels, statistics, middles;
    const int count = cv::connectedComponentsWithStats(blob, labels, statistics, middles, 8);
    int best = 0;
    for (int k = 1; k < count; ++k)
        if (best == 0 || statistics.at<int>(k, cv::CC_STAT_AREA) > statistics.at<int>(best, cv::CC_STAT_AREA)) best = k;
    if (best == 0) return std::nullopt;
    FeatureBlob found;
    found.area_px = statistics.at<int>(best, cv::CC_STAT_AREA);
    if (found.area_px < options.least_share * static_cast<double>(part.total())) return std::nullopt;
    found.box.left = left + statistics.at<int>(best, cv::CC_STAT_LEFT);
    found.box.top = top + statistics.at<int>(best, cv::CC_STAT_TOP);
    found.box.right = found.box.left + statistics.at<int>(best, cv::CC_STAT_WIDTH) - 1;
    found.box.bottom = found.box.top + statistics.at<int>(best, cv::CC_STAT_HEIGHT) - 1;
    found.middle = {left + middles.at<double>(best, 0), top + middles.at<double>(best, 1)};
    found.threshold = low + threshold * (high - low);
    return found;
}

}  // namespace mimik::video
