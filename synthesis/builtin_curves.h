#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace mimik::synthesis {

/// 0 at and before `from`, 1 at and beyond `to` (which may lie below `from`), C2 in between (quintic).
[[nodiscard]] inline double smooth_step(double from, double to, double x) {
    const double q = (x - from) / (to - from), t = q <= 0 ? 0 : q >= 1 ? 1 : q;
    return t * t * t * (t * (6 * t - 15) + 10);
}

/// exp(-(x / width)^2 / 2).
[[nodiscard]] inline double bell(double x, double width) {
    const double q = x / width;
    return q * q > 26 ? 0 : std::exp(-0.5 * q * q);
}

/// 1 at 0 falling to 0 at |x| = reach with zero slope at both ends: a bell of compact support.
[[nodiscard]] inline double hump(double x, double reach) { return 1 - smooth_step(0, reach, std::abs(x)); }

/// As hump, but 1 up to |x| = `core`: what lies within moves as one.
[[nodiscard]] inline double plateau(double x, double core, double reach) {
    return 1 - smooth_step(core, reach, std::abs(x));
}

/// The greater of a and b, rounded off over a depth of about `blend` where they cross (polynomial smooth maximum).
[[nodiscard]] inline double smooth_max(double a, double b, double blend) {
    const double h = std::abs(a - b) >= blend ? 0 : (blend - std::abs(a - b)) / blend;
    return (a > b ? a : b) + h * h * h * blend / 6;
}

/// Natural cubic spline as a linear map: weights(x) are what each knot's value counts for at x (linear beyond the
/// ends).
class SplineBasis {
public:
    explicit SplineBasis(std::vector<double> knots);
    [[nodiscard]] std::size_t size() const { return knots_.size(); }
    void weights(double x, std::span<double> out) const;

private:
    std::vector<double> knots_;
    std::vector<double> second_;  ///< size x size: second derivatives at the knots for each unit value
};

/// Monotone cubic (Fritsch-Carlson slopes): passes through its knots and never turns back between them.
class MonotoneCurve {
public:
    MonotoneCurve() = default;
    MonotoneCurve(std::vector<double> x, std::vector<double> y);
    [[nodiscard]] double operator()(double x) const;  ///< linear beyond the ends

private:
    std::vector<double> x_, y_, slope_;
};

}  // namespace mimik::synthesis
