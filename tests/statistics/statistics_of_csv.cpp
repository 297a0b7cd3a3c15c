// statistics_of_csv FILE: every function of statistics/ on one table, as lines "name value"; peers.py compares them.
// Columns: x, y (measures of the same things), p (0 to 1), source, target (whole numbers).
#include <cstdint>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "statistics/bootstrap.h"
#include "statistics/correlation.h"
#include "statistics/describe.h"
#include "statistics/effect_size.h"
#include "statistics/false_discovery.h"
#include "statistics/intraclass.h"
#include "statistics/sign_flip.h"
#include "statistics/t_test.h"
#include "statistics/variance_components.h"
#include "statistics/wilcoxon.h"

namespace {

using namespace mimik;

struct Columns {
    std::vector<double> x, y, p, differences, raters;
    std::vector<std::uint32_t> source, target, row;
};

void tell(const std::string& name, double value) { std::cout << fmt::format("{} {:.17g}\n", name, value); }
void tell(const std::string& name, const statistics::Interval& interval) {
    tell(name + ".low", interval.low);
    tell(name + ".high", interval.high);
}

Columns read(const std::string& file) {
    const std::string text = base::read_text(file);
    base::CsvReader csv(text, file);
    Columns columns;
    while (csv.next()) {
        const auto number = [&](const char* name) { return csv.number(csv.column(name)); };
        columns.x.push_back(number("x"));
        columns.y.push_back(number("y"));
        columns.p.push_back(number("p"));
        columns.source.push_back(static_cast<std::uint32_t>(number("source")));
        columns.target.push_back(static_cast<std::uint32_t>(number("target")));
        columns.row.push_back(static_cast<std::uint32_t>(columns.row.size()));
        columns.differences.push_back(columns.x.back() - columns.y.back());
        columns.raters.insert(columns.raters.end(), {columns.x.back(), columns.y.back()});
    }
    return columns;
}

void tell_tests(const Columns& of) {
    const auto description = statistics::describe(of.x);
    tell("mean", description.mean);
    tell("median", description.median);
    tell("sd", description.sd.value());
    tell("rms", description.rms);
    tell("p05", description.p05);
    tell("p95", description.p95);
    tell("t_interval", statistics::t_interval(of.x, 0.9));
    const auto t = statistics::paired_t_test(of.x, of.y);
    tell("t", t.t);
    tell("t.p", t.p);
    tell("t.difference", t.interval);
    const auto ranks = statistics::wilcoxon_signed_rank(of.differences);
    tell("wilcoxon.positive", ranks.positive);
    tell("wilcoxon.negative", ranks.negative);
    tell("wilcoxon.p", ranks.p);
    tell("wilcoxon.exact", ranks.z ? 0 : 1);
    tell("wilcoxon.normal.p", statistics::wilcoxon_signed_rank(of.differences, {.exact_up_to = 0}).p);
    tell("dz", statistics::cohen_dz(of.differences));
    tell("hedges", statistics::hedges_correction(t.degrees));
    tell("cliff", statistics::cliff_delta(of.x, of.y));
    using Correlate = statistics::Correlation (*)(std::span<const double>, std::span<const double>, double confidence);
    for (const auto& [name, correlate] : {std::pair<std::string, Correlate>{"pearson", statistics::pearson},
                                          {"spearman", statistics::spearman},
                                          {"kendall", statistics::kendall}}) {
        const auto r = correlate(of.x, of.y, 0.95);
        tell(name, r.value);
        tell(name + ".p", r.p);
        tell(name + ".interval", r.interval);
    }
    for (const auto kind :
         {statistics::FalseDiscovery::benjamini_hochberg, statistics::FalseDiscovery::benjamini_yekutieli}) {
        const auto q = statistics::false_discovery_q(of.p, kind);
        for (std::size_t k = 0; k < q.size(); ++k) tell(fmt::format("{}.{}", to_string(kind), k), q[k]);
    }
}

void tell_variances(const Columns& of) {
    const auto icc = statistics::intraclass(of.raters, 2);
    tell("icc", icc.value);
    tell("icc.f", icc.f);
    tell("icc.p", icc.p);
    tell("icc.interval", icc.interval);
    const auto parts = statistics::variance_components(of.x, of.source, of.target);
    for (const auto& [name, part] : {std::pair<std::string, statistics::VarianceComponent>{"source", parts.source},
                                     {"target", parts.target},
                                     {"residual", parts.residual}}) {
        tell(name + ".variance", part.variance);
        tell(name + ".share", part.share);
        tell(name + ".degrees", static_cast<double>(part.degrees));
        if (name != "residual") tell(name + ".f", part.f);
        if (name != "residual") tell(name + ".p", part.p);
    }
}

void tell_resampled(const Columns& of) {
    const auto bootstrap = [&](const std::string& name, const statistics::Clusters& clusters,
                               const statistics::WeightedStatistic& statistic) {
        for (const auto kind : {statistics::IntervalKind::percentile, statistics::IntervalKind::bca}) {
            const auto result = statistics::bootstrap_interval(clusters, statistic, {.resamples = 20000, .kind = kind});
            tell(fmt::format("{}.{}", name, to_string(kind)), result.interval);
            if (kind == statistics::IntervalKind::percentile) continue;
            tell(name + ".error", result.standard_error);
            tell(name + ".z0", result.bias_correction);
            tell(name + ".a", result.acceleration);
        }
    };
    using statistics::Clusters;
    bootstrap("rows.mean", Clusters::one_way(of.row), statistics::weighted_mean(of.x));
    bootstrap("rows.ratio", Clusters::one_way(of.row), statistics::weighted_ratio(of.y, of.x));
    bootstrap("one_way.mean", Clusters::one_way(of.target), statistics::weighted_mean(of.x));
    bootstrap("two_way.mean", Clusters::two_way(of.source, of.target), statistics::weighted_mean(of.x));
    bootstrap("people.mean", Clusters::pairs_of_people(of.source, of.target), statistics::weighted_mean(of.x));
    for (const auto& [name, clusters] :
         {std::pair<std::string, std::vector<std::uint32_t>>{"rows", of.row}, {"targets", of.target}}) {
        const auto test = statistics::sign_flip_test(of.differences, clusters);
        tell(name + ".flips.p", test.p);
        tell(name + ".flips.exact", test.exact ? 1 : 0);
        tell(name + ".flips.drawn.p", statistics::sign_flip_test(of.differences, clusters, {.exact_up_to = 0}).p);
    }
}

}  // namespace

int main(int count, char** arguments) {
    try {
        if (count != 2) throw InputError("statistics_of_csv: give one file");
        const auto columns = read(arguments[1]);
        tell_tests(columns);
        tell_variances(columns);
        tell_resampled(columns);
        return 0;
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
