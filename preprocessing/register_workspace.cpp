#include "preprocessing/register_workspace.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/parallel.h"
#include "preprocessing/kept_registrations.h"

namespace mimik::preprocessing {

using database::ScanId;

namespace {

/// Whoever asks for registrations wants the meshes, too.
void check_kept(const KeptRegistrations& registrations, const Face& face) {
    const auto stem = registrations.stem(face).string();
    for (const char* suffix : {".ply", ".json"})
        if (!base::is_there(stem + suffix))
            throw InputError(
                fmt::format("{}{} could not be written; see to the folder's permissions and to room on "
                            "the disk",
                            stem, suffix));
}

ScanRegistration register_scan(const Workspace& workspace, const ScanId& id) {
    ScanRegistration found;
    found.id = id;
    const auto& registrations = *workspace.registrations();
    try {
        const auto neutral_id = workspace.neutral(id.subject);
        const auto neutral = workspace.face(neutral_id);
        if (id == neutral_id) {
            const auto bent = registrations.neutral(neutral);
            found.matched_share = bent.matched_share;
            found.residual_rms_mm = bent.residual_rms_mm;
            check_kept(registrations, neutral);
        } else {
            const auto expressive = workspace.face(id);
            const auto moved = registrations.motion(neutral, expressive);
            check_kept(registrations, expressive);
            found.matched_share = moved.matched_share;
            found.residual_rms_mm = moved.residual_rms_mm;
            found.still_controls = moved.still_controls;
            for (const auto& way : moved.motion_mm)
                found.largest_motion_mm = std::max(found.largest_motion_mm, way.norm());
        }
    } catch (const std::exception& e) {
        found.refused = e.what();
    }
    return found;
}

}  // namespace

std::vector<ScanRegistration> register_workspace(const Workspace& workspace, std::span<const ScanId> scans,
                                                 const std::function<void(const std::string&)>& progress) {
    (void)workspace.registrations()->registration();  // an average face without a mouth is said once
    std::vector<ScanRegistration> found(scans.size());
    // Neutral scans first: all others of a subject begin there.
    for (const bool neutrals : {true, false})
        base::parallel_for_each(scans.size(), [&](std::size_t k) {
            if (scans[k].neutral() != neutrals) return;
            found[k] = register_scan(workspace, scans[k]);
            if (progress) progress(scans[k].name());
        });
    return found;
}

std::string to_csv(std::span<const ScanRegistration> registrations) {
    std::string text = "scan,matched_share,residual_rms_mm,still_controls,largest_motion_mm,refused\n";
    for (const auto& one : registrations)
        text += one.refused.empty() ? fmt::format("{},{:.4f},{:.4f},{},{:.3f},\n", one.id.name(), one.matched_share,
                                                  one.residual_rms_mm, one.still_controls, one.largest_motion_mm)
                                    : fmt::format("{},,,,,{}\n", one.id.name(), base::csv_field(one.refused));
    return text;
}

}  // namespace mimik::preprocessing
