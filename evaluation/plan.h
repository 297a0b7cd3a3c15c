#pragma once

#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "animation/method.h"
#include "evaluation/active_zone.h"
#include "evaluation/error_metrics.h"
#include "evaluation/estimator_choice.h"
#include "facs/facs_catalogue.h"
#include "preprocessing/workspace.h"

namespace mimik::evaluation {

/// The method that looks at the truth and says what a method of this kind could do at best; shares refer to it. Empty
/// where there is none.
[[nodiscard]] std::string_view bound_of(animation::SourceKind kind);

/// A source, a target and one more, or there is no mean of the others.
constexpr std::size_t fewest_subjects = 3;

/// Beyond it no motion of a face is one.
constexpr double largest_magnitude = 5.0;

struct ExperimentOptions {
    std::vector<facs::Expression> expressions = thesis_expressions();
    std::vector<animation::MethodPointer> methods = {
        animation::method_by_name("thesis"), animation::method_by_name("default"), animation::method_by_name("mean")};
    bool reference = true;   ///< true fields beside them, where the database has a truth
    bool whole_face = true;  ///< score the face outside the zone, too
    int max_sources = 0;     ///< per target, the next ones in the list after it; 0 = all other subjects
    ZoneSource zones = ZoneSource::automatic;  ///< where methods are compared
    std::vector<std::string> targets = {};     ///< who is animated; empty: all
    std::vector<std::string> sources = {};     ///< whose performances are learned from; empty: all
    std::vector<double> magnitudes = {1.0};    ///< each method at each of them; bounds and doing nothing at 1 alone
    /// Each source as its own target, and nobody else: the thesis' own check of its points (5.5.1). No row of two
    /// people is made beside it.
    bool on_itself = false;
    /// Beside the rows that every experiment has; each gives `metrics` in every one of `regions`.
    std::vector<EstimatorChoice> estimators = {};
    std::vector<std::string> regions = {"zone"};
    MetricOptions metrics = {};
    Alignment alignment = Alignment::given;  ///< of every row, and of estimators that name none

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("expressions", self.expressions);
        visit("methods", self.methods);
        visit("reference", self.reference);
        visit("whole_face", self.whole_face);
        visit("max_sources", self.max_sources);
        visit("zones", self.zones);
        visit("targets", self.targets);
        visit("sources", self.sources);
        visit("magnitudes", self.magnitudes);
        visit("on_itself", self.on_itself);
        visit("estimators", self.estimators);
        visit("regions", self.regions);
        visit("metrics", self.metrics);
        visit("alignment", self.alignment);
    }
    void check() const;  ///< throws InputError
    /// AU 1, 2, 4, 12, 14, 15, 17, 20 and 12 on the left.
    [[nodiscard]] static std::vector<facs::Expression> thesis_expressions();
};

/// The scans of one expression, one per subject that shows it.
struct PlannedExpression {
    facs::Expression expression;
    std::vector<database::ScanId> performances;
};

/// What an experiment will do, in a fixed order: every expression, in it every target, in it every method, in it every
/// source. A unit of work is one target of one expression.
struct ExperimentPlan {
    std::vector<std::string> subjects;  ///< those who may be shown
    std::vector<PlannedExpression> expressions;
    std::vector<std::string> left_out;              ///< expressions that too few subjects show, with the reason
    std::vector<animation::MethodPointer> methods;  ///< "nothing" first, then those asked for, then the true fields
    bool whole_face = true;
    std::size_t max_sources = 0;               ///< 0 = all
    ZoneSource zones = ZoneSource::catalogue;  ///< not automatic
    std::set<std::string> targets = {};        ///< who is animated; empty: all
    std::set<std::string> sources = {};        ///< whose performances are learned from; empty: all
    std::vector<double> magnitudes = {1.0};
    bool on_itself = false;  ///< each source as its own target
    std::vector<EstimatorChoice> estimators = {};
    std::vector<std::string> regions = {};  ///< "wrinkles" among them where a curvature is measured
    MetricOptions metrics = {};
    Alignment alignment = Alignment::given;

    [[nodiscard]] std::size_t units() const;
    /// How many must show an expression.
    [[nodiscard]] std::size_t fewest() const { return on_itself ? 1 : fewest_subjects; }
    [[nodiscard]] bool is_target(const std::string& subject) const;
    /// The participants whose performances are learned from for one target: the ring that begins after it, of those who
    /// are sources; the target alone where each source is its own.
    [[nodiscard]] std::vector<std::size_t> sources_of(std::size_t target,
                                                      std::span<const database::ScanId> participants) const;
    /// At which a method is scored: bounds and doing nothing at 1 alone, the others at each.
    [[nodiscard]] std::vector<double> magnitudes_of(const animation::Method& method) const;
};

/// The subjects that were asked for. @throws InputError for one who may not be shown or is none of the workspace.
[[nodiscard]] std::set<std::string> known_subjects(const preprocessing::Workspace& workspace,
                                                   const std::vector<std::string>& asked);

/// An expression that fewer than 3 subjects show (1 where each is its own target) is left out and listed.
/// @param truth  whether the database has one
/// @throws InputError for bad options, a mean where each source is its own target, zones or methods that need a truth
/// where there is none, an expression that the catalogue lacks, a target or source that may not be shown or is none of
/// the workspace, or if nothing is left.
[[nodiscard]] ExperimentPlan plan_experiment(const preprocessing::Workspace& workspace,
                                             const facs::FacsCatalogue& catalogue, const ExperimentOptions& options,
                                             bool truth);

/// Transfers and seconds on one core, from figures measured once.
struct ExperimentEstimate {
    std::size_t transfers = 0;
    double core_seconds = 0;
};
[[nodiscard]] ExperimentEstimate estimate(const ExperimentPlan& plan);

}  // namespace mimik::evaluation
