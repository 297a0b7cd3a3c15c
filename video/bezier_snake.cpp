#include "video/bezier_snake.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "base/errors.h"

namespace mimik::video {
namespace {

/// The middle control points move by 4/3 of what the middle of the curve is to move: 3/4 of its weight is theirs.
constexpr double middle_share = 0.75;

Pixel gradient_at(const FloatImage& image, const Pixel& at) {
    return 0.5 * Pixel(image.sample(at + Pixel(1, 0)) - image.sample(at - Pixel(1, 0)),
                       image.sample(at + Pixel(0, 1)) - image.sample(at - Pixel(0, 1)));
}

struct Sample {
    std::array<double, 4> b;
    double shift;  ///< of an offset curve there, as a share of its shift in the middle
};
std::vector<Sample> samples_of(int count) {
    std::vector<Sample> samples;
    for (int k = 0; k < count; ++k) {
        Sample sample{bernstein((k + 0.5) / count), 0};
        sample.shift = (sample.b[1] + sample.b[2]) / middle_share;
        samples.push_back(sample);
    }
    return samples;
}

class Descent {
public:
    Descent(const SnakeGroup& start, const SnakeLevel& level, const SnakeOptions& options)
        : start_(start.points), level_(level), options_(options), samples_(samples_of(options.samples)) {}

    [[nodiscard]] double energy(const SnakeGroup& group) const {
        double sum = 0;
        for (const auto& member : group.curves) {
            double along = 0;
            for (const auto& sample : samples_) {
                const Pixel at = place(group, member, sample), off = offset(member, sample);
                along += options_.outside * level_.intensity.sample(at - off) -
                         options_.inside * level_.intensity.sample(at + off) - options_.edge * level_.edge.sample(at);
            }
            sum += along / static_cast<double>(samples_.size());
            for (const bool last : {false, true}) {
                const auto [from, way] = cap(group, member, last);
                sum += 0.5 * options_.cap * (level_.intensity.sample(from + way) - level_.intensity.sample(from - way));
            }
        }
        return sum / static_cast<double>(group.curves.size()) + stay(group);
    }

    [[nodiscard]] std::vector<Pixel> gradient(const SnakeGroup& group) const {
        std::vector<Pixel> sum(group.points.size(), Pixel::Zero());
        const double share = 1.0 / (static_cast<double>(samples_.size()) * static_cast<double>(group.curves.size()));
        for (const auto& member : group.curves)
            for (const auto& sample : samples_) {
                const Pixel at = place(group, member, sample), off = offset(member, sample);
                const Pixel force = options_.outside * gradient_at(level_.intensity, at - off) -
                                    options_.inside * gradient_at(level_.intensity, at + off) -
                                    options_.edge * gradient_at(level_.edge, at);
                for (std::size_t k = 0; k < 4; ++k) sum[member.point[k]] += share * sample.b[k] * force;
            }
        for (const auto& member : group.curves)
            for (const bool last : {false, true}) {
                const auto [from, way] = cap(group, member, last);
                sum[member.point[last ? 3 : 0]] +=
                    0.5 * options_.cap / static_cast<double>(group.curves.size()) *
                    (gradient_at(level_.intensity, from + way) - gradient_at(level_.intensity, from - way));
            }
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += 2 * stay_weight() * (group.points[k] - start_[k]);
        return sum;
    }

private:
    [[nodiscard]] static Pixel place(const SnakeGroup& group, const SnakeGroup::Member& member, const Sample& sample) {
        Pixel at = Pixel::Zero();
        for (std::size_t k = 0; k < 4; ++k) at += sample.b[k] * group.points[member.point[k]];
        return at;
    }
    [[nodiscard]] Pixel offset(const SnakeGroup::Member& member, const Sample& sample) const {
        return {0, member.inside * sample.shift * options_.offset_px};
    }
    /// An end of a curve, and the way beyond it.
    [[nodiscard]] std::pair<Pixel, Pixel> cap(const SnakeGroup& group, const SnakeGroup::Member& member,
                                              bool last) const {
        const Pixel end = group.points[member.point[last ? 3 : 0]];
        const Pixel chord = group.points[member.point[3]] - group.points[member.point[0]];
        const double length = chord.norm();
        const Pixel way = length > 0 ? Pixel((last ? 1 : -1) * options_.offset_px / length * chord) : Pixel::Zero();
        return {end, way};
    }
    [[nodiscard]] double stay_weight() const {
        return options_.stay / (options_.offset_px * options_.offset_px * static_cast<double>(start_.size()));
    }
    [[nodiscard]] double stay(const SnakeGroup& group) const {
        double sum = 0;
        for (std::size_t k = 0; k < start_.size(); ++k) sum += (group.points[k] - start_[k]).squaredNorm();
        return stay_weight() * sum;
    }

