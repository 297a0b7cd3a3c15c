#include "evaluation/run_comparison.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "base/errors.h"
#include "evaluation/score.h"

namespace mimik::evaluation {
namespace {

std::string in_run(const std::string& method, const std::string& run) { return fmt::format("{} ({})", method, run); }

MethodOfRuns& entry(std::vector<MethodOfRuns>& methods, const MethodSummary& one, std::size_t runs) {
    const auto found = std::find_if(methods.begin(), methods.end(), [&](const MethodOfRuns& known) {
        return known.region == one.region && known.expression == one.expression && known.method == one.method;
    });
    if (found != methods.end()) return *found;
    methods.push_back({one.region, one.expression, one.method, std::vector<std::optional<MethodSummary>>(runs)});
    return methods.back();
}

/// One method's rows of every run, each run's under a name of its own, beside doing nothing of the first: a difference
/// of errors needs no more of it than that it is there.
CaseRowReader rows_of(std::span<const NamedRun> runs, const std::string& method) {
    return [runs, method](const auto& visit) {
        for (std::size_t r = 0; r < runs.size(); ++r)
            runs[r].read([&](const CaseRow& row) {
                const bool nothing = row.key.method == baseline_method;
                if (nothing ? r > 0 : variant_of(row.key) != method) return;
                auto own = row;
                if (!nothing) {
                    own.key.method = in_run(method, runs[r].name);
                    own.key.magnitude = 1;
                }
                visit(own);
            });
    };
}

void check_names(std::span<const NamedRun> runs) {
    if (runs.size() < 2) throw InputError(fmt::format("{} runs are to be compared; give two or more", runs.size()));
    std::set<std::string> names;
    for (const auto& run : runs)
        if (!names.insert(run.name).second)
            throw InputError(fmt::format("two runs are called '{}'; give each a name of its own", run.name));
}

}  // namespace

RunComparison compare_runs(std::span<const NamedRun> runs, const ComparisonOptions& options) {
    check_names(runs);
    RunComparison answer;
    for (std::size_t r = 0; r < runs.size(); ++r) {
        const auto own = compare_methods(runs[r].read, options);
        if (r > 0 && own.unit != answer.unit)
            throw InputError(fmt::format("run '{}' is in {}, '{}' in {}; choose a metric of one unit", runs[0].name,
                                         answer.unit, runs[r].name, own.unit));
        answer.runs.push_back(runs[r].name);
        answer.unit = own.unit;
        for (const auto& one : own.methods) entry(answer.methods, one, runs.size()).runs[r] = one;
    }
    std::set<std::string> done;
    for (const auto& one : answer.methods) {
        if (one.method == baseline_method || !one.runs.front() || !done.insert(one.method).second) continue;
        const auto first = in_run(one.method, runs.front().name);
        for (auto& difference : compare_methods(rows_of(runs, one.method), options).differences)
            if (difference.first == first && difference.second != baseline_method)
                answer.differences.push_back(std::move(difference));
    }
    return answer;
}

}  // namespace mimik::evaluation
