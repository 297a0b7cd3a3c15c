#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluation/comparison.h"

namespace mimik::evaluation {

/// One experiment's rows, and what it is called in tables.
struct NamedRun {
    std::string name;
    CaseRowReader read;
};

/// One method on one expression in one region, run by run.
struct MethodOfRuns {
    std::string region;
    std::string expression;  ///< empty: all
    std::string method;
    std::vector<std::optional<MethodSummary>> runs;  ///< parallel to RunComparison::runs; empty: that run has none
};

struct RunComparison {
    std::vector<std::string> runs;
    std::string unit;                   ///< of errors: "mm"
    std::vector<MethodOfRuns> methods;  ///< in the order of the first run that has each
    /// One method in two runs: `first` is "default" of the first run, `second` that of another, both named
    /// "default (run)". Cases are paired by source and target, or by target, as of two methods.
    std::vector<MethodDifference> differences;
};

/// The same methods in several runs: on scans that were marked worse, with other options, of another version. Each
/// run's explained fraction is of its own cases of doing nothing; differences of errors are between the first run and
/// each other one. A pure function of the rows.
/// @throws InputError as compare_methods(), for fewer than two runs, or two of one name.
[[nodiscard]] RunComparison compare_runs(std::span<const NamedRun> runs, const ComparisonOptions& options = {});

}  // namespace mimik::evaluation
