#pragma once

namespace mimik::statistics {

// Boost.Math's, so that it is compiled once. Degrees of freedom are above 0, shares from 0 to 1; the shares 0 and 1
// have infinite quantiles.

/// P(Z <= z) of the normal distribution with mean 0 and standard deviation 1.
[[nodiscard]] double normal_below(double z);
[[nodiscard]] double normal_quantile(double share);
/// P(|Z| >= |z|).
[[nodiscard]] double normal_two_sided_p(double z);

[[nodiscard]] double student_quantile(double share, double degrees);
/// P(|T| >= |t|) of Student's distribution.
[[nodiscard]] double student_two_sided_p(double t, double degrees);

/// P(F >= f) of Fisher's and Snedecor's distribution; f from 0 on.
[[nodiscard]] double fisher_above(double f, double degrees, double other_degrees);
[[nodiscard]] double fisher_quantile(double share, double degrees, double other_degrees);

}  // namespace mimik::statistics
