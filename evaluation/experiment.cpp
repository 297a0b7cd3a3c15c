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

/// Rows that say how the run went: they lie beside the measures in the store, so that a run which goes on where another
/// was stopped tells the whole story.
namespace note {
constexpr const char* failure = "failure";
constexpr const char* remark = "remark";
constexpr const char* zone = "zone";                  // its reason: who drew it
constexpr const char* participants = "participants";  // its value: how many
}  // namespace note

CaseRow note_row(const std::string& expression, const char* kind, const std::string& text,
                 const std::string& who = {}) {
    return {{"", who, expression, ""}, std::string(run_estimator), "", kind, std::nullopt, "", text};
}

/// One run: what its expressions share.
class ExperimentRun {
public:
    ExperimentRun(const PerformanceReader& reader, const facs::FacsCatalogue& catalogue, const ExperimentPlan& plan,
                  CaseStore& store, const RunWatch& watch, UnitRange range = {})
        : reader_(reader), catalogue_(catalogue), plan_(plan), store_(store), watch_(watch), range_(range) {}

    void run() {
        for (const auto& reason : plan_.left_out) failures_.add(reason);
        find_usable();
        for (const auto& planned : plan_.expressions) {
            score(planned);
            if (watch_.expression)
                watch_.expression(planned.expression.code(),
                                  scores_of([&](const auto& visit) { store_.read(visit); },
                                            plan_.on_itself ? Pairs::source_on_itself : Pairs::of_two));
        }
    }
    /// The units of the range alone.
    void run_range() {
        std::vector<const PlannedExpression*> open;
        std::size_t first = 0;
        for (const auto& planned : plan_.expressions) {
            first_unit_[planned.expression.code()] = first;
            const std::size_t begin = first;
            for (const auto& id : planned.performances) first += plan_.is_target(id.subject) ? 1 : 0;
            // One that no target shows has no unit, but a cast like all others: whoever begins or ends there stores it.
            const bool here = begin == first ? range_.begin <= begin && begin <= range_.end
                                             : std::max(begin, range_.begin) < std::min(first, range_.end);
            if (!here) continue;
            // Expressions are done one after another: the cast of one says that those before it are whole.
            if (store_.has(cast_unit(planned.expression.code()))) open.clear();
            open.push_back(&planned);
        }
        if (open.empty()) return;
        find_usable();
        for (const auto* planned : open) score(*planned);
    }
    /// One unit, whose cases are shown and not stored.
    void visit(const PlannedExpression& planned, const std::string& target, const CaseVisitor& visit) {
        find_usable();
        FailureList failures;
        const auto cast = cast_of(planned, failures);
        for (std::size_t t = 0; t < cast.participants.size(); ++t)
            if (cast.participants[t].subject == target) {
                (void)score_target(reader_, plan_, cast, t, failures, visit);
                return;
            }
        throw InputError(fmt::format("{} takes no part in expression '{}'{}{}", base::in_quotes(target),
                                     planned.expression.code(), failures_.sorted().empty() ? "" : ": ",
                                     fmt::join(failures_.sorted(), "; ")));
    }
    [[nodiscard]] std::vector<std::string> failures() const { return failures_.sorted(); }
    [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }

private:
    static std::string cast_unit(const std::string& code) { return code + " cast"; }
    static std::string target_unit(const std::string& code, const ScanId& target) {
        return fmt::format("{} {}", code, target.subject);
    }

    /// Whether an earlier run did every unit of an expression. Who takes no part has none, so the cast says how many.
    [[nodiscard]] bool all_stored(const PlannedExpression& planned) const {
        const auto& code = planned.expression.code();
        if (!store_.has(cast_unit(code))) return false;
        std::size_t stored = 0;
        for (const auto& id : planned.performances) stored += store_.has(target_unit(code, id)) ? 1 : 0;
        return stored == stored_targets().at(code);
    }
    /// How many targets each stored cast has.
    [[nodiscard]] const std::map<std::string, std::size_t>& stored_targets() const {
        if (!stored_targets_) {
            stored_targets_.emplace();
            store_.read([&](const CaseRow& row) {
                if (row.estimator == run_estimator && row.metric == note::participants)
                    (*stored_targets_)[row.key.expression] = static_cast<std::size_t>(row.value.value_or(0));
            });
        }
        return *stored_targets_;
    }

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

    /// Whether the range has the unit of participant t.
    [[nodiscard]] bool in_range(const PlannedExpression& planned, const ScanId& participant) const {
        if (range_ == UnitRange()) return true;
        std::size_t unit = first_unit_.at(planned.expression.code());
        for (const auto& id : planned.performances) {
            if (id.subject == participant.subject) break;
            unit += plan_.is_target(id.subject) ? 1 : 0;
        }
        return range_.contains(unit);
    }

