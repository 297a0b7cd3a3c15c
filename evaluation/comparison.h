#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/case_row.h"
#include "statistics/false_discovery.h"
#include "statistics/interval.h"

namespace mimik::evaluation {

/// What is compared, and how sure the answers are made.
struct ComparisonOptions {
    std::string estimator = "surface_distance";  ///< whose rows
    std::vector<std::string> regions = {"zone"};
    std::string metric = "mean";  ///< an error: smaller is truer
    std::uint64_t seed = 1;
    int resamples = 2000;      ///< of intervals; five times as many signs are drawn for p
    double confidence = 0.95;  ///< of intervals
    statistics::FalseDiscovery false_discovery = statistics::FalseDiscovery::benjamini_hochberg;

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("estimator", self.estimator);
        visit("regions", self.regions);
        visit("metric", self.metric);
        visit("seed", self.seed);
        visit("resamples", self.resamples);
        visit("confidence", self.confidence);
        visit("false_discovery", self.false_discovery);
    }
    void check() const;  ///< throws InputError
};

/// One method on one expression in one region.
struct MethodSummary {
    std::string region;
    std::string expression;  ///< empty: all; every expression counts the same, whatever its cases
    std::string method;      ///< "default"; at another magnitude than 1: "default@0.8"
    std::size_t cases = 0;
    std::size_t targets = 0;
    double error = 0;                 ///< mean over the cases, in Comparison::unit
    std::optional<double> explained;  ///< 1 - sum of errors / sum of those of doing nothing, as Score::explained
    std::optional<statistics::Interval> explained_interval;  ///< empty: too few subjects
};

/// What the cases of two methods have in common, so that each has its partner.
enum class Pairing : std::uint8_t {
    source_and_target,  ///< both learn from one source: the same source on the same target
    target              ///< another kind of method is among them: each one's mean over the sources of the target
};
[[nodiscard]] constexpr const char* to_string(Pairing pairing) {
    return pairing == Pairing::target ? "target" : "source and target";
}

/// Two methods on one expression in one region.
struct MethodDifference {
    std::string region;
    std::string expression;  ///< empty: all, as of MethodSummary
    std::string first, second;
    Pairing pairing = Pairing::target;
    std::size_t pairs = 0;
    std::size_t targets = 0;
    double difference = 0;  ///< mean error of first - second, in Comparison::unit: below 0 the first is truer
    std::optional<statistics::Interval> interval;  ///< empty: too few subjects
    /// Cohen's dz with Hedges' correction, of the targets' mean differences; empty: fewer than 3, or all the same.
    std::optional<double> dz;
    double p = 1;        ///< sign-flip test over targets (statistics/sign_flip.h)
    bool exact = false;  ///< p is of all signs there are
    double q = 1;        ///< false discovery over regions and expressions of these two methods
};

struct Comparison {
    std::string unit;  ///< of errors: "mm"
    /// By region in the order of the options, expression in the order of the rows, method in the order of the rows.
    /// All expressions are the last ones of a region, where there are several.
    std::vector<MethodSummary> methods;
    std::vector<MethodDifference> differences;
};

/// Hands rows over, as read_case_rows() does.
using CaseRowReader = std::function<void(const std::function<void(const CaseRow&)>&)>;

/// How much surer than chance one method is truer than another: a pure function of the rows, whose order is of no
/// matter but for that of the answers. Holds 24 bytes a case.
///
/// Cases share subjects, so subjects are drawn and not cases. Where both methods learn from one source, cases are pairs
/// of people, and a case weighs by its source's and its target's counts (statistics::Clusters::pairs_of_people);
/// everywhere else targets alone are drawn. Intervals are bca. p flips the signs of all of a target's differences
/// together, whatever the source. q is over the expressions and regions of two methods; those over all expressions are
/// a family of their own, of the regions. A case counts where its error and that of doing nothing are known.
/// @throws InputError for bad options, rows of which none fits, a case that is there twice, or a metric whose rows have
/// different units.
[[nodiscard]] Comparison compare_methods(const CaseRowReader& read, const ComparisonOptions& options = {});

}  // namespace mimik::evaluation
