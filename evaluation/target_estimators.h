#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "evaluation/case_estimates.h"
#include "evaluation/cast.h"
#include "evaluation/plan.h"

namespace mimik::evaluation {

/// What brings the expressive scan of a performance to its neutral one.
[[nodiscard]] geometry::Transform neutral_from_expressive(Alignment alignment, const modeling::Performance& own);

/// The estimators of a plan, made ready for one target. One thread at a time.
class TargetEstimators {
public:
    /// References are kept. @param own      as PerformanceReader::read() gave it
    /// @param scored  under the alignment of the plan
    TargetEstimators(const PerformanceReader& reader, const ExperimentPlan& plan, const Cast& cast,
                     const modeling::Performance& own, const geometry::FaceSurface& neutral,
                     const ScoredTarget& scored);
    ~TargetEstimators();

    /// The figures of one face, and by whom.
    struct Estimate {
        std::string estimator;
        Measure measure;
    };
    [[nodiscard]] std::vector<Estimate> measure(const JudgedFace& face);
    /// Why estimators that were asked for say nothing of this target.
    [[nodiscard]] const std::vector<std::string>& silent() const { return silent_; }

private:
    struct View;
    View& view(Alignment alignment);
    void add_places(View& view, const geometry::Transform& aligned);

    const PerformanceReader& reader_;
    const ExperimentPlan& plan_;
    const Cast& cast_;
    const modeling::Performance& own_;
    const geometry::FaceSurface& neutral_;
    const ScoredTarget& scored_;
    std::map<Alignment, std::unique_ptr<View>> views_;
    std::vector<std::string> silent_;
};

}  // namespace mimik::evaluation
