#include "statistics/asymmetry.h"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "base/errors.h"
#include "statistics/values.h"

namespace mimik::statistics {

Asymmetry asymmetry_index(std::span<const double> left, std::span<const double> right) {
    need_pairs(left, right, 1, "an asymmetry");
    double apart = 0, more_left = 0, both = 0;
    for (std::size_t k = 0; k < left.size(); ++k) {
        if (left[k] < 0 || right[k] < 0)
            throw InputError(fmt::format("an asymmetry: pair {} is {} left, {} right; give lengths, 0 or more", k,
                                         left[k], right[k]));
        apart += std::abs(left[k] - right[k]);
        more_left += left[k] - right[k];
        both += left[k] + right[k];
    }
    if (!(both > 0)) throw NumericalError("an asymmetry of nothing that moved is not defined");
    return {apart / both, more_left / both};
}

}  // namespace mimik::statistics
