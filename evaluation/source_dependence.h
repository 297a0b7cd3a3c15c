#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluation/comparison.h"
#include "statistics/variance_components.h"

namespace mimik::evaluation {

/// How much it matters whose expression was taken, for one method that learns from one source.
struct SourceDependence {
    std::string region;
    std::string expression;  ///< its code
    std::string method;      ///< "default"; at another magnitude than 1: "default@0.8"
    std::size_t cases = 0, sources = 0, targets = 0;
    double error = 0;  ///< mean over the cases, in SourceDependences::unit
    /// Of the errors: who the source was, who the target was, the rest. Empty where the reason says why.
    std::optional<statistics::VarianceComponents> components = {};
    std::string reason = {};

    /// Standard deviation of the error from source to source, in SourceDependences::unit; 0 where chance does as much.
    [[nodiscard]] std::optional<double> between_sources() const;
};

struct SourceDependences {
    std::string unit;                   ///< of errors: "mm"
    std::vector<SourceDependence> all;  ///< by region, expression and method in the order of options and rows
};

/// Figure 7-1 of the thesis as a number: the same expression, put on the same faces, from one source and from another.
/// The error of a case is split into what its source explains, what its target explains, and the rest
/// (statistics/variance_components.h). A pure function of the rows; their order is of no matter but for that of the
/// answers. Doing nothing, means and bounds without a source of their own have no entry.
/// @throws InputError as compare_methods(), but rows of which none fits give an empty list.
[[nodiscard]] SourceDependences source_dependence(const CaseRowReader& read, const ComparisonOptions& options = {});

}  // namespace mimik::evaluation
