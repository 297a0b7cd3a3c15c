#include "animation/pooled_method.h"

namespace mimik::animation::methods {

/// What is left of people's own asymmetry in a mean is noise.
MethodPointer mean_symmetric_method() {
    return std::make_shared<PooledMethod>(
        PooledMethod::Setting{.name = "mean-symmetric",
                              .summary = "The mean, and its mirror image where both sides move",
                              .pool = [](std::span<const PooledSource> sources, const PoolTask& task) {
                                  auto mean = mean_motion(sources);
                                  return task.both_sides ? symmetric_motion(task.face_template, mean) : mean;
                              }});
}

}  // namespace mimik::animation::methods
