#include "database/self_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/text.h"
#include "geometry/statistics.h"
#include "geometry/types.h"

namespace mimik::database {
namespace {

geometry::TextureCoordinate turned(const geometry::TextureCoordinate& t, TextureAxes axes) {
    switch (axes) {
        case TextureAxes::u_right_v_up:
            return t;
        case TextureAxes::u_right_v_down:
            return {t.x(), 1 - t.y()};
        case TextureAxes::u_down_v_left:
            return {1 - t.y(), 1 - t.x()};
        case TextureAxes::u_up_v_left:
            return {1 - t.y(), t.x()};
    }
    return t;
}

/// Pearson's correlation in one pass; the first pair is subtracted so that sums keep their digits.
class Correlation {
public:
    void add(double a, double b) {
        if (count_++ == 0) {
            first_a_ = a;
            first_b_ = b;
        }
        a -= first_a_;
        b -= first_b_;
        a_ += a;
        b_ += b;
        aa_ += a * a;
        bb_ += b * b;
        ab_ += a * b;
    }
    [[nodiscard]] std::optional<double> value() const {
        const auto n = static_cast<double>(count_);
        const double variance_a = n * aa_ - a_ * a_, variance_b = n * bb_ - b_ * b_;
        if (count_ < 3 || variance_a <= 0 || variance_b <= 0) return std::nullopt;
        return (n * ab_ - a_ * b_) / std::sqrt(variance_a * variance_b);
    }

private:
    std::size_t count_ = 0;
    double first_a_ = 0, first_b_ = 0, a_ = 0, b_ = 0, aa_ = 0, bb_ = 0, ab_ = 0;
};

}  // namespace

std::string to_string(TextureAxes axes, bool v_from_top) {
    switch (axes) {
        case TextureAxes::u_right_v_up:
            return v_from_top ? "u to the right, v down" : "u to the right, v up";
        case TextureAxes::u_right_v_down:
            return v_from_top ? "u to the right, v up" : "u to the right, v down";
        case TextureAxes::u_down_v_left:
            return v_from_top ? "u down, v to the right" : "u down, v to the left";
        case TextureAxes::u_up_v_left:
            return v_from_top ? "u up, v to the right" : "u up, v to the left";
    }
    return "";
}

// A tree does not pay for two dozen queries. NaN points win no comparison.
std::vector<NearestScanPoint> nearest_scan_points(const geometry::RangeScan& scan,
                                                  const geometry::Landmarks& landmarks) {
    std::vector<NearestScanPoint> result;
    result.reserve(landmarks.size());
    for (const auto& mark : landmarks.all()) {
        NearestScanPoint nearest{0, std::numeric_limits<double>::infinity()};
        for (std::size_t i = 0; i < scan.points_mm.size(); ++i) {
            // Most points fall at the first coordinate.
            const double dx = scan.points_mm[i].x() - mark.position_mm.x();
            if (!(dx * dx < nearest.distance_mm)) continue;
            const double squared = (scan.points_mm[i] - mark.position_mm).squaredNorm();
            if (squared < nearest.distance_mm) nearest = {i, squared};
        }
        nearest.distance_mm = std::sqrt(nearest.distance_mm);
        result.push_back(nearest);
    }
    return result;
}

std::optional<TextureOrientation> texture_orientation(const geometry::RangeScan& scan,
                                                      const geometry::Landmarks& landmarks,
                                                      const std::vector<NearestScanPoint>& nearest,
                                                      const std::vector<ImageLandmark>& image_landmarks,
                                                      std::array<int, 2> image_size) {
    if (scan.texture_coordinates.empty() || image_size[0] <= 0 || image_size[1] <= 0) return std::nullopt;
    const double width = image_size[0], height = image_size[1];
    std::array<std::vector<double>, 4> errors;
    for (std::size_t m = 0; m < landmarks.size(); ++m) {
        const auto& mark = landmarks.all()[m];
        const std::string& label = mark.original_label.empty() ? mark.name : mark.original_label;
        const auto partner =
            std::find_if(image_landmarks.begin(), image_landmarks.end(), [&](const ImageLandmark& other) {
                return base::equal_ignoring_case(base::trimmed(other.label), base::trimmed(label));
            });
        if (partner == image_landmarks.end()) continue;
        if (!std::isfinite(nearest[m].distance_mm)) continue;
        const auto& texture = scan.texture_coordinates[nearest[m].index];
        if (!texture.allFinite()) continue;
        for (std::size_t k = 0; k < 4; ++k) {
            const auto t = turned(texture, static_cast<TextureAxes>(k));
            errors[k].push_back(std::hypot(t.x() * width - partner->column, (1 - t.y()) * height - partner->row));
        }
    }
    if (errors[0].size() < 3) return std::nullopt;
    TextureOrientation result;
    result.landmarks = static_cast<int>(errors[0].size());
    for (std::size_t k = 0; k < 4; ++k) result.median_error_px[k] = geometry::upper_median(errors[k]);
    const auto best =
        static_cast<std::size_t>(std::min_element(result.median_error_px.begin(), result.median_error_px.end()) -
                                 result.median_error_px.begin());
    if (2 * result.median_error_px[best] < result.median_error_px[0]) result.best = static_cast<TextureAxes>(best);
    result.fits = result.median_error_px[static_cast<std::size_t>(result.best)] < 0.03 * std::hypot(width, height);
    return result;
}

std::string texture_charts(const geometry::RangeScan& scan) {
    const auto images = scan.charts ? scan.charts->images.size() : 0;
    if (scan.texture_seam_points == 0 && images < 2) return {};
    std::string what;
    if (images > 1) what = fmt::format("{} images", images);
    if (scan.texture_seam_points > 0)
        what += fmt::format("{}several charts ({} in more than one)", what.empty() ? "" : " and ",
                            base::counted(scan.texture_seam_points, "point lies", "points lie"));
    return fmt::format("its texture has {}: the resampled face gets a picture of its own", what);
}

void reorient_texture(geometry::RangeScan& scan, TextureAxes axes) {
    for (auto& t : scan.texture_coordinates) t = turned(t, axes);
    if (scan.charts)
        for (auto& t : scan.charts->positions) t = turned(t, axes);
}

FrameCorrelations frame_correlations(const geometry::RangeScan& scan) {
    Correlation x_u, y_v, y_row, x_column;
    const bool one_chart = !scan.texture_coordinates.empty() && !scan.charts;  // others lie as they like
    for (std::size_t i = 0; i < scan.points_mm.size(); ++i) {
        if (!scan.valid(i)) continue;
        const auto& p = scan.points_mm[i];
        if (one_chart && scan.texture_coordinates[i].allFinite()) {
            x_u.add(p.x(), scan.texture_coordinates[i].x());
            y_v.add(p.y(), scan.texture_coordinates[i].y());
        }
        if (scan.organised()) {
            const auto cols = static_cast<std::size_t>(scan.cols);
            const std::size_t row = i / cols;
            y_row.add(p.y(), static_cast<double>(row));
            x_column.add(p.x(), static_cast<double>(i % cols));
        }
    }
    return {x_u.value(), y_v.value(), y_row.value(), x_column.value()};
}

}  // namespace mimik::database
