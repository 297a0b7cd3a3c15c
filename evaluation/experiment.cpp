#include "evaluation/experiment.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "base/text.h"
#include "evaluation/case_store.h"
#include "evaluation/cast.h"
#include "evaluation/target_unit.h"

namespace mimik::evaluation {

using database::ScanId;

namespace {

struct UnitRows {
    std::string unit;
    std::vector<CaseRow> rows;
};

/// One run: what its expressions share.
class ExperimentRun {
public:
    ExperimentRun(const PerformanceReader& reader, const facs::FacsCatalogue& catalogue, const ExperimentPlan& plan,
                  CaseStore& store, const std::function<void(const std::string&)>& progress)
        : reader_(reader), catalogue_(catalogue), plan_(plan), store_(store), progress_(progress) {}

    void run() {
        for (const auto& reason : plan_.left_out) failures_.add(reason);
        find_usable();
        for (const auto& planned : plan_.expressions) score(planned);
    }
    [[nodiscard]] std::vector<std::string> failures() const { return failures_.sorted(); }
    [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }
    [[nodiscard]] const std::vector<UnitRows>& anchors() const { return anchors_; }
    /// Expressions whose zones the catalogue drew.
    [[nodiscard]] const std::vector<std::string>& zones_by_catalogue() const { return zones_by_catalogue_; }

private:
    /// A neutral that cannot be used is reported once, not once per expression.
    void find_usable() {
        std::vector<char> usable(plan_.subjects.size(), 0);
        std::vector<std::string> said(plan_.subjects.size());
        base::parallel_for(usable.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = begin; s < end; ++s) try {
                    said[s] = reader_.check_neutral(plan_.subjects[s]);
                    usable[s] = 1;
                } catch (const std::exception& e) {
                    failures_.add(fmt::format("{}: takes part in no case: {}", plan_.subjects[s], e.what()));
                }
        });
        std::map<std::string, std::vector<std::string>> of_whom;
        for (std::size_t s = 0; s < usable.size(); ++s) {
            if (usable[s]) usable_.insert(plan_.subjects[s]);
            if (!said[s].empty()) of_whom[said[s]].push_back(plan_.subjects[s]);
        }
        for (const auto& [what, whom] : of_whom)
            remarks_.push_back(fmt::format("{}{}: {}", whom.front(),
                                           whom.size() > 1 ? fmt::format(" and {} more", whom.size() - 1) : "", what));
    }

    void score(const PlannedExpression& planned) {
        std::vector<ScanId> performances;
        for (const auto& id : planned.performances)
            if (usable_.contains(id.subject)) performances.push_back(id);
        const animation::LearningTask task{planned.expression, reader_.workspace().average(), catalogue_,
                                           reader_.workspace().registrations()};
        const auto cast = gather_cast(reader_, task, performances, plan_.methods, failures_, plan_.zones);
        const auto& code = planned.expression.code();
        const std::size_t count = cast.participants.size();
        if (count < fewest_subjects)
            return failures_.add(fmt::format("expression '{}': left out: {} left; an experiment needs {} or more", code,
                                             base::counted(count, "subject is", "subjects are"), fewest_subjects));
        for (const auto& remark : cast.remarks)
            if (std::find(remarks_.begin(), remarks_.end(), remark) == remarks_.end()) remarks_.push_back(remark);
        if (cast.zone_from == ZoneSource::catalogue && plan_.zones != ZoneSource::catalogue)
            zones_by_catalogue_.push_back(code);
        std::vector<UnitRows> anchors(count);
        in_order(
            count,
            [&](std::size_t t) {
                auto rows = score_target(reader_, plan_, cast, t, failures_);
                anchors[t].rows = anchor_rows(reader_, cast, t, failures_);
                if (progress_) progress_(fmt::format("{} {}", code, cast.participants[t].subject));
                return rows;
            },
            [&](std::size_t t, const std::vector<CaseRow>& rows) {
                anchors[t].unit = fmt::format("{} {}", code, cast.participants[t].subject);
                store_.append(anchors[t].unit, rows);
            });
        std::move(anchors.begin(), anchors.end(), std::back_inserter(anchors_));
    }

    const PerformanceReader& reader_;
    const facs::FacsCatalogue& catalogue_;
    const ExperimentPlan& plan_;
    CaseStore& store_;
    const std::function<void(const std::string&)>& progress_;
    FailureList failures_;
    std::set<std::string> usable_;
    std::vector<UnitRows> anchors_;
    std::vector<std::string> remarks_, zones_by_catalogue_;
};

/// Mean of what is known.
template <class Number>
std::optional<double> mean_of(const std::map<std::string, Score>& scores, const Number& number) {
    std::size_t count = 0;
    for (const auto& [expression, score] : scores) count += std::invoke(number, score).has_value() ? 1 : 0;
    if (count == 0) return std::nullopt;
    double mean = 0;
    for (const auto& [expression, score] : scores)
        mean += std::invoke(number, score).value_or(0) / static_cast<double>(count);
    return mean;
}

