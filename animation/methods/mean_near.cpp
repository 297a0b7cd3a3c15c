#include "animation/pooled_method.h"

namespace mimik::animation::methods {

/// Who is built alike may move alike.
MethodPointer mean_near_method() {
    return std::make_shared<PooledMethod>(
        PooledMethod::Setting{.name = "mean-near",
                              .summary = "The mean, in which people with a face like the target's weigh more",
                              .pool = [](std::span<const PooledSource> sources, const PoolTask& task) {
                                  return near_motion(sources, task);
                              }});
}

}  // namespace mimik::animation::methods
