#pragma once

#include <vector>

#include "evaluation/experiment.h"

namespace mimik::evaluation {

/// How hard a database is decides what a method can explain on it: fit to be scored on is one whose true fields explain
/// as much of the thesis's nine expressions as they did where the methods were measured first.
struct ReferenceBand {
    animation::SourceKind kind = animation::SourceKind::one_source;
    double low = 0.0, high = 0.0;
    double explained = 0.0;  ///< by the true field of this kind
    [[nodiscard]] bool inside() const { return low <= explained && explained <= high; }
};

/// One per kind of true field: 0.41 to 0.53 from one source, 0.55 to 0.65 for a mean of 11 or more. Empty without true
/// fields or for other expressions than the nine, for which there is no band; no mean of fewer sources.
[[nodiscard]] std::vector<ReferenceBand> reference_bands(const ExperimentReport& report);

}  // namespace mimik::evaluation
