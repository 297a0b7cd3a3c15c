#pragma once

#include <span>
#include <vector>

#include "capture/surface_energy.h"

// The terms of an energy as a sum of squares, for the minimisers of capture/minimise_surface.cpp.

namespace mimik::capture {

/// Residuals s of which the half sum of squares is  sum_k w_k (sqrt(r_k^2 + a^2) - a):  the energy, but for its corners
/// at 0, which are round within a of it.
class SmoothTerms {
public:
    SmoothTerms(const SurfaceEnergy& energy, double width_mm) : energy_(&energy), width_mm_(width_mm) {}
    [[nodiscard]] const SurfaceEnergy& energy() const { return *energy_; }
    [[nodiscard]] std::size_t size() const { return energy_->terms().size(); }
    /// @param gradients  of the corners, or null
    [[nodiscard]] double residual(std::size_t term, const geometry::Point* corners_mm,
                                  geometry::Vector* gradients) const;

private:
    const SurfaceEnergy* energy_;
    double width_mm_;
};

/// Eigen's Levenberg-Marquardt on the vertices that do not hold. @return how often all residuals, or all gradients,
/// were computed
[[nodiscard]] std::size_t solve_by_levenberg(const SmoothTerms& terms, std::vector<geometry::Point>& pose_mm,
                                             std::span<const std::uint8_t> holding, int most_iterations,
                                             double least_change);

}  // namespace mimik::capture
