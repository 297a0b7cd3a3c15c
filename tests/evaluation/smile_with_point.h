#pragma once

#include <string>

#include "facs/facs_catalogue.h"

namespace mimik::test {

inline constexpr double outer_eyes_mm = 89.0;  // of the reference face

/// One AU whose outer points hold still where the smile does not reach, and one point on each side that is `off_mm`
/// above the corner, the peak of the motion.
inline facs::FacsCatalogue smile_with_point(double off_mm) {
    const auto& built_in = *facs::builtin_catalogue().find(12);
    facs::ActionUnit unit = built_in;
    unit.points.clear();
    const auto add = [&](const std::string& name, const std::string& mark, double lateral, double up) {
        unit.points.push_back({name, facs::ControlKind::carried, {{{mark, 1.0}}, lateral, up}});
    };
    add("wing", "nose_wing", 0, 0);
    add("cheek", "mouth_corner", 0.33, 0.05);
    add("jaw", "mouth_corner", 0.20, -0.33);
    add("chin", "chin", 0, 0);
    add("lip", "upper_lip_outer", 0, 0);
    unit.points.push_back(
        {"corner", facs::ControlKind::muscle, {{{"mouth_corner", 1.0}}, 0.0, off_mm / outer_eyes_mm}});
    return {facs::builtin_catalogue().sampling(), {unit}, {}, "smile"};
}

}  // namespace mimik::test
