#include "synthesis/builtin_curves.h"

#include <algorithm>
#include <utility>

namespace mimik::synthesis {
namespace {

/// Index i with x in [knots[i], knots[i + 1]], clamped to the ends.
std::size_t interval(const std::vector<double>& knots, double x) {
    const auto it = std::upper_bound(knots.begin() + 1, knots.end() - 1, x);
    return static_cast<std::size_t>(it - knots.begin()) - 1;
}

}  // namespace

SplineBasis::SplineBasis(std::vector<double> knots) : knots_(std::move(knots)) {
    const std::size_t n = knots_.size();
    second_.assign(n * n, 0);
    for (std::size_t unit = 0; unit < n; ++unit) {
        const auto value = [&](std::size_t i) { return i == unit ? 1.0 : 0.0; };
        // Thomas algorithm on the usual system of second derivatives; both ends are free (zero).
        std::vector<double> upper(n, 0), right(n, 0);
        for (std::size_t i = 1; i + 1 < n; ++i) {
            const double before = knots_[i] - knots_[i - 1], after = knots_[i + 1] - knots_[i];
            const double diagonal = 2 * (before + after) - before * upper[i - 1];
            const double slope_step = (value(i + 1) - value(i)) / after - (value(i) - value(i - 1)) / before;
            upper[i] = after / diagonal;
            right[i] = (6 * slope_step - before * right[i - 1]) / diagonal;
        }
        for (std::size_t i = n - 1; i-- > 1;)
            second_[i * n + unit] = right[i] - upper[i] * (i + 2 < n ? second_[(i + 1) * n + unit] : 0);
    }
}

void SplineBasis::weights(double x, std::span<double> out) const {
    const std::size_t n = knots_.size(), i = interval(knots_, x);
    const double h = knots_[i + 1] - knots_[i];
    std::fill(out.begin(), out.end(), 0.0);
    if (x < knots_.front() || x > knots_.back()) {
        const std::size_t end = x < knots_.front() ? i : i + 1;
        const double sign = end == i ? -1 : 1, beyond = x - knots_[end];
        out[i] -= beyond / h;
        out[i + 1] += beyond / h;
        out[end] += 1;
        const std::size_t inner = end == i ? i + 1 : i;
        for (std::size_t k = 0; k < n; ++k) out[k] += beyond * sign * h / 6 * second_[inner * n + k];
        return;
    }
    const double a = (knots_[i + 1] - x) / h, b = (x - knots_[i]) / h;
    out[i] += a;
    out[i + 1] += b;
    const double ca = (a * a * a - a) * h * h / 6, cb = (b * b * b - b) * h * h / 6;
    for (std::size_t k = 0; k < n; ++k) out[k] += ca * second_[i * n + k] + cb * second_[(i + 1) * n + k];
}

MonotoneCurve::MonotoneCurve(std::vector<double> x, std::vector<double> y) : x_(std::move(x)), y_(std::move(y)) {
    const std::size_t n = x_.size();
    std::vector<double> secant(n - 1);
    for (std::size_t i = 0; i + 1 < n; ++i) secant[i] = (y_[i + 1] - y_[i]) / (x_[i + 1] - x_[i]);
    slope_.assign(n, 0);
    slope_.front() = secant.front();
    slope_.back() = secant.back();
    for (std::size_t i = 1; i + 1 < n; ++i) {
        if (secant[i - 1] * secant[i] <= 0) continue;
        const double before = x_[i] - x_[i - 1], after = x_[i + 1] - x_[i];
        const double w1 = 2 * after + before, w2 = after + 2 * before;
        slope_[i] = (w1 + w2) / (w1 / secant[i - 1] + w2 / secant[i]);
    }
}

double MonotoneCurve::operator()(double x) const {
    if (x <= x_.front()) return y_.front() + slope_.front() * (x - x_.front());
    if (x >= x_.back()) return y_.back() + slope_.back() * (x - x_.back());
    const std::size_t i = interval(x_, x);
    const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h, t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * y_[i] + (t3 - 2 * t2 + t) * h * slope_[i] + (3 * t2 - 2 * t3) * y_[i + 1] +
           (t3 - t2) * h * slope_[i + 1];
}

}  // namespace mimik::synthesis
