#include "evaluation/estimator_check.h"

#include <algorithm>
#include <optional>
#include <set>
#include <span>
#include <tuple>

#include "base/errors.h"
#include "evaluation/estimator_choice.h"
#include "evaluation/plan.h"
#include "evaluation/score.h"
#include "geometry/statistics.h"
#include "statistics/correlation.h"

namespace mimik::evaluation {
namespace {

using Group = std::tuple<std::string, std::string, std::string>;  // estimator, method, expression

struct Pairs {
    std::vector<double> estimate, truth;
};

/// Empty with fewer than 3 cases, or where all values of a list are the same.
std::optional<double> value_of(statistics::Correlation (*correlation)(std::span<const double>, std::span<const double>,
                                                                      double),
                               const Pairs& pairs) {
    constexpr double confidence = 0.95;
    const auto constant = [](const std::vector<double>& values) {
        return std::all_of(values.begin(), values.end(), [&](double value) { return value == values.front(); });
    };
    if (pairs.truth.size() < 3 || constant(pairs.truth) || constant(pairs.estimate)) return std::nullopt;
    try {
        return correlation(pairs.estimate, pairs.truth, confidence).value;
    } catch (const NumericalError&) {  // equal up to rounding
        return std::nullopt;
    }
}

/// The metric by which an estimator is compared; empty: it is none of the pipeline's.
std::string metric_of(const std::string& estimator) {
    if (estimator == "surface_distance") return "mean";
    if (estimator.find('_') != std::string::npos) return {};  // rows that every experiment has
    try {
        return definition_of(estimator_by_name(estimator)).metric;
    } catch (const InputError&) {
        return {};
    }
}

/// Collects the cases of all groups, case after case.
class Collector {
public:
    void take(const CaseRow& row) {
        if (!any_ || !(row.key == key_)) {
            close();
            key_ = row.key;
            any_ = true;
        }
        if (row.region != "zone" || !row.value || !row.reason.empty()) return;
        if (row.estimator == "true_distance" && row.metric == "mean") truth_ = row.value;
        auto known = metrics_.find(row.estimator);
        if (known == metrics_.end()) known = metrics_.emplace(row.estimator, metric_of(row.estimator)).first;
        if (!known->second.empty() && row.metric == known->second) estimates_[row.estimator] = *row.value;
    }
    void close() {
        if (truth_ && is_method(key_.method))
            for (const auto& [estimator, value] : estimates_) {
                auto& pairs = groups_[{estimator, variant_of(key_), key_.expression}];
                pairs.estimate.push_back(value);
                pairs.truth.push_back(*truth_);
            }
        any_truth_ = any_truth_ || truth_.has_value();
        truth_.reset();
        estimates_.clear();
    }
    [[nodiscard]] bool any_truth() const { return any_truth_; }
    [[nodiscard]] const std::map<Group, Pairs>& groups() const { return groups_; }
    [[nodiscard]] const std::string& metric(const std::string& estimator) const { return metrics_.at(estimator); }

private:
    static bool is_method(const std::string& name) {
        return name != baseline_method && name != bound_of(animation::SourceKind::one_source) &&
               name != bound_of(animation::SourceKind::all_but_target);
    }
    CaseKey key_;
    bool any_ = false, any_truth_ = false;
    std::optional<double> truth_;
    std::map<std::string, double> estimates_;
    std::map<std::string, std::string> metrics_;
    std::map<Group, Pairs> groups_;
};

double mean_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value / static_cast<double>(values.size());
    return sum;
}

std::optional<double> least(const std::vector<double>& values) {
    return values.empty() ? std::nullopt : std::optional(*std::min_element(values.begin(), values.end()));
}
std::optional<double> middle(const std::vector<double>& values) {
    return values.empty() ? std::nullopt : std::optional(geometry::median(values));
}

std::vector<EstimatorSummary> summaries_of(const std::vector<EstimatorAgreement>& agreements) {
    std::vector<EstimatorSummary> summaries;
    for (auto begin = agreements.begin(); begin != agreements.end();) {
        const auto end = std::find_if(begin, agreements.end(), [&](const auto& other) {
            return other.estimator != begin->estimator || other.method != begin->method;
        });
        EstimatorSummary summary;
        summary.method = begin->method;
        summary.estimator = begin->estimator;
        summary.region = begin->region;
        std::vector<double> pearsons, spearmans, kendalls;
        for (; begin != end; ++begin) {
            summary.cases += begin->n;
            if (!begin->pearson) continue;
            ++summary.expressions;
            if (pearsons.empty() || *begin->pearson < *least(pearsons)) summary.worst = begin->expression;
            pearsons.push_back(*begin->pearson);
            spearmans.push_back(*begin->spearman);
            kendalls.push_back(*begin->kendall);
        }
        summary.least_pearson = least(pearsons);
        summary.median_pearson = middle(pearsons);
        summary.least_spearman = least(spearmans);
        summary.median_spearman = middle(spearmans);
        summary.least_kendall = least(kendalls);
        summaries.push_back(std::move(summary));
    }
    return summaries;
}

}  // namespace

EstimatorCheck check_estimators(const std::function<void(const std::function<void(const CaseRow&)>&)>& read) {
    Collector collector;
    read([&](const CaseRow& row) { collector.take(row); });
    collector.close();
    if (!collector.any_truth())
        throw InputError(
            "no case has a true error, so no estimator can be checked; take a database with a truth, as 'mimik "
            "synthesize' makes one");
    EstimatorCheck check;
    for (const auto& [group, pairs] : collector.groups()) {
        const auto& [estimator, method, expression] = group;
        EstimatorAgreement agreement;
        agreement.expression = expression;
        agreement.method = method;
        agreement.estimator = estimator;
        agreement.region = "zone";
        agreement.metric = collector.metric(estimator);
        agreement.n = pairs.truth.size();
        agreement.pearson = value_of(&statistics::pearson, pairs);
        agreement.spearman = value_of(&statistics::spearman, pairs);
        agreement.kendall = value_of(&statistics::kendall, pairs);
        agreement.estimate = mean_of(pairs.estimate);
        agreement.true_mm = mean_of(pairs.truth);
        check.agreements.push_back(std::move(agreement));
    }
    check.summaries = summaries_of(check.agreements);
    return check;
}

}  // namespace mimik::evaluation
