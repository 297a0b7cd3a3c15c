#pragma once

#include <nlohmann/json.hpp>

#include "modeling/template_motion.h"

namespace mimik::modeling {

/// The template and its motion as they stand in a model file, to the last bit.
[[nodiscard]] nlohmann::json template_motion_to_json(const TemplateMotion& dense);
/// @throws InputError naming the field that does not fit.
[[nodiscard]] TemplateMotion template_motion_from_json(const nlohmann::json& json);

}  // namespace mimik::modeling