    [[nodiscard]] Cast cast_of(const PlannedExpression& planned, FailureList& failures) const {
        std::vector<ScanId> performances;
        for (const auto& id : planned.performances)
            if (usable_.contains(id.subject)) performances.push_back(id);
        const animation::LearningTask task{planned.expression, reader_.workspace().average(), catalogue_,
                                           reader_.workspace().registrations()};
        return gather_cast(reader_, task, performances, plan_.methods, failures, plan_.zones);
    }

    void score(const PlannedExpression& planned) {
        const auto& code = planned.expression.code();
        if (all_stored(planned)) {
            if (watch_.unit)
                for (const auto& id : planned.performances)
                    if (store_.has(target_unit(code, id))) watch_.unit(target_unit(code, id));
            return;
        }
        FailureList failures;
        const auto cast = cast_of(planned, failures);
        std::vector<std::size_t> targets;
        for (std::size_t t = 0; t < cast.participants.size(); ++t)
            if (plan_.is_target(cast.participants[t].subject)) targets.push_back(t);
        const bool enough = cast.participants.size() >= plan_.fewest();
        if (!enough)
            failures.add(fmt::format("expression '{}': left out: {} left; an experiment needs {} or more", code,
                                     base::counted(cast.participants.size(), "subject is", "subjects are"),
                                     plan_.fewest()));
        store_cast(cast, enough ? targets.size() : 0, failures);
        std::erase_if(targets, [&](std::size_t t) { return !in_range(planned, cast.participants[t]); });
        if (enough) score_targets(cast, targets);
    }

    void store_cast(const Cast& cast, std::size_t targets, const FailureList& failures) {
        const auto& code = cast.expression.code();
        if (store_.has(cast_unit(code))) return;
        std::vector<CaseRow> rows = {note_row(code, note::participants, "")};
        rows.back().value = static_cast<double>(targets);
        rows.back().unit = "targets";
        if (cast.zone_from == ZoneSource::catalogue && plan_.zones != ZoneSource::catalogue && targets > 0)
            rows.push_back(note_row(code, note::zone, to_string(cast.zone_from)));
        for (const auto& remark : cast.remarks) rows.push_back(note_row(code, note::remark, remark));
        for (const auto& failure : failures.sorted()) rows.push_back(note_row(code, note::failure, failure));
        store_.append(cast_unit(code), rows);
    }

    void score_targets(const Cast& cast, const std::vector<std::size_t>& targets) {
        const auto& code = cast.expression.code();
        std::vector<std::size_t> open;
        for (const auto t : targets)
            if (!store_.has(target_unit(code, cast.participants[t])))
                open.push_back(t);
            else if (watch_.unit)
                watch_.unit(target_unit(code, cast.participants[t]));
        in_order(
            open.size(),
            [&](std::size_t k) {
                const auto& target = cast.participants[open[k]];
                FailureList failures;
                auto rows = score_target(reader_, plan_, cast, open[k], failures);
                // Floors are measured as cases are aligned when nothing else is asked for.
                if (plan_.alignment == Alignment::given)
                    for (auto& row : anchor_rows(reader_, cast, open[k], failures)) rows.push_back(std::move(row));
                for (const auto& failure : failures.sorted())
                    rows.push_back(note_row(code, note::failure, failure, target.subject));
                if (watch_.unit) watch_.unit(target_unit(code, target));
                return rows;
            },
            [&](std::size_t k, const std::vector<CaseRow>& rows) {
                store_.append(target_unit(code, cast.participants[open[k]]), rows);
            });
    }

    const PerformanceReader& reader_;
    const facs::FacsCatalogue& catalogue_;
    const ExperimentPlan& plan_;
    CaseStore& store_;
    const RunWatch& watch_;
    UnitRange range_;
    std::map<std::string, std::size_t> first_unit_;  // by expression, where a range is asked for
    FailureList failures_;
    std::set<std::string> usable_;
    std::vector<std::string> remarks_;
    mutable std::optional<std::map<std::string, std::size_t>> stored_targets_;  // of an earlier run
};

/// What the rows of a whole run tell beside measures.
struct RunNotes {
    std::vector<std::string> failures, remarks, zones_by_catalogue;  ///< failures sorted, remarks as they came
    std::vector<CaseRow> anchors = {};
};

void add_once(std::vector<std::string>& list, const std::string& text) {
    if (std::find(list.begin(), list.end(), text) == list.end()) list.push_back(text);
}

RunNotes notes_of(const CaseStore& store, const ExperimentRun& run) {
    RunNotes notes{run.failures(), run.remarks(), {}};
    store.read([&](const CaseRow& row) {
        if (is_anchor(row.key.method)) notes.anchors.push_back(row);
        if (row.estimator != run_estimator) return;
        if (row.metric == note::failure) add_once(notes.failures, row.reason);
        if (row.metric == note::remark) add_once(notes.remarks, row.reason);
        if (row.metric == note::zone) add_once(notes.zones_by_catalogue, row.key.expression);
    });
    std::sort(notes.failures.begin(), notes.failures.end());
    return notes;
}

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

