#include "animation/pooled_method.h"

namespace mimik::animation::methods {

/// Who is built alike may move alike; what is left of people's own asymmetry in a mean is noise.
MethodPointer mean_near_method() {
    return std::make_shared<PooledMethod>(
        PooledMethod::Setting{.name = "mean-near",
                              .summary = "The mean, in which faces like the target's weigh more, alike on both sides",
                              .pool = [](std::span<const PooledSource> sources, const PoolTask& task) {
                                  const auto motion = near_motion(sources, task);
                                  return task.both_sides ? symmetric_motion(task.face_template, motion) : motion;
                              }});
}

}  // namespace mimik::animation::methods
