#pragma once

#include <cstddef>
#include <span>

#include "statistics/interval.h"

namespace mimik::statistics {

struct Intraclass {
    double value =
        0;         ///< the share of variance that is the things' own; below 0 where raters disagree more than chance
    double f = 0;  ///< mean square of the things over that of the residual
    double p = 1;  ///< of no share, by F
    Interval interval;  ///< of the value
};

/// ICC(2,1): how far raters agree, absolutely, where things and raters are each a sample (Shrout and Fleiss 1979; the
/// interval as McGraw and Wong 1996, Table 7). Repeated measures of the same faces are such raters.
/// @param values  thing after thing, one value of each rater; none missing. @param raters  2 or more
/// @throws InputError for fewer than 2 things or raters, other numbers of values than full rows, or a value that is not
/// finite; NumericalError if raters differ by nothing or by the same everywhere.
[[nodiscard]] Intraclass intraclass(std::span<const double> values, std::size_t raters, double confidence = 0.95);

}  // namespace mimik::statistics
