#include "statistics/t_test.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include "base/errors.h"
#include "statistics/distributions.h"
#include "statistics/values.h"

namespace mimik::statistics {
namespace {

double standard_error(std::span<const double> values, double mean) {
    const auto n = static_cast<double>(values.size());
    return std::sqrt(squares_about(values, mean) / (n - 1) / n);
}

Interval around(double mean, double error, double degrees, double confidence) {
    const double half = student_quantile(0.5 + 0.5 * confidence, degrees) * error;
    return {mean - half, mean + half};
}

}  // namespace

Interval t_interval(std::span<const double> values, double confidence) {
    check_confidence(confidence);
    need_values(values, 2, "an interval of a mean");
    const double mean = mean_of(values);
    return around(mean, standard_error(values, mean), static_cast<double>(values.size() - 1), confidence);
}

TTest paired_t_test(std::span<const double> first, std::span<const double> second, double confidence) {
    check_confidence(confidence);
    need_pairs(first, second, 2, "a paired t test");
    std::vector<double> differences(first.size());
    for (std::size_t k = 0; k < first.size(); ++k) differences[k] = first[k] - second[k];
    if (!differ(differences)) throw NumericalError("a paired t test of differences that are all the same has no t");
    TTest test;
    test.mean = mean_of(differences);
    test.degrees = static_cast<double>(differences.size() - 1);
    const double error = standard_error(differences, test.mean);
    test.t = test.mean / error;
    test.p = student_two_sided_p(test.t, test.degrees);
    test.interval = around(test.mean, error, test.degrees, confidence);
    return test;
}

}  // namespace mimik::statistics
