#pragma once

#include <cstddef>
#include <cstdint>

// What companions/ceres_module.cpp and companions/simplex_module.cpp give, and who loads them looks up by name: plain
// C, so that neither side knows the other's types. Each gives 0 when done, else what went wrong in `message`, of
// `message_size` bytes.

extern "C" {

/// The value of a function at x.
using mimik_value_function = double(void* function, const double* x);

/// cv::DownhillSolver. @param x  where it starts, and then the best point @param value  of the best point
/// @param evaluations  at most so many, and then how many there were
using mimik_simplex_function = int(mimik_value_function* function, void* data, double* x, std::size_t count,
                                   double first_step, double least_change, int* evaluations, double* value,
                                   char* message, std::size_t message_size);

/// One residual of a sum of squares. @param blocks  the three variables of each of its blocks @param gradients  as
/// many; null, or null for a block that holds still
using mimik_residual_function = double(void* problem, std::size_t term, const double* const* blocks,
                                       double* const* gradients);

/// Residuals that depend on a few blocks of three variables each.
struct mimik_residuals {  // NOLINT(readability-identifier-naming): C
    std::size_t blocks, terms;
    const std::uint32_t* first;   ///< terms + 1: where in `block` those of a term begin
    const std::uint32_t* block;   ///< their numbers
    const std::uint8_t* holding;  ///< per block: 1 where it holds still
};

/// ceres::Solve. @param x  3 * blocks variables: where it starts, and then where the sum is least
/// @param evaluations  how often all residuals were computed
using mimik_ceres_function = int(mimik_residual_function* residual, void* problem, const mimik_residuals* residuals,
                                 double* x, int most_iterations, double least_change, int* evaluations, char* message,
                                 std::size_t message_size);
}

namespace mimik::base {

inline constexpr const char* ceres_module_name = "mimik-ceres.so";
inline constexpr const char* ceres_function_name = "mimik_ceres_1";
inline constexpr const char* simplex_module_name = "mimik-simplex.so";
inline constexpr const char* simplex_function_name = "mimik_simplex_1";

}  // namespace mimik::base