Faults mean_faults(const std::map<std::string, Score>& scores) {
    Faults mean;
    Faults::each_field(mean, [&](const std::string_view name, std::optional<double>& value) {
        value = mean_of(scores, [&](const Score& score) {
            std::optional<double> own;
            Faults::each_field(score.faults, [&](const std::string_view other, const std::optional<double>& number) {
                if (other == name) own = number;
            });
            return own;
        });
    });
    return mean;
}

MethodScores scores_of_method(const animation::Method& method, const ExperimentPlan& plan, const ScoreTable& table) {
    MethodScores scores{.method = method.title(),
                        .kind = method.needs(),
                        .reference = method.needs_truth(),
                        .bound = method.name() == bound_of(method.needs()),
                        .per_expression = {},
                        .explained = {},
                        .explained_median = {},
                        .explained_whole = {},
                        .share = {},
                        .faults = {}};
    const auto found = table.find(method.name());
    for (const auto& planned : plan.expressions) {
        auto& score = scores.per_expression[planned.expression.code()];
        if (found == table.end()) continue;
        if (const auto own = found->second.find(planned.expression.code()); own != found->second.end())
            score = own->second;
    }
    scores.explained = mean_of(scores.per_expression, &Score::explained);
    scores.explained_median = mean_of(scores.per_expression, &Score::explained_median);
    scores.explained_whole = mean_of(scores.per_expression, &Score::explained_whole);
    scores.faults = mean_faults(scores.per_expression);
    return scores;
}

/// As tables print it.
const char* said_of(Alignment alignment, bool truth) {
    switch (alignment) {
        case Alignment::none:
            return "nothing: each scan as the scanner saw it";
        case Alignment::landmarks:
            return "landmarks";
        case Alignment::given:
            if (truth) return "true pose";
            break;
        case Alignment::stable_region:
            break;
    }
    return "ICP on the stable region";
}

/// Beside the cases, where those are kept. @return all of them
std::vector<CaseRow> keep_anchors(std::span<const UnitRows> units, const std::filesystem::path& cases) {
    std::vector<CaseRow> all;
    for (const auto& unit : units) all.insert(all.end(), unit.rows.begin(), unit.rows.end());
    if (cases.empty()) return all;
    CaseStore store(cases.parent_path() / "anchors.csv");
    for (const auto& unit : units) store.append(unit.unit, unit.rows);
    store.finish();
    return all;
}

void add_shares(std::vector<MethodScores>& rows) {
    for (auto& row : rows)
        for (const auto& other : rows)
            if (other.bound && other.kind == row.kind && !row.reference && row.explained &&
                other.explained.value_or(0) > 0)
                row.share = *row.explained / *other.explained;
}

}  // namespace

ExperimentReport run_experiment(const PerformanceReader& reader, const facs::FacsCatalogue& catalogue,
                                const ExperimentPlan& plan, const std::filesystem::path& cases,
                                const std::function<void(const std::string&)>& progress) {
    const auto start = std::chrono::steady_clock::now();
    auto store = cases.empty() ? std::make_unique<CaseStore>() : std::make_unique<CaseStore>(cases);
    ExperimentRun run(reader, catalogue, plan, *store, progress);
    run.run();
    if (store->units() == 0)
        throw InputError(fmt::format("no expression is left to score ({})", fmt::join(run.failures(), "; ")));
    const auto table = scores_of([&](const auto& visit) { store->read(visit); });
    store->finish();
    const auto anchor_rows = keep_anchors(run.anchors(), cases);

    ExperimentReport report;
    report.subjects = plan.subjects;
    for (const auto& planned : plan.expressions) report.expressions.push_back(planned.expression);
    report.whole_face = plan.whole_face;
    report.zones = to_string(plan.zones);
    report.zones_by_catalogue = run.zones_by_catalogue();
    report.alignment = said_of(plan.alignment, reader.has_truth());
    report.truth = reader.truth_origin();
    for (const auto& method : plan.methods) {
        auto scores = scores_of_method(*method, plan, table);
        if (method->name() == baseline_method)
            report.nothing = std::move(scores);
        else
            report.rows.push_back(std::move(scores));
    }
    add_shares(report.rows);
    report.anchors = anchors_of(anchor_rows, report.expressions);
    report.failures = run.failures();
    report.remarks = run.remarks();
    report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report;
}

ExperimentReport run_experiment(const preprocessing::Workspace& workspace, const facs::FacsCatalogue& catalogue,
                                const ExperimentOptions& options) {
    const PerformanceReader reader(workspace);
    return run_experiment(reader, catalogue, plan_experiment(workspace, catalogue, options, reader.has_truth()));
}

}  // namespace mimik::evaluation
