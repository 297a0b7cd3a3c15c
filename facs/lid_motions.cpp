#include "facs/lid_motions.h"

#include <algorithm>
#include <array>

namespace mimik::facs {

namespace {

// Shares measured at the margins above the middle of the eye: of MakeHuman's artists' shapes, and of ICT-FaceKit's
// scanned ones.
constexpr std::array units = {
    LidUnit{5, {-0.28, 0.02}, "FACS: raises the upper lid; measured -0.21 (MakeHuman) and -0.34, lower 0.02 (ICT)"},
    LidUnit{7,
            {0.10, 0.23},
            "FACS: tightens the lids, raises the lower one; measured 0.01 and 0.24 (ICT), a slit 0.37 and 0.22 "
            "(MakeHuman)"},
    LidUnit{41, {0.40, 0.0}, "FACS: the upper lid droops, the eye stays open by more than a half"},
    LidUnit{42, {0.75, 0.05}, "FACS: the eye is open by a slit"},
    LidUnit{
        43, {1.0, 0.02}, "FACS: closed, the upper lid falls on to the lower; measured 1 and 0 (MakeHuman), 0.02 (ICT)"},
    LidUnit{45, {1.0, 0.02}, "FACS: a blink, at its height as AU 43"},
    LidUnit{46, {1.0, 0.02}, "FACS: a wink, AU 43 of one eye"},
};

}  // namespace

std::span<const LidUnit> lid_units() { return units; }

std::optional<LidMotion> lid_motion(const Expression& expression, Side eye) {
    if (expression.group() == "E") return std::nullopt;
    std::optional<LidMotion> sum;
    for (const auto& part : expression.units()) {
        const auto found =
            std::find_if(units.begin(), units.end(), [&](const LidUnit& known) { return known.unit == part.unit; });
        if (found == units.end()) continue;
        if (part.low_intensity) return std::nullopt;
        if (part.side != Side::both && part.side != eye) continue;
        if (!sum) sum.emplace();
        sum->upper_down += found->motion.upper_down;
        sum->lower_up += found->motion.lower_up;
    }
    if (sum) {
        sum->lower_up = std::clamp(sum->lower_up, 0.0, 1.0);
        sum->upper_down = std::min(sum->upper_down, 1.0 - sum->lower_up);
    }
    return sum;
}

}  // namespace mimik::facs
