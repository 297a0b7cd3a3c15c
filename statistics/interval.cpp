#include "statistics/interval.h"

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::statistics {

void check_confidence(double confidence) {
    if (!(confidence > 0 && confidence < 1))
        throw InputError(fmt::format("confidence is {}; give a share between 0 and 1, such as 0.95", confidence));
}

}  // namespace mimik::statistics
