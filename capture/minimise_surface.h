#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/fields.h"
#include "capture/surface_energy.h"

namespace mimik::capture {

/// What finds the pose of least energy.
enum class SurfaceMinimiser {
    levenberg,  ///< least squares by Eigen's Levenberg-Marquardt: always there
    ceres,      ///< the same sums by Ceres, if mimik-ceres.so is there
    simplex     ///< the energy alone by downhill simplex (Nelder and Mead 1965), if mimik-simplex.so is there
};
[[nodiscard]] const char* to_string(SurfaceMinimiser minimiser);  ///< "levenberg", "ceres", "simplex"
[[nodiscard]] std::span<const SurfaceMinimiser> surface_minimisers();
/// Whether its library is there. Nothing is loaded.
[[nodiscard]] bool is_there(SurfaceMinimiser minimiser);

struct MinimiseSurfaceOptions {
    /// Least squares: |r| is sqrt(r^2 + a^2) - a, with a going down by equal ratios: wide ones see far, narrow ones are
    /// the energy itself.
    double first_width_mm = 1.0;
    double last_width_mm = 0.01;
    int stages = 5;
    int most_iterations = 50;    ///< of each stage
    double least_change = 1e-6;  ///< a stage ends when its sum falls by a smaller share
    /// Simplex: length of its first steps along each coordinate. As OpenCV begins it, the start is the corners' middle:
    /// the first corner is half a step off in every coordinate at once.
    double first_step_mm = 2.0;
    int most_evaluations = 100000;  ///< simplex
    /// Simplex: it ends when its corners' energies differ by less.
    double least_difference = 1e-9;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("first_width_mm", self.first_width_mm);
        visit("last_width_mm", self.last_width_mm);
        visit("stages", self.stages);
        visit("most_iterations", self.most_iterations);
        visit("least_change", self.least_change);
        visit("first_step_mm", self.first_step_mm);
        visit("most_evaluations", self.most_evaluations);
        visit("least_difference", self.least_difference);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<MinimiseSurfaceOptions>());

struct MinimisedSurface {
    std::vector<geometry::Point> pose_mm;
    SurfaceEnergyParts start, end;  ///< the end is never above the start
    std::size_t evaluations = 0;    ///< of all terms, and of all their derivatives
    double seconds = 0;             ///< by the clock, loading of a library not among them
};

/// The pose of least energy near a start.
/// @param holding  per vertex: 1 where it stays; empty: nowhere
/// @throws InputError for bad options or sizes, or where the minimiser's library is not there: names the package.
[[nodiscard]] MinimisedSurface minimise_surface(const SurfaceEnergy& energy, std::span<const geometry::Point> start_mm,
                                                std::span<const std::uint8_t> holding, SurfaceMinimiser minimiser,
                                                const MinimiseSurfaceOptions& options = {});

}  // namespace mimik::capture
