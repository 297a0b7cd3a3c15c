#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace mimik::statistics {

/// One factor's part in a table of values by source and target.
struct VarianceComponent {
    double variance = 0;      ///< unbiased, and so below 0 where the factor does less than chance
    double share = 0;         ///< of the sum of the three, what is below 0 counted as 0
    std::size_t degrees = 0;  ///< of freedom
    double f = 0;             ///< mean square, fitted after the other factor, over that of the residual
    double p = 1;             ///< that it has no part, by F
};

struct VarianceComponents {
    double mean = 0;  ///< of all values
    VarianceComponent source, target;
    VarianceComponent residual;  ///< what neither explains, their interaction included; no f and p
    std::size_t cells = 0;       ///< values
};

/// How much of the variance of a score is due to who the source was and who the target was: value = mean + source +
/// target + residual, each drawn at random. Source dependence as a number: source.share 0 says that any source does.
///
/// Fitting constants (Henderson 1953, method 3): each factor is fitted by least squares after the other, and the sum of
/// squares that it explains is put equal to what is expected of it. The cells need not be all there: a face is seldom
/// its own source, so the diagonal is missing. Of a full table it is the classical analysis of variance.
/// @param source, target  parallel to the values: any numbers that stand for whom
/// @throws InputError if the lists differ in length or a value is not finite; NumericalError if a factor cannot be told
/// from the other or no value is left for the residual, or if there is no residual.
[[nodiscard]] VarianceComponents variance_components(std::span<const double> values,
                                                     std::span<const std::uint32_t> source,
                                                     std::span<const std::uint32_t> target);

}  // namespace mimik::statistics
