#pragma once

#include <optional>
#include <span>

namespace mimik::evaluation {

// Whether two lists of numbers rise together: 1 always, -1 never, 0 no relation. Empty with fewer than 3 pairs, or
// where one list is constant. @throws InputError if their sizes differ.

/// Product-moment correlation.
[[nodiscard]] std::optional<double> pearson(std::span<const double> x, std::span<const double> y);
/// Pearson's of the ranks; equal values share the mean of their ranks.
[[nodiscard]] std::optional<double> spearman(std::span<const double> x, std::span<const double> y);
/// Kendall's tau-b, which allows for equal values; n log n (Knight 1966).
[[nodiscard]] std::optional<double> kendall(std::span<const double> x, std::span<const double> y);

}  // namespace mimik::evaluation
