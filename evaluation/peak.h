#pragma once

#include <memory>

#include "evaluation/estimator.h"

namespace mimik::evaluation {

/// "peak": region "zone", metrics "animated" and, with a truth, "true": the length below which 99 % of the motions of
/// the zone's scored vertices stay, mm. A method that smooths motion away reaches less than the truth.
[[nodiscard]] std::unique_ptr<const Estimator> peak_estimator();

}  // namespace mimik::evaluation
