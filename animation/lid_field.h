#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "animation/prepared_target.h"
#include "facs/lid_motions.h"
#include "geometry/face_surface.h"
#include "preprocessing/lid_margins.h"

namespace mimik::animation {

/// What a vertex of a face is to its eyes.
enum class LidSheet : std::uint8_t {
    neither,
    upper,   ///< skin of an upper lid, up to its fold
    lower,   ///< skin of a lower lid
    eyeball  ///< stays where it is; so do vertices that bridge a hole between lids
};

/// The lids of a target, looked for when somebody first asks, and kept with it. Average frame (similarity).
[[nodiscard]] const preprocessing::LidMargins& lid_margins(const PreparedTarget& target);

/// Per vertex of the target.
[[nodiscard]] std::vector<LidSheet> lid_sheets(const PreparedTarget& target);

/// Puts the motion of lids that slide on their eyeballs in the place of what a model says of them, where the expression
/// moves the lids of an eye (facs::lid_motion) and their margins are known; goes over into what the model says of the
/// skin about them. Eyeballs stay. Where margins are not known the model's motion stays, and a remark says why.
/// @param field  of the expression at magnitude 1, the target's frame
void slide_lids(const PreparedTarget& target, const facs::Expression& expression, geometry::DisplacementField& field,
                std::vector<std::string>* remarks = nullptr);

/// Whether that moves a lid of this target.
[[nodiscard]] bool lids_slide(const PreparedTarget& target, const facs::Expression& expression);

/// Lifts what a motion would take into an eyeball out of it: a lid half way goes along a chord.
/// @param field_mm  of all expressions as they are set, the target's frame
void keep_lids_off_eyeballs(const PreparedTarget& target, std::span<geometry::Vector> field_mm);

/// Whether the surface between some vertices is torn by a motion: they lie on lids and eyeball, or on both lids, and
/// part there by more than one and a half millimetres.
[[nodiscard]] bool torn_lids(std::span<const LidSheet> lid_sheets, std::span<const geometry::Vector> field_mm,
                             std::span<const std::uint32_t> corners);

}  // namespace mimik::animation
