#pragma once

#include <optional>
#include <span>

#include "facs/expression.h"
#include "facs/side.h"

namespace mimik::facs {

/// How far lids go at full strength, in shares of the height of the opening between them.
struct LidMotion {
    double upper_down = 0.0;  ///< of the upper lid; below 0: it rises
    double lower_up = 0.0;    ///< of the lower lid

    bool operator==(const LidMotion&) const = default;
};

/// An Action Unit that moves the lids of an eye, and where its motion is described or was measured.
struct LidUnit {
    int unit = 0;
    LidMotion motion;
    const char* source = "";
};

/// AU 5, 7, 41, 42, 43, 45 and 46. Squints (AU 44) and raised cheeks (AU 6) push the lids by the skin about them, which
/// is for a model to say.
[[nodiscard]] std::span<const LidUnit> lid_units();

/// What the units of an expression do to the lids of one eye: their motions add, up to closed eyes. Empty where none of
/// them is a lid's; scans of low intensity show less than the full strength, how much is not known. An emotion is more
/// than its units: its own scans say what its lids do.
[[nodiscard]] std::optional<LidMotion> lid_motion(const Expression& expression, Side eye);

}  // namespace mimik::facs
