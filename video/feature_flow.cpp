#include "video/feature_flow.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "base/errors.h"

namespace mimik::video {

void FlowOptions::check() const {
    if (window_px < 3 || window_px > 63) throw InputError(fmt::format("window_px is {}; give 3 to 63", window_px));
    if (levels < 1 || levels > 8) throw InputError(fmt::format("levels is {}; give 1 to 8", levels));
    if (!(forth_back_px > 0)) throw InputError(fmt::format("forth_back_px is {}; give more than 0", forth_back_px));
}

std::vector<FlowedPoint> flow_points(std::span<const std::uint8_t> from, std::span<const std::uint8_t> to, int width,
                                     int height, std::span<const Pixel> points, const FlowOptions& options) {
    options.check();
    std::vector<FlowedPoint> flowed(points.size());
    if (points.empty()) return flowed;
    const auto matrix = [&](std::span<const std::uint8_t> bytes) {
        return cv::Mat(height, width, CV_8UC1, const_cast<std::uint8_t*>(bytes.data()));  // NOLINT: only read
    };
    const cv::Size window(options.window_px, options.window_px);
    std::vector<cv::Mat> before, after;
    cv::buildOpticalFlowPyramid(matrix(from), before, window, options.levels - 1);
    cv::buildOpticalFlowPyramid(matrix(to), after, window, options.levels - 1);
    std::vector<cv::Point2f> start, forth, back;
    for (const auto& p : points) start.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
    std::vector<std::uint8_t> seen_forth, seen_back;
    const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 12, 0.02);
    cv::calcOpticalFlowPyrLK(before, after, start, forth, seen_forth, cv::noArray(), window, options.levels - 1, until);
    back = start;
    cv::calcOpticalFlowPyrLK(after, before, forth, back, seen_back, cv::noArray(), window, options.levels - 1, until,
                             cv::OPTFLOW_USE_INITIAL_FLOW);
    for (std::size_t k = 0; k < points.size(); ++k) {
        flowed[k].at = {forth[k].x, forth[k].y};
        flowed[k].followed = seen_forth[k] && seen_back[k] && cv::norm(back[k] - start[k]) < options.forth_back_px &&
                             forth[k].x >= 0 && forth[k].y >= 0 && forth[k].x < static_cast<float>(width) &&
                             forth[k].y < static_cast<float>(height);
        if (!flowed[k].followed) flowed[k].at = points[k];
    }
    return flowed;
}

PlaneSimilarity fit_similarity(std::span<const Pixel> from, std::span<const Pixel> to, double tolerance_px) {
    PlaneSimilarity fit;
    const std::size_t count = std::min(from.size(), to.size());
    if (count < 3) return fit;
    // The start that outliers cannot pull: the median shift.
    const auto median_shift = [&](int axis) {
        std::vector<double> shifts(count);
        for (std::size_t k = 0; k < count; ++k) shifts[k] = to[k][axis] - from[k][axis];
        std::nth_element(shifts.begin(), shifts.begin() + static_cast<std::ptrdiff_t>(count / 2), shifts.end());
        return shifts[count / 2];
    };
    fit.shift = {median_shift(0), median_shift(1)};
    double reach = 6 * tolerance_px;
    for (int round = 0; round < 8; ++round, reach = std::max(tolerance_px, 0.6 * reach)) {
        double sum = 0, squares = 0, along = 0, across = 0;
        Pixel from_middle = Pixel::Zero(), to_middle = Pixel::Zero();
        std::vector<double> weights(count);
        for (std::size_t k = 0; k < count; ++k) {
            const double away = (fit(from[k]) - to[k]).norm() / reach;
            weights[k] = 1 / (1 + away * away * away * away);
            sum += weights[k];
            from_middle += weights[k] * from[k];
            to_middle += weights[k] * to[k];
        }
        from_middle /= sum;
        to_middle /= sum;
        for (std::size_t k = 0; k < count; ++k) {
            const Pixel p = from[k] - from_middle, q = to[k] - to_middle;
            squares += weights[k] * p.squaredNorm();
            along += weights[k] * p.dot(q);
            across += weights[k] * (p.x() * q.y() - p.y() * q.x());
        }
        if (!(squares > 0)) return fit;
        fit.scale_turn << along / squares, -across / squares, across / squares, along / squares;
        fit.shift = to_middle - fit.scale_turn * from_middle;
    }
    for (std::size_t k = 0; k < count; ++k)
        fit.inliers += (fit(from[k]) - to[k]).norm() < tolerance_px ? 1.0 / static_cast<double>(count) : 0.0;
    return fit;
}

}  // namespace mimik::video
