#include "database/one_sided_codes.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::database {

void SideDecisionOptions::check() const {
    if (!(min_difference_mm >= 0))
        throw InputError(fmt::format("min_difference_mm is {}; give 0 or more", min_difference_mm));
    if (!(min_ratio >= 1)) throw InputError(fmt::format("min_ratio is {}; give 1 or more", min_ratio));
}

bool side_shows_at_mouth(const ScanId& id) {
    return id.side() != facs::Side::both && base::equal_ignoring_case(id.group, "LFAU");
}

SideDecision decide_side(const geometry::Landmarks& neutral, const geometry::Landmarks& expression,
                         const SideDecisionOptions& options) {
    options.check();
    // What a mouth expression moves least and what does not lie in one line.
    static constexpr std::array<std::string_view, 7> stable = {
        "eye_outer_right",   "eye_inner_right",  "eye_inner_left", "eye_outer_left",
        "nose_saddle_right", "nose_saddle_left", "nose_tip"};
    Eigen::Matrix3Xd from(3, stable.size()), to(3, stable.size());
    SideDecision decision;
    for (const auto name : stable) {
        const auto* a = expression.find(name);
        const auto* b = neutral.find(name);
        if (!a || !b) continue;
        from.col(decision.stable_landmarks) = a->position_mm;
        to.col(decision.stable_landmarks++) = b->position_mm;
    }
    const std::array corners = {neutral.find("mouth_corner_left"), neutral.find("mouth_corner_right"),
                                expression.find("mouth_corner_left"), expression.find("mouth_corner_right")};
    if (decision.stable_landmarks < 4 || std::any_of(corners.begin(), corners.end(), [](const auto* c) { return !c; }))
        return decision;

    const geometry::Transform neutral_from_expression(
        Eigen::umeyama(from.leftCols(decision.stable_landmarks), to.leftCols(decision.stable_landmarks), false));
    decision.left_mm = (neutral_from_expression * corners[2]->position_mm - corners[0]->position_mm).norm();
    decision.right_mm = (neutral_from_expression * corners[3]->position_mm - corners[1]->position_mm).norm();
    const auto [less, more] = std::minmax(decision.left_mm, decision.right_mm);
    if (more - less >= options.min_difference_mm && more >= options.min_ratio * less)
        decision.side = decision.left_mm > decision.right_mm ? facs::Side::left : facs::Side::right;
    return decision;
}

}  // namespace mimik::database
