#include "animation/pooled_method.h"

namespace mimik::animation::methods {

/// One source that is far off does not pull the others.
MethodPointer mean_median_method() {
    return std::make_shared<PooledMethod>(
        PooledMethod::Setting{.name = "mean-median",
                              .summary = "Per vertex the motion that is nearest to those of all others",
                              .pool = [](std::span<const PooledSource> sources, const PoolTask& task) {
                                  (void)task;
                                  return median_motion(sources);
                              }});
}

}  // namespace mimik::animation::methods
