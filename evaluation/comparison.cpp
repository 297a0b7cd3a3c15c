#include "evaluation/comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/fields.h"
#include "evaluation/anchors.h"
#include "evaluation/numbered_names.h"
#include "evaluation/score.h"
#include "statistics/bootstrap.h"
#include "statistics/effect_size.h"
#include "statistics/sign_flip.h"

namespace mimik::evaluation {
namespace {

struct Case {
    std::uint32_t target = 0, source = 0;
    double error = 0, nothing = 0;
};
/// Cases of one method on one expression in one region, by target and then source.
using Cases = std::vector<Case>;

/// All rows that fit, as numbers.
struct Table {
    std::string unit;
    NumberedNames subjects, expressions, methods;
    std::vector<char> one_source;                                                  // per method: it learns from one
    std::map<std::tuple<std::size_t, std::uint32_t, std::uint32_t>, Cases> cases;  // region, expression, method

    [[nodiscard]] const Cases& of(std::size_t region, std::uint32_t expression, std::uint32_t method) const {
        static const Cases none;
        const auto found = cases.find({region, expression, method});
        return found == cases.end() ? none : found->second;
    }
};

std::string method_name(const CaseKey& key) { return key.method == baseline_method ? key.method : variant_of(key); }

class TableBuilder {
public:
    explicit TableBuilder(const ComparisonOptions& options) : options_(options) {}

    void take(const CaseRow& row) {
        if (row.estimator != options_.estimator || row.metric != options_.metric) return;
        const auto region = std::find(options_.regions.begin(), options_.regions.end(), row.region);
        if (region == options_.regions.end()) return;
        if (table_.unit.empty()) table_.unit = row.unit;
        if (row.unit != table_.unit)
            throw InputError(fmt::format("rows of '{}, {}' are in {} and in {}; choose a metric of one unit",
                                         options_.estimator, options_.metric, table_.unit, row.unit));
        const std::uint32_t method = table_.methods.number(method_name(row.key));
        const std::uint32_t expression = table_.expressions.number(row.key.expression);
        table_.one_source.resize(table_.methods.size(), 0);
        if (!row.key.source.empty() && row.key.source != "mean") table_.one_source[method] = 1;
        if (!row.value) return;
        const Case one{table_.subjects.number(row.key.target), table_.subjects.number(row.key.source), *row.value, 0};
        table_.cases[{static_cast<std::size_t>(region - options_.regions.begin()), expression, method}].push_back(one);
    }

    Table finish() {
        if (table_.cases.empty())
            throw InputError(fmt::format("no row has a value of '{}, {}' in region {}; nothing is to be compared",
                                         options_.estimator, options_.metric, base::value_text(options_.regions)));
        const auto places = table_.subjects.places();
        const std::uint32_t baseline = table_.methods.number(baseline_method);
        table_.one_source.resize(table_.methods.size(), 0);
        for (auto& [key, cases] : table_.cases) {
            for (auto& one : cases) one = {places[one.target], places[one.source], one.error, 0};
            std::sort(cases.begin(), cases.end(), [](const Case& a, const Case& b) {
                return std::pair(a.target, a.source) < std::pair(b.target, b.source);
            });
            const auto twice = std::adjacent_find(cases.begin(), cases.end(), [](const Case& a, const Case& b) {
                return a.target == b.target && a.source == b.source;
            });
            if (twice != cases.end()) fail_twice(std::get<1>(key), std::get<2>(key));
        }
        for (auto& [key, cases] : table_.cases) {
            // One after another: the baseline's own come to stand beside itself, too.
            const Cases nothing = table_.of(std::get<0>(key), std::get<1>(key), baseline);
            std::erase_if(cases, [&](Case& one) {
                const auto its =
                    std::lower_bound(nothing.begin(), nothing.end(), one.target,
                                     [](const Case& a, std::uint32_t target) { return a.target < target; });
                if (its == nothing.end() || its->target != one.target) return true;
                one.nothing = its->error;
                return false;
            });
        }
        return std::move(table_);
    }

private:
    [[noreturn]] void fail_twice(std::uint32_t expression, std::uint32_t method) const {
        throw InputError(
            fmt::format("rows of expression '{}' by '{}' hold a case twice; give each experiment's rows once",
                        table_.expressions.name(expression), table_.methods.name(method)));
    }

    const ComparisonOptions& options_;
    Table table_;
};

/// Values by case, of one expression or of several, which are groups that count the same.
struct Sample {
    std::vector<double> above, below;  // the ratio of their sums is the value of a group
    std::vector<std::uint32_t> source, target;
    std::vector<std::size_t> ends;  // of the groups

