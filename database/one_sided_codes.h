#pragma once

#include "base/fields.h"
#include "database/scan_id.h"
#include "geometry/landmarks.h"

namespace mimik::database {

struct SideDecisionOptions {
    /// A posed expression repeats to about 1 mm (Johnston 2003): less than this says nothing.
    double min_difference_mm = 1.5;
    double min_ratio = 1.3;  ///< of the larger to the smaller motion
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("min_difference_mm", self.min_difference_mm);
        visit("min_ratio", self.min_ratio);
    }
    void check() const;  ///< throws InputError naming field and value
};
static_assert(base::lists_every_field<SideDecisionOptions>());

/// Which mouth corner moved, with the evidence.
struct SideDecision {
    facs::Side side = facs::Side::both;  ///< both: undecided
    double left_mm = 0;                  ///< how far the subject's own left mouth corner moved
    double right_mm = 0;
    int stable_landmarks = 0;  ///< eye corners and nose that carried one scan on to the other; fewer than 4: undecided
};

/// Whether the mouth corners can tell on which side a scan's expression happens: a code for one side of the lower face.
/// A wink or a raised brow moves neither.
[[nodiscard]] bool side_shows_at_mouth(const ScanId& id);

/// The side on which an expression happens, by the mouth corner that moves more against the neutral scan of the same
/// subject, after both are brought together rigidly on eye corners, nose saddles and nose tip. Landmarks under our
/// names, mm.
[[nodiscard]] SideDecision decide_side(const geometry::Landmarks& neutral, const geometry::Landmarks& expression,
                                       const SideDecisionOptions& options = {});

}  // namespace mimik::database
