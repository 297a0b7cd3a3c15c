#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "evaluation/comparison.h"
#include "evaluation/performance.h"
#include "evaluation/plan.h"
#include "facs/facs_catalogue.h"

namespace mimik::report {

/// Which faces the page shows in three dimensions.
struct PageFacesOptions {
    int most_faces = 4;                     ///< evenly spaced from the best target to the worst; 0: none
    std::vector<std::string> targets = {};  ///< these instead
    std::vector<std::string> methods = {};  ///< these instead of the first and the best ones
    std::size_t most_bytes = 18'000'000;    ///< of all faces together, so that the page stays below 30 MB

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("most_faces", self.most_faces);
        visit("targets", self.targets);
        visit("methods", self.methods);
        visit("most_bytes", self.most_bytes);
    }
    void check() const;  ///< throws InputError
};

/// One face of the page.
struct PageFace {
    std::string target;
    std::string why;  ///< "rank 1 of 12 by mean": 1 is the truest
};

struct PageChoice {
    std::vector<PageFace> faces;
    std::vector<std::string> methods;
};

/// A pure function of the rows. Targets are ranked by what the method with the greatest explained fraction over all
/// expressions explains of each, mean over the expressions. Shown are the first method of the plan, and of each kind of
/// source the best one; neither doing nothing nor what looks at the truth.
/// @throws InputError for bad options, or a target or a method that has no row.
[[nodiscard]] PageChoice choose_faces(const evaluation::CaseRowReader& read, const evaluation::ExperimentPlan& plan,
                                      const PageFacesOptions& options = {});

/// The chosen faces as JSON (docs/report.md): the neutral face, and of each expression its real scan, the motion of
/// each method at magnitude 1 from the target's first source, distances to the real scan and control points. Zones,
/// alignment and distances are those of the experiment's rows. A face that would take more than the bytes left is left
/// out, and `remarks` say so, as they do of what gives no answer.
[[nodiscard]] std::string page_faces(const evaluation::PerformanceReader& reader, const facs::FacsCatalogue& catalogue,
                                     const evaluation::ExperimentPlan& plan, const PageChoice& choice,
                                     const PageFacesOptions& options, std::vector<std::string>& remarks);

}  // namespace mimik::report