    void add(const Case& at, double over, double under) {
        above.push_back(over);
        below.push_back(under);
        source.push_back(at.source);
        target.push_back(at.target);
    }
    void end_group() {
        if (above.size() > (ends.empty() ? 0 : ends.back())) ends.push_back(above.size());
    }
    [[nodiscard]] std::size_t targets() const { return std::set(target.begin(), target.end()).size(); }
};

/// The mean of the groups' ratios; a group has none where what stands below adds up to `least` or less.
double mean_ratio(const Sample& sample, std::span<const double> weights, double least) {
    double sum = 0;
    std::size_t known = 0, k = 0;
    for (const std::size_t end : sample.ends) {
        double above = 0, below = 0;
        for (; k < end; ++k) {
            above += weights[k] * sample.above[k];
            below += weights[k] * sample.below[k];
        }
        if (!(below > least)) continue;
        sum += above / below;
        ++known;
    }
    return known > 0 ? sum / static_cast<double>(known) : std::numeric_limits<double>::quiet_NaN();
}

constexpr std::size_t fewest_people = 3;  // who are drawn: of two, half of the samples are one of them twice

std::optional<statistics::Interval> interval_of(const Sample& sample, bool pairs, double least,
                                                const ComparisonOptions& options) {
    using statistics::Clusters;
    // A source on itself is one person, who is drawn once.
    const bool itself = sample.source == sample.target;
    const auto clusters =
        pairs && !itself ? Clusters::pairs_of_people(sample.source, sample.target) : Clusters::one_way(sample.target);
    if (clusters.draws().front() < fewest_people) return std::nullopt;
    const statistics::WeightedStatistic statistic = [&](std::span<const double> weights) {
        return mean_ratio(sample, weights, least);
    };
    try {
        return statistics::bootstrap_interval(
                   clusters, statistic,
                   {.seed = options.seed, .resamples = options.resamples, .confidence = options.confidence})
            .interval;
    } catch (const NumericalError&) {
        return std::nullopt;  // too few of the samples have a case
    }
}

/// Of the same expression, or of several.
std::optional<MethodSummary> summarize(const Table& table, std::size_t region,
                                       std::span<const std::uint32_t> expressions, std::uint32_t method,
                                       const ComparisonOptions& options) {
    Sample sample;
    MethodSummary summary;
    double groups = 0;
    for (const std::uint32_t expression : expressions) {
        double error = 0;
        const auto& cases = table.of(region, expression, method);
        for (const auto& one : cases) {
            sample.add(one, one.error, one.nothing);
            error += one.error;
        }
        sample.end_group();
        if (cases.empty()) continue;
        summary.error += error / static_cast<double>(cases.size());
        ++groups;
    }
    if (groups == 0) return std::nullopt;
    summary.region = options.regions[region];
    summary.expression = expressions.size() == 1 ? table.expressions.name(expressions.front()) : "";
    summary.method = table.methods.name(method);
    summary.error /= groups;
    summary.cases = sample.above.size();
    summary.targets = sample.targets();
    const double error_share = mean_ratio(sample, std::vector<double>(summary.cases, 1.0), least_motion_mm);
    if (!std::isfinite(error_share)) return summary;
    summary.explained = 1 - error_share;
    if (const auto interval = interval_of(sample, table.one_source[method], least_motion_mm, options))
        summary.explained_interval = {1 - interval->high, 1 - interval->low};
    return summary;
}

/// One case per target: the mean over its sources.
Cases by_target(const Cases& cases) {
    Cases means;
    for (std::size_t begin = 0, end = 0; begin < cases.size(); begin = end) {
        Case mean{cases[begin].target, 0, 0, cases[begin].nothing};
        while (end < cases.size() && cases[end].target == mean.target) mean.error += cases[end++].error;
        mean.error /= static_cast<double>(end - begin);
        means.push_back(mean);
    }
    return means;
}

/// Adds first - second of the cases that both have.
void add_differences(Sample& sample, const Cases& first, const Cases& second) {
    const auto place = [](const Case& one) { return std::pair(one.target, one.source); };
    for (auto a = first.begin(), b = second.begin(); a != first.end() && b != second.end();) {
        if (place(*a) < place(*b)) {
            ++a;
        } else if (place(*b) < place(*a)) {
            ++b;
        } else {
            sample.add(*a, a->error - b->error, 1);
            ++a, ++b;
        }
    }
    sample.end_group();
}

/// Differences that add up to the mean of the groups' means: what each case adds to it.
std::vector<double> parts_of_mean(const Sample& sample) {
    std::vector<double> parts;
    std::size_t begin = 0;
    for (const std::size_t end : sample.ends) {
        for (std::size_t k = begin; k < end; ++k)
            parts.push_back(sample.above[k] / static_cast<double>((end - begin) * sample.ends.size()));
        begin = end;
    }
    return parts;
}

/// Per target the mean over the groups of its mean difference.
std::vector<double> of_targets(const Sample& sample) {
    std::map<std::uint32_t, std::pair<double, double>> sums;  // of means, and how many
    std::size_t begin = 0;
    for (const std::size_t end : sample.ends) {
        std::map<std::uint32_t, std::pair<double, double>> own;
        for (std::size_t k = begin; k < end; ++k) {
            auto& [sum, count] = own[sample.target[k]];
            sum += sample.above[k];
            ++count;
        }
        for (const auto& [target, mean] : own) {
            auto& [sum, count] = sums[target];
            sum += mean.first / mean.second;
            ++count;
        }
        begin = end;
    }
    std::vector<double> means;
    for (const auto& [target, sum] : sums) means.push_back(sum.first / sum.second);
    return means;
}

std::optional<double> corrected_dz(const std::vector<double>& differences) {
    if (differences.size() < fewest_people) return std::nullopt;
    try {
        return statistics::cohen_dz(differences) *
               statistics::hedges_correction(static_cast<double>(differences.size() - 1));
    } catch (const NumericalError&) {
        return std::nullopt;  // all are the same
    }
}

std::optional<MethodDifference> compare(const Table& table, std::size_t region,
                                        std::span<const std::uint32_t> expressions, std::uint32_t first,
                                        std::uint32_t second, const ComparisonOptions& options) {
    MethodDifference result;
    const bool pairs = table.one_source[first] && table.one_source[second];
    result.pairing = pairs ? Pairing::source_and_target : Pairing::target;
    Sample sample;
    for (const std::uint32_t expression : expressions) {
        const auto& one = table.of(region, expression, first);
        const auto& other = table.of(region, expression, second);
        if (pairs)
            add_differences(sample, one, other);
        else
            add_differences(sample, by_target(one), by_target(other));
    }
    if (sample.above.empty()) return std::nullopt;
    result.region = options.regions[region];
    result.expression = expressions.size() == 1 ? table.expressions.name(expressions.front()) : "";
    result.first = table.methods.name(first);
    result.second = table.methods.name(second);
    result.pairs = sample.above.size();
    result.targets = sample.targets();
    result.difference = mean_ratio(sample, std::vector<double>(result.pairs, 1.0), 0);
    result.interval = interval_of(sample, pairs, 0, options);
    result.dz = corrected_dz(of_targets(sample));
    const auto test = statistics::sign_flip_test(parts_of_mean(sample), sample.target,
                                                 {.seed = options.seed, .resamples = 5 * options.resamples});
    result.p = test.p;
    result.exact = test.exact;
    return result;
}

/// q of the differences of each two methods; those over all expressions apart.
void find_q(std::vector<MethodDifference>& differences, statistics::FalseDiscovery kind) {
    std::map<std::tuple<std::string, std::string, bool>, std::vector<MethodDifference*>> families;
    for (auto& one : differences) families[{one.first, one.second, one.expression.empty()}].push_back(&one);
    for (const auto& [key, family] : families) {
        std::vector<double> p;
        for (const auto* one : family) p.push_back(one->p);
        const auto q = statistics::false_discovery_q(p, kind);
        for (std::size_t k = 0; k < q.size(); ++k) family[k]->q = q[k];
    }
}

}  // namespace

void ComparisonOptions::check() const {
    if (regions.empty()) throw InputError("a comparison in no region; give one or more, such as zone");
    if (std::set(regions.begin(), regions.end()).size() < regions.size())
        throw InputError("a comparison in the same region twice; give each once");
    statistics::BootstrapOptions{.seed = seed, .resamples = resamples, .confidence = confidence}.check();
}

Comparison compare_methods(const CaseRowReader& read, const ComparisonOptions& options) {
    options.check();
    TableBuilder builder(options);
    read([&](const CaseRow& row) {
        if (row.estimator == run_estimator || is_anchor(row.key.method)) return;
        builder.take(row);
    });
    const Table table = builder.finish();
    Comparison result;
    result.unit = table.unit;
    std::vector<std::uint32_t> all(table.expressions.size());
    for (std::uint32_t k = 0; k < all.size(); ++k) all[k] = k;
    const auto methods = static_cast<std::uint32_t>(table.methods.size());
    const auto add = [&](std::size_t region, std::span<const std::uint32_t> expressions) {
        for (std::uint32_t one = 0; one < methods; ++one)
            if (auto summary = summarize(table, region, expressions, one, options))
                result.methods.push_back(std::move(*summary));
        for (std::uint32_t one = 0; one < methods; ++one)
            for (std::uint32_t other = one + 1; other < methods; ++other)
                if (auto difference = compare(table, region, expressions, one, other, options))
                    result.differences.push_back(std::move(*difference));
    };
    for (std::size_t region = 0; region < options.regions.size(); ++region) {
        for (const std::uint32_t& expression : all) add(region, std::span(&expression, 1));
        if (all.size() > 1) add(region, all);
    }
    find_q(result.differences, options.false_discovery);
    return result;
}

}  // namespace mimik::evaluation