MethodScores scores_of_method(const animation::Method& method, double magnitude, const ExperimentPlan& plan,
                              const ScoreTable& table) {
    MethodScores scores{.method = variant_of(method.title(), magnitude),
                        .kind = method.needs(),
                        .reference = method.needs_truth(),
                        .bound = method.name() == bound_of(method.needs()),
                        .per_expression = {},
                        .explained = {},
                        .explained_median = {},
                        .explained_whole = {},
                        .share = {},
                        .faults = {}};
    const auto found = table.find(variant_of(method.name(), magnitude));
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

/// Of what a method explains, the part of what the bound of its kind does.
void add_shares(std::vector<MethodScores>& rows) {
    for (auto& row : rows)
        for (const auto& other : rows)
            if (other.bound && other.kind == row.kind && !row.reference && row.explained &&
                other.explained.value_or(0) > 0)
                row.share = *row.explained / *other.explained;
}

}  // namespace

ExperimentReport run_experiment(const PerformanceReader& reader, const facs::FacsCatalogue& catalogue,
                                const ExperimentPlan& plan, CaseStore& store, const RunWatch& watch) {
    const auto start = std::chrono::steady_clock::now();
    ExperimentRun run(reader, catalogue, plan, store, watch);
    run.run();
    auto notes = notes_of(store, run);
    const auto table = scores_of([&](const auto& visit) { store.read(visit); },
                                 plan.on_itself ? Pairs::source_on_itself : Pairs::of_two);
    if (table.empty())
        throw InputError(fmt::format("no expression is left to score ({})", fmt::join(notes.failures, "; ")));
    store.finish();

    ExperimentReport report;
    report.subjects = plan.subjects;
    for (const auto& planned : plan.expressions) report.expressions.push_back(planned.expression);
    report.whole_face = plan.whole_face;
    report.on_itself = plan.on_itself;
    report.zones = to_string(plan.zones);
    report.zones_by_catalogue = std::move(notes.zones_by_catalogue);
    report.alignment = said_of(plan.alignment, reader.has_truth());
    report.truth = reader.truth_origin();
    for (const auto& method : plan.methods)
        for (const double magnitude : plan.magnitudes_of(*method)) {
            auto scores = scores_of_method(*method, magnitude, plan, table);
            if (method->name() == baseline_method)
                report.nothing = std::move(scores);
            else
                report.rows.push_back(std::move(scores));
        }
    add_shares(report.rows);
    report.anchors = anchors_of(notes.anchors, report.expressions);
    report.failures = std::move(notes.failures);
    report.remarks = std::move(notes.remarks);
    report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report;
}

void run_units(const PerformanceReader& reader, const facs::FacsCatalogue& catalogue, const ExperimentPlan& plan,
               UnitRange range, CaseStore& store, const std::function<void(const std::string&)>& progress) {
    const RunWatch watch{.unit = progress};
    ExperimentRun(reader, catalogue, plan, store, watch, range).run_range();
}

void visit_cases(const PerformanceReader& reader, const facs::FacsCatalogue& catalogue, const ExperimentPlan& plan,
                 const std::string& expression, const std::string& target, const CaseVisitor& visit) {
    const auto planned = std::find_if(plan.expressions.begin(), plan.expressions.end(),
                                      [&](const auto& one) { return one.expression.code() == expression; });
    if (planned == plan.expressions.end())
        throw InputError(fmt::format("expression '{}' is none of the experiment", expression));
    auto bare = plan;
    bare.estimators.clear();
    CaseStore unused;
    const RunWatch watch;
    ExperimentRun(reader, catalogue, bare, unused, watch).visit(*planned, target, visit);
}

ExperimentReport run_experiment(const PerformanceReader& reader, const facs::FacsCatalogue& catalogue,
                                const ExperimentPlan& plan, const std::filesystem::path& cases,
                                const std::function<void(const std::string&)>& progress) {
    if (!cases.empty()) {
        CaseStore store(cases);
        return run_experiment(reader, catalogue, plan, store, RunWatch{.unit = progress});
    }
    CaseStore store;
    return run_experiment(reader, catalogue, plan, store, RunWatch{.unit = progress});
}

ExperimentReport run_experiment(const preprocessing::Workspace& workspace, const facs::FacsCatalogue& catalogue,
                                const ExperimentOptions& options) {
    const PerformanceReader reader(workspace);
    return run_experiment(reader, catalogue, plan_experiment(workspace, catalogue, options, reader.has_truth()));
}

}  // namespace mimik::evaluation
