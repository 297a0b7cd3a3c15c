#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/case_score.h"
#include "evaluation/method.h"
#include "evaluation/performance.h"
#include "facs/facs_catalogue.h"
#include "preprocessing/workspace.h"

namespace mimik::evaluation {

struct ExperimentOptions {
    std::vector<std::string> expressions = {"1", "2", "4", "12", "14", "15", "17", "20", "12L"};  ///< the thesis's nine
    std::vector<Method> methods = {method_by_name("thesis"), method_by_name("default"), method_by_name("mean")};
    bool reference = true;   ///< true-field reference rows, where the database has a truth
    bool whole_face = true;  ///< second figure over all measured vertices
    int max_sources = 0;     ///< per target, the next ones in the list after it; 0 = all other subjects
    void check() const;      ///< throws InputError
};

struct MethodScores {
    std::string method;
    RowKind kind = RowKind::one_source;
    bool reference = false;
    std::map<std::string, Score> per_expression;
    double explained = 0.0;  ///< mean over the expressions
    double explained_median = 0.0;
    double explained_whole = 0.0;
    std::optional<double> share;  ///< explained / explained by the true field of the same kind
};

struct ExperimentReport {
    std::vector<std::string> subjects;
    std::vector<std::string> expressions;
    bool whole_face = true;  ///< whether the whole face was scored
    std::string zones;       ///< "truth" or "catalogue"
    std::string alignment;   ///< "true pose" or "ICP on the stable region"
    std::optional<TruthOrigin> truth;
    std::vector<MethodScores> rows;
    std::vector<std::string> failures;  ///< what gave no answer, with the reason
    double seconds = 0.0;
};

/// Scores methods on every ordered pair source -> target of a workspace, as docs/algorithms/scoring.md defines it.
/// Subjects that must not be shown take part in no case. A case whose method gives no answer counts as doing nothing; a
/// face that cannot be read takes part in no case; a target whose zone does not see its expressive scan has no case in
/// any row; all are listed.
///
/// Memory: faces are read when they are needed, one subject's at a time per thread (about 30 MB), beside 128 MB of true
/// fields and 40 MB for the medians at most, whatever the number of subjects and expressions. Only the models of one
/// expression grow with the subjects, by some 50 kB each, and so do the cases of the targets under way, by 100 bytes
/// per source and row. @throws InputError if fewer than 3 subjects show an expression.
[[nodiscard]] ExperimentReport run_experiment(const preprocessing::Workspace& workspace,
                                              const facs::FacsCatalogue& catalogue,
                                              const ExperimentOptions& options = {},
                                              const std::function<void(const std::string&)>& progress = {});

/// What run_experiment finds out before any work. @throws InputError for bad options, an expression that the catalogue
/// lacks or that fewer than 3 subjects show, or a truth that is gone.
void check_experiment(const preprocessing::Workspace& workspace, const facs::FacsCatalogue& catalogue,
                      const ExperimentOptions& options);

/// What run_experiment would do: transfers (true fields included) and seconds on one core, from figures measured once.
struct ExperimentEstimate {
    std::size_t transfers = 0;
    double core_seconds = 0;
};
[[nodiscard]] ExperimentEstimate estimate_experiment(const preprocessing::Workspace& workspace,
                                                     const ExperimentOptions& options);

/// How many steps `progress` will be told about.
[[nodiscard]] std::size_t experiment_steps(const preprocessing::Workspace& workspace, const ExperimentOptions& options);

}  // namespace mimik::evaluation
