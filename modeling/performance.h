#pragma once

#include <optional>

#include "database/truth.h"
#include "preprocessing/face.h"

namespace mimik::modeling {

/// One subject at rest and with an expression: the two faces, and what is truly known of them.
struct Performance {
    preprocessing::Face neutral, expressive;
    geometry::Transform neutral_from_expressive = geometry::Transform::Identity();  ///< the scans' scanner frames
    std::optional<database::TrueScan> true_neutral;                                 ///< without a truth: none
    std::optional<database::TrueScan> true_expression;  ///< displacement_mm from the neutral scan
};

}  // namespace mimik::modeling
