#include "evaluation/method.h"

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::evaluation {

Method method_by_name(const std::string& name) {
    if (name == "thesis")
        return {name, RowKind::one_source, modeling::ModelOptions::thesis(), animation::AnimationOptions::thesis(),
                1.0};
    if (name == "default") return {name, RowKind::one_source, {}, {}, 1.0};
    if (name == "mean") return {name, RowKind::mean, {}, {}, 1.0};
    throw InputError(fmt::format("method '{}' is unknown; there are: thesis, default, mean", name));
}

}  // namespace mimik::evaluation
