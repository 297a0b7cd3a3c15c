#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/anchors.h"
#include "evaluation/case_store.h"
#include "evaluation/estimator.h"
#include "evaluation/performance.h"
#include "evaluation/plan.h"
#include "evaluation/score.h"
#include "evaluation/shard.h"

namespace mimik::evaluation {

struct MethodScores {
    std::string method;  ///< as tables print it; "mean@0.8" at another magnitude than 1
    animation::SourceKind kind = animation::SourceKind::one_source;
    bool reference = false;                       ///< it looks at the truth
    bool bound = false;                           ///< the reference that shares of its kind are taken of
    std::map<std::string, Score> per_expression;  ///< by code; an expression without a case has an empty score
    std::optional<double> explained;              ///< mean over the expressions that have a case
    std::optional<double> explained_median;
    std::optional<double> explained_whole;
    std::optional<double> share;  ///< explained / explained by the bound of the same kind
    Faults faults = {};           ///< mean over the expressions in which each is known
};

struct ExperimentReport {
    std::vector<std::string> subjects;
    std::vector<facs::Expression> expressions;
    bool whole_face = true;  ///< whether the whole face was scored
    bool on_itself = false;  ///< each source was its own target: no figure of one person on another
    std::string zones;       ///< "truth", "data" or "catalogue"
    std::vector<std::string> zones_by_catalogue =
        {};                 ///< expressions whose own zone had to be, though zones says other
    std::string alignment;  ///< "true pose" or "ICP on the stable region"
    std::optional<TruthOrigin> truth;
    MethodScores nothing;
    std::vector<MethodScores> rows;
    std::vector<std::string> failures;      ///< what gave no answer, with the reason
    std::vector<Anchor> anchors = {};       ///< scanner floor and performer floor
    std::vector<std::string> remarks = {};  ///< what is worth knowing, each once, with the number of subjects
    double seconds = 0.0;
};

/// Scores methods on every ordered pair source -> target of a workspace, as docs/algorithms/scoring.md defines it; or,
/// where the plan says so, each source on itself.
/// Subjects that must not be shown take part in no case. A case whose method gives no answer counts as doing nothing; a
/// face that cannot be read takes part in no case; a target whose zone does not see its expressive scan has no case in
/// any row; all are listed.
///
/// Memory: faces are read when they are needed, one subject's at a time per thread (about 30 MB), beside 256 MB of
/// lessons, whatever the number of expressions. Where the lessons of all subjects take more (true fields of 500
/// subjects do), the rest is studied again, and a mean holds those of its sources once per thread. Rows go to the disk
/// as they come.
/// An expression of which fewer than 3 subjects are left is left out and listed.
/// @param plan   of plan_experiment() for this workspace
/// @param cases  where the rows are kept, one line per number; empty: nowhere that outlives the run
/// @throws InputError if no expression is left.
[[nodiscard]] ExperimentReport run_experiment(const PerformanceReader& reader, const facs::FacsCatalogue& catalogue,
                                              const ExperimentPlan& plan, const std::filesystem::path& cases = {},
                                              const std::function<void(const std::string&)>& progress = {});

/// Whom an experiment tells how far it is.
struct RunWatch {
    std::function<void(const std::string&)> unit = {};  ///< "12 bs003" is done; from any thread
    /// All targets of an expression are done: its code, and the scores of what is stored so far.
    std::function<void(const std::string&, const ScoreTable&)> expression = {};
};

/// The same with rows in a store. Units that it holds already, of a run of the same plan that was stopped, are not done
/// again: the rows are those of one run from start to end, byte for byte.
[[nodiscard]] ExperimentReport run_experiment(const PerformanceReader& reader, const facs::FacsCatalogue& catalogue,
                                              const ExperimentPlan& plan, CaseStore& store, const RunWatch& watch = {});

/// Stores the rows of the plan's units in `range` and of the casts that they need, those that the store holds already
/// left out; what an earlier run of the same range stored is the beginning. Reports nothing: CaseStore::of_files and
/// run_experiment() do, over all ranges.
/// A unit that fails is a row of its own and stops nothing.
void run_units(const PerformanceReader& reader, const facs::FacsCatalogue& catalogue, const ExperimentPlan& plan,
               UnitRange range, CaseStore& store, const std::function<void(const std::string&)>& progress = {});

/// Judges the cases of one target of one expression again and shows them. Cases without an answer are not shown.
/// @param plan  with the methods that are wanted; what an estimator adds is left out
/// @throws InputError if the plan has no such expression, or the target takes no part in it.
void visit_cases(const PerformanceReader& reader, const facs::FacsCatalogue& catalogue, const ExperimentPlan& plan,
                 const std::string& expression, const std::string& target,
                 const std::function<void(const CaseKey&, const JudgedFace&)>& visit);

/// The same for who wants no more than the report. @throws as plan_experiment() and run_experiment().
[[nodiscard]] ExperimentReport run_experiment(const preprocessing::Workspace& workspace,
                                              const facs::FacsCatalogue& catalogue,
                                              const ExperimentOptions& options = {});

}  // namespace mimik::evaluation
