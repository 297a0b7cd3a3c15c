#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "preprocessing/workspace.h"

namespace mimik::preprocessing {

/// How the template came to lie on one scan.
struct ScanRegistration {
    database::ScanId id;
    double matched_share = 0.0;  ///< of the template's vertices
    double residual_rms_mm = 0.0;
    std::size_t still_controls = 0;  ///< of an expression: places where the data show that nothing moved
    double largest_motion_mm = 0.0;  ///< of an expression, average frame
    std::string refused;             ///< why there is no registration; empty: there is one
};

/// Bends the template of a workspace on to scans of it; the meshes are in Workspace::registrations() afterwards. A scan
/// that the template does not come to lie on is told with the reason, and the rest goes on.
/// @param scans  of the workspace
/// @param progress  is told the name of every scan that is done, from any thread
/// @return one per scan, in their order
/// @throws InputError if the average face has no template.
[[nodiscard]] std::vector<ScanRegistration> register_workspace(
    const Workspace& workspace, std::span<const database::ScanId> scans,
    const std::function<void(const std::string&)>& progress = {});

/// A table: scan, matched_share, residual_rms_mm, still_controls, largest_motion_mm, refused.
[[nodiscard]] std::string to_csv(std::span<const ScanRegistration> registrations);

}  // namespace mimik::preprocessing
