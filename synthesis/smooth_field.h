#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/types.h"

namespace mimik::synthesis {

/// A stationary random field, mean 0 and standard deviation 1 at every point, with up to four independent components.
/// Correlation between two points d apart: close to exp(-d^2 / (2 length^2)). Made of cubic B-splines with normal
/// coefficients on a lattice: the autocorrelation of a cubic B-spline of spacing h is nearly a Gaussian of deviation
/// sqrt(2/3) h (each of the four boxes that make one adds h^2/12 of variance, twice), so h = length / sqrt(2/3).
class SmoothField {
public:
    /// Covers the box [low, high] (mm); outside it the field is constant along the outward direction. A box without
    /// depth costs a quarter.
    SmoothField(std::uint64_t seed, int components, double length_mm, const geometry::Point& low_mm,
                const geometry::Point& high_mm);

    [[nodiscard]] std::array<double, 4> at(const geometry::Point& position_mm) const;  ///< unused components are 0

private:
    template <int components>
    [[nodiscard]] std::array<double, 4> sum(const geometry::Point& position_mm) const;

    int components_;
    double spacing_mm_;
    geometry::Point low_mm_, high_mm_;
    std::array<int, 3> size_{};
    std::vector<double> coefficients_;
    bool flat_ = false;  ///< a box without depth: its layers are already one
};

}  // namespace mimik::synthesis