    std::vector<Pixel> start_;
    const SnakeLevel& level_;
    const SnakeOptions& options_;
    std::vector<Sample> samples_;
};

/// What is left of a step when points keep their places along the curves: up and down each for itself, sideways and in
/// width all together.
void make_upright(const std::vector<Pixel>& points, bool widen, std::vector<Pixel>& ways) {
    double middle = 0, shift = 0, stretch = 0, spread = 0;
    const auto count = static_cast<double>(points.size());
    for (const auto& p : points) middle += p.x() / count;
    for (const auto& w : ways) shift += w.x() / count;
    for (std::size_t k = 0; k < points.size(); ++k) {
        stretch += ways[k].x() * (points[k].x() - middle);
        spread += (points[k].x() - middle) * (points[k].x() - middle);
    }
    stretch = widen && spread > 0 ? stretch / spread : 0;
    for (std::size_t k = 0; k < points.size(); ++k) ways[k].x() = shift + stretch * (points[k].x() - middle);
}

double longest(const std::vector<Pixel>& ways) {
    double most = 0;
    for (const auto& way : ways) most = std::max(most, way.norm());
    return most;
}

}  // namespace

void SnakeOptions::check() const {
    const auto least = [](const char* name, double value, double from) {
        if (!(value >= from)) throw InputError(fmt::format("{} is {}; give {} or more", name, value, from));
    };
    least("edge", edge, 0);
    least("inside", inside, 0);
    least("outside", outside, 0);
    least("offset_px", offset_px, 0.1);
    least("stay", stay, 0);
    least("cap", cap, 0);
    least("samples", samples, 2);
    least("steps", steps, 0);
}

std::vector<SnakeLevel> snake_levels(const FloatImage& image, std::span<const double> blurs_px) {
    std::vector<SnakeLevel> levels;
    const cv::Mat from(image.height, image.width, CV_32FC1, const_cast<float*>(image.values.data()));  // NOLINT
    for (const double blur : blurs_px) {
        SnakeLevel level{FloatImage(image.width, image.height), FloatImage(image.width, image.height)};
        cv::Mat smooth(image.height, image.width, CV_32FC1, level.intensity.values.data());
        cv::Mat edge(image.height, image.width, CV_32FC1, level.edge.values.data()), across, down;
        if (blur > 0) {
            // 2.5 standard deviations to each side; OpenCV would take 4.
            const int size = 2 * static_cast<int>(std::ceil(2.5 * blur)) + 1;
            cv::GaussianBlur(from, smooth, cv::Size(size, size), blur, blur, cv::BORDER_REPLICATE);
        } else
            from.copyTo(smooth);
        cv::Sobel(smooth, across, CV_32F, 1, 0, 3, 1.0 / 8, 0, cv::BORDER_REPLICATE);
        cv::Sobel(smooth, down, CV_32F, 0, 1, 3, 1.0 / 8, 0, cv::BORDER_REPLICATE);
        // A wider blur makes every edge weaker by about its width; so that levels weigh alike, that is undone.
        const double scale = (1 + blur) * (1 + blur);
        edge = scale * (across.mul(across) + down.mul(down));
        levels.push_back(std::move(level));
    }
    return levels;
}

BezierCurve SnakeGroup::curve(std::size_t member) const {
    BezierCurve made;
    for (std::size_t k = 0; k < 4; ++k) made.control[k] = points[curves[member].point[k]];
    return made;
}

double snake_energy(const SnakeGroup& group, const SnakeLevel& level, const SnakeOptions& options) {
    return Descent(group, level, options).energy(group);
}

double snake_contrast(const BezierCurve& curve, double inside, const FloatImage& intensity, double offset_px) {
    constexpr int count = 9;
    double sum = 0;
    for (const auto& sample : samples_of(count)) {
        Pixel at = Pixel::Zero();
        for (std::size_t k = 0; k < 4; ++k) at += sample.b[k] * curve.control[k];
        const Pixel off(0, inside * sample.shift * offset_px);
        sum += intensity.sample(at + off) - intensity.sample(at - off);
    }
    return sum / count;
}

double minimise_snake(SnakeGroup& group, std::span<const SnakeLevel> levels, const SnakeOptions& options) {
    const SnakeGroup start = group;
    double energy = 0;
    for (const auto& level : levels) {
        const Descent descent(start, level, options);
        energy = descent.energy(group);
        double step_px = 1.5;
        for (int s = 0; s < options.steps && step_px > 0.03; ++s) {
            auto down = descent.gradient(group);
            if (options.upright) make_upright(group.points, options.widen, down);
            const double most = longest(down);
            if (!(most > 1e-9)) break;
            SnakeGroup tried = group;
            for (std::size_t k = 0; k < tried.points.size(); ++k) tried.points[k] -= step_px / most * down[k];
            const double now = descent.energy(tried);
            if (now < energy) {
                group = std::move(tried);
                energy = now;
                step_px = std::min(1.5, 1.2 * step_px);
            } else {
                step_px *= 0.5;
            }
        }
    }
    return energy;
}

}  // namespace mimik::video
