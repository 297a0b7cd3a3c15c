#pragma once

namespace mimik::geometry {

enum class SplineKernel {
    r,         ///< U(r) = -r, the biharmonic kernel of three dimensions
    r2_log_r2  ///< U(r) = r^2 ln r^2, Eq. 4.4 of the thesis (the biharmonic kernel of two dimensions)
};

[[nodiscard]] constexpr const char* to_string(SplineKernel kernel) {
    return kernel == SplineKernel::r ? "r" : "r2logr";
}

}  // namespace mimik::geometry
