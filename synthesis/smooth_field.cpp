#include "synthesis/smooth_field.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/random_stream.h"

namespace mimik::synthesis {
namespace {

struct Weights {
    int first = 0;
    std::array<double, 4> value{};
};

Weights cubic_weights(double t) {
    Weights weights;
    const double floor_t = std::floor(t);
    weights.first = static_cast<int>(floor_t);
    const double f = t - floor_t, g = 1.0 - f;
    weights.value = {g * g * g / 6.0, (4.0 - 6.0 * f * f + 3.0 * f * f * f) / 6.0,
                     (4.0 - 6.0 * g * g + 3.0 * g * g * g) / 6.0, f * f * f / 6.0};
    // The sum of squares varies by a few per cent with f; divided out, the deviation is 1 everywhere.
    double squares = 0;
    for (const double w : weights.value) squares += w * w;
    for (double& w : weights.value) w /= std::sqrt(squares);
    return weights;
}

}  // namespace

SmoothField::SmoothField(std::uint64_t seed, int components, double length_mm, const geometry::Point& low_mm,
                         const geometry::Point& high_mm)
    : components_(components), spacing_mm_(length_mm / std::sqrt(2.0 / 3.0)), low_mm_(low_mm), high_mm_(high_mm) {
    if (components < 1 || components > 4) throw InputError("smooth field: components must be 1 to 4");
    if (!(length_mm > 0)) throw InputError("smooth field: the correlation length must be above 0 mm");
    std::size_t count = static_cast<std::size_t>(components);
    for (int axis = 0; axis < 3; ++axis) {
        size_[static_cast<std::size_t>(axis)] = static_cast<int>((high_mm[axis] - low_mm[axis]) / spacing_mm_) + 4;
        count *= static_cast<std::size_t>(size_[static_cast<std::size_t>(axis)]);
    }
    if (count > 50'000'000) throw InputError("smooth field: the correlation length is too short for the box");
    base::RandomStream random(seed);
    coefficients_.resize(count);
    for (double& c : coefficients_) c = random.normal();
    if (low_mm.z() != high_mm.z()) return;
    flat_ = true;
    const auto layers = cubic_weights(0).value;
    const std::size_t layer = count / static_cast<std::size_t>(size_[2]);
    for (std::size_t i = 0; i < layer; ++i) {
        double sum = 0;
        for (std::size_t k = 0; k < layers.size(); ++k) sum += layers[k] * coefficients_[k * layer + i];
        coefficients_[i] = sum;
    }
    coefficients_.resize(layer);
}

std::array<double, 4> SmoothField::at(const geometry::Point& position_mm) const {
    switch (components_) {
        case 1:
            return sum<1>(position_mm);
        case 2:
            return sum<2>(position_mm);
        case 3:
            return sum<3>(position_mm);
        default:
            return sum<4>(position_mm);
    }
}

template <int components>
std::array<double, 4> SmoothField::sum(const geometry::Point& position_mm) const {
    std::array<Weights, 3> w;
    w[2] = {0, {1, 0, 0, 0}};
    for (int axis = 0; axis < (flat_ ? 2 : 3); ++axis) {
        const double inside = std::clamp(position_mm[axis], low_mm_[axis], high_mm_[axis]);
        w[static_cast<std::size_t>(axis)] = cubic_weights((inside - low_mm_[axis]) / spacing_mm_);
    }
    std::array<double, 4> total{};
    for (int k = 0; k < (flat_ ? 1 : 4); ++k)
        for (int j = 0; j < 4; ++j) {
            const double wkj = w[2].value[static_cast<std::size_t>(k)] * w[1].value[static_cast<std::size_t>(j)];
            const std::size_t row = (static_cast<std::size_t>(w[2].first + k) * static_cast<std::size_t>(size_[1]) +
                                     static_cast<std::size_t>(w[1].first + j)) *
                                    static_cast<std::size_t>(size_[0]);
            const double* at =
                &coefficients_[(row + static_cast<std::size_t>(w[0].first)) * static_cast<std::size_t>(components)];
            for (std::size_t i = 0; i < 4; ++i) {
                const double weight = wkj * w[0].value[i];
                for (int c = 0; c < components; ++c) total[static_cast<std::size_t>(c)] += weight * *at++;
            }
        }
    return total;
}

}  // namespace mimik::synthesis
