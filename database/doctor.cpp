#include "database/doctor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/text.h"
#include "database/bnt.h"
#include "database/doctor_report.h"
#include "database/landmark_distance.h"
#include "geometry/face_axes.h"
#include "geometry/spikes.h"
#include "io/json_values.h"
#include "io/landmark_io.h"

namespace mimik::database {
namespace {

using geometry::Landmarks;
using geometry::Point;
using geometry::Vector;

std::string text_of(const Point& p) { return fmt::format("({:.0f}, {:.0f}, {:.0f})", p.x(), p.y(), p.z()); }

void check_sides(const LoadedScan& loaded, const Landmarks* neutral, Report& report) {
    const auto& sides = loaded.checks.sides;
    if (sides.pairs_agreeing > 0 && !sides.left_label_is_subject_right &&
        loaded.entry.landmarks_file.extension() == ".lm3")
        report.add(Severity::warning, "sides",
                   "labels say left where +x is, unlike Bosphorus (image-left): taken as the subject's own left",
                   "check that x is not mirrored; if the labels were meant as the viewer's, change the sign of every x",
                   loaded.entry.landmarks_file.string());
    // A vote of two pairs against one is weak: name the pair either way.
    for (const auto& pair : sides.swapped_pairs)
        report.add(Severity::error, "sides",
                   fmt::format("left and right '{}' are swapped against the other pairs", pair),
                   "exchange the two labels in the landmark file", loaded.entry.landmarks_file.string());
    if (!neutral || !side_shows_at_mouth(loaded.entry.id)) return;
    const auto decision = decide_side(*neutral, loaded.landmarks);
    if (decision.side == facs::opposite(loaded.entry.id.side()))
        report.add(Severity::error, "one-sided",
                   fmt::format(
                       "is taken as the subject's {} side, but the {} mouth corner moves ({:.1f} mm against {:.1f} mm)",
                       to_string(loaded.entry.id.side()), to_string(decision.side),
                       std::max(decision.left_mm, decision.right_mm), std::min(decision.left_mm, decision.right_mm)),
                   fmt::format("rename the scan to {}, or check its mouth corners",
                               loaded.entry.id.mirrored().group_and_code()));
}

/// Unit and frame; how far each landmark lies off the surface.
std::vector<double> check_placement(const LoadedScan& loaded, const DoctorOptions& options, Report& report) {
    // A landmark must be nearer than both limits, in mm and in the scan's own size, to be told by the next point.
    double near_enough_mm = options.landmark_off_scan_mm;
    if (loaded.landmarks.find("eye_outer_left") && loaded.landmarks.find("eye_outer_right"))
        near_enough_mm = std::min(near_enough_mm, 0.02 * geometry::outer_eye_distance_mm(loaded.landmarks));
    auto off_mm = landmark_distances_mm(loaded.scan, loaded.landmarks, near_enough_mm);
    check_unit(loaded, off_mm, options, report);
    check_frame(loaded, off_mm, report);
    return off_mm;
}

void check_landmarks_present(const LoadedScan& loaded, Report& report) {
    if (loaded.entry.landmarks_file.empty())
        return report.add(Severity::error, "landmarks-missing", "there is no landmark file",
                          "mark the 22 points (docs/formats.md) and save them beside the scan");
    // Preprocessing aligns by these (Eqs 5.1-5.4 and the rigid alternatives).
    static constexpr std::array<std::string_view, 8> needed = {
        "eye_outer_left", "eye_outer_right",   "eye_inner_left",    "eye_inner_right", "nose_tip",
        "chin",           "mouth_corner_left", "mouth_corner_right"};
    std::vector<std::string_view> vital, other;
    for (const auto name : geometry::standard_landmark_names()) {
        if (loaded.landmarks.find(name)) continue;
        (std::find(needed.begin(), needed.end(), name) != needed.end() ? vital : other).push_back(name);
    }
    const std::string where = loaded.entry.landmarks_file.string();
    if (!vital.empty())
        report.add(posed_or_covered(loaded.entry.id) ? Severity::note : Severity::error, "landmarks-missing",
                   fmt::format("landmarks needed for alignment are missing: {}", fmt::join(vital, ", ")),
                   "mark them; a point that cannot be seen keeps the scan out of alignment by it", where);
    if (!other.empty())
        report.add(Severity::note, "landmarks-missing",
                   fmt::format("landmarks are missing: {}", fmt::join(other, ", ")),
                   "mark them if they can be seen; splines do without", where);
}

/// Landmarks whose order along the head's own axes is anatomy, not expression.
void check_landmark_order(const LoadedScan& loaded, const DoctorOptions& options, Report& report) {
    const auto axes = geometry::head_axes(loaded.landmarks);
    if (!axes || posed_or_covered(loaded.entry.id)) return;
    const auto check = [&](const std::string& greater, const std::string& less, const Vector& axis,
                           const char* relation) {
        const auto* a = loaded.landmarks.find(greater);
        const auto* b = loaded.landmarks.find(less);
        if (!a || !b) return;
        const double by_mm = axis.dot(b->position_mm - a->position_mm);
        if (by_mm > options.order_tolerance_mm)
            report.add(Severity::error, "landmarks-swapped",
                       fmt::format("'{}' should lie {} '{}', but lies {:.1f} mm on the other side", greater, relation,
                                   less, by_mm),
                       "exchange the two labels, or mark the points again", loaded.entry.landmarks_file.string());
    };
    for (const std::string side : {"_left", "_right"}) {
        const Vector outward = side == "_left" ? axes->lateral : Vector(-axes->lateral);
        check("brow_outer" + side, "brow_middle" + side, outward, "outside of");
        check("brow_middle" + side, "brow_inner" + side, outward, "outside of");
        check("eye_outer" + side, "eye_inner" + side, outward, "outside of");
        check("brow_inner" + side, "eye_inner" + side, axes->up, "above");
        check("brow_outer" + side, "eye_outer" + side, axes->up, "above");
        check("eye_inner" + side, "nose_wing" + side, axes->up, "above");
        check("nose_wing" + side, "mouth_corner" + side, axes->up, "above");
    }
    for (const auto& [above, below] : {std::pair{"nose_tip", "upper_lip_outer"},
                                       {"upper_lip_outer", "upper_lip_inner"},
                                       {"upper_lip_inner", "lower_lip_inner"},
                                       {"lower_lip_inner", "lower_lip_outer"},
                                       {"lower_lip_outer", "chin"}})
        check(above, below, axes->up, "above");
}

void check_landmarks_on_scan(const LoadedScan& loaded, std::span<const double> off_mm, const DoctorOptions& options,
                             Report& report) {
    std::vector<std::string> off;
    double worst_mm = 0;
    for (std::size_t m = 0; m < off_mm.size(); ++m) {
        if (off_mm[m] <= options.landmark_off_scan_mm) continue;
        off.push_back(fmt::format("{} ({:.1f} mm)", loaded.landmarks.all()[m].name, off_mm[m]));
        worst_mm = std::max(worst_mm, off_mm[m]);
    }
    if (off.empty()) return;
    const std::string where = loaded.entry.landmarks_file.string();
    const bool far = worst_mm > 5 * options.landmark_off_scan_mm;
    if (2 * off.size() > off_mm.size() && far)
        return report.add(
            Severity::error, "landmarks-off-scan",
            fmt::format("{} of {} landmarks lie off the scan, up to {:.1f} mm", off.size(), off_mm.size(), worst_mm),
            "the landmark file seems to belong to another scan, frame or unit: pair the files again", where);
    report.add(far ? Severity::error : Severity::warning, "landmarks-off-scan",
               fmt::format("landmarks lie off the scan: {}", fmt::join(off, ", ")), "mark them again on the surface",
               where);
}

void check_surface(const LoadedScan& loaded, const DoctorOptions& options, Report& report) {
    const auto& scan = loaded.scan;
    std::size_t valid = 0;
    for (const auto& p : scan.points_mm) valid += p.allFinite() ? 1U : 0U;
    if (valid < static_cast<std::size_t>(options.min_points))
        report.add(Severity::warning, "points", fmt::format("has only {}", base::counted(valid, "measured point")),
                   "scan again, or export the scan at full resolution");

    const auto holes = find_holes(scan);
    if (!holes.judged)
        report.add(Severity::note, "holes", "is a bare cloud: holes cannot be judged",
                   "give the scan in rows or as a mesh to have them found");
    else if (const auto skin = worst_skin_hole(holes, loaded.landmarks); skin.size_mm > options.max_hole_mm)
        report.add(
            Severity::warning, "holes",
            fmt::format("{}, one of them {:.1f} mm across on the skin at {} mm, away from eyes, brows, nostrils, "
                        "lips and chin",
                        base::counted(holes.count, "hole"), skin.size_mm, text_of(skin.at_mm)),
            "preprocessing bridges it or keeps it as a mask; scan again if it lies where the expression moves");
    else if (holes.count > 0)
        report.add(Severity::note, "holes",
                   fmt::format("{}, the largest {:.1f} mm across at {} mm", base::counted(holes.count, "hole"),
                               holes.largest_mm, text_of(holes.largest_at_mm)),
                   "preprocessing bridges holes and marks the bridges, or keeps them as a mask");

    const auto spikes = geometry::find_spikes(scan, geometry::scan_neighbours(scan), options.spike_mm);
    if (const auto count = std::count(spikes.begin(), spikes.end(), 1); count > 0) {
        const auto& first =
            scan.points_mm[static_cast<std::size_t>(std::find(spikes.begin(), spikes.end(), 1) - spikes.begin())];
        report.add(
            static_cast<double>(count) > options.max_spike_share * static_cast<double>(valid) ? Severity::warning
                                                                                              : Severity::note,
            "spikes",
            fmt::format("{} ({:.2f} %) more than {} mm off the neighbourhood, the first at ({:.0f}, {:.0f}, {:.0f}) mm",
                        base::counted(count, "point"), 100.0 * static_cast<double>(count) / static_cast<double>(valid),
                        options.spike_mm, first.x(), first.y(), first.z()),
            "preprocessing removes spikes; look at hair, glasses and eyelashes");
    }
}

void check_texture(const LoadedScan& loaded, Report& report) {
    const auto& entry = loaded.entry;
    if (!loaded.checks.landmarks2d_error.empty())
        report.add(Severity::warning, "unreadable", loaded.checks.landmarks2d_error,
                   "mark the points in the image again, or copy the file again; without it the texture is not checked",
                   entry.landmarks2d_file.string());
    if (!loaded.scan.texture_error.empty())
        report.add(
            Severity::warning, "texture", loaded.scan.texture_error,
            "name an image that lies in the scan's folder; until then the scan is used without the one it names");
    if (auto charts = texture_charts(loaded.scan); !charts.empty())
        report.add(Severity::note, "texture", std::move(charts),
                   "nothing need be done; a scan with one chart (a picture from the front) keeps its own image");
    if (entry.texture_file.empty()) {
        if (!loaded.scan.texture_file.empty())
            report.add(Severity::note, "texture",
                       fmt::format("its texture image '{}' is not beside it", loaded.scan.texture_file),
                       "copy the image beside the scan to have textured results");
        return;
    }
    if (loaded.scan.texture_coordinates.empty())
        report.add(Severity::note, "texture", "has an image but no texture coordinates",
                   "export the scan with texture coordinates", entry.texture_file.string());
    try {
        (void)load_texture(entry);
    } catch (const InputError& e) {
        report.add(Severity::warning, "texture", e.what(), "copy or export the image again",
                   entry.texture_file.string());
    }
    if (const auto& found = loaded.checks.texture; found && !found->fits)
        report.add(Severity::warning, "texture",
                   fmt::format("the image does not fit the scan: landmarks are off by {:.0f} pixels at best",
                               *std::min_element(found->median_error_px.begin(), found->median_error_px.end())),
                   "check that image, scan and .lm2 are of the same recording", entry.texture_file.string());
    else if (const bool v_from_top = is_bnt(entry.scan_file); found && !found->as_expected())
        report.add(
            Severity::warning, "texture",
            fmt::format(
                "texture coordinates lie {} ({:.0f} pixels off, instead of {:.0f} as expected); Mimik turns them",
                to_string(found->best, v_from_top), found->median_error_px[static_cast<std::size_t>(found->best)],
                found->median_error_px[0]),
            fmt::format("write the scan again with u to the right and v {}",
                        v_from_top ? "down from the top (as .bnt has it)" : "up from the bottom"));
}

}  // namespace

std::string to_string(Severity severity) {
    return severity == Severity::note ? "note" : severity == Severity::warning ? "warning" : "error";
}

void DoctorOptions::check() const {
    const auto positive = [](const char* name, double value) {
        if (!(value > 0)) throw InputError(fmt::format("{} is {}; give more than 0", name, value));
    };
    positive("min_size_ratio", min_size_ratio);
    positive("max_hole_mm", max_hole_mm);
    positive("spike_mm", spike_mm);
    positive("max_spike_share", max_spike_share);
    positive("landmark_off_scan_mm", landmark_off_scan_mm);
    positive("order_tolerance_mm", order_tolerance_mm);
    positive("min_points", min_points);
    if (!(max_size_ratio > min_size_ratio))
        throw InputError(
            fmt::format("max_size_ratio is {}; give more than min_size_ratio, {}", max_size_ratio, min_size_ratio));
}

std::vector<Finding> check_scan(const LoadedScan& loaded, const Landmarks* neutral, const DoctorOptions& options) {
    options.check();
    Report report(loaded.entry.scan_file.string());
    const auto off_mm = check_placement(loaded, options, report);
    check_sides(loaded, neutral, report);
    check_landmarks_present(loaded, report);
    check_landmark_order(loaded, options, report);
    check_landmarks_on_scan(loaded, off_mm, options, report);
    check_surface(loaded, options, report);
    check_texture(loaded, report);
    return report.finish();
}

std::vector<Finding> reasons_to_refuse(const LoadedScan& loaded, const DoctorOptions& options) {
    options.check();
    Report report(loaded.entry.scan_file.string());
    const auto off_mm = check_placement(loaded, options, report);
    check_landmarks_on_scan(loaded, off_mm, options, report);
    auto findings = report.finish();
    std::erase_if(findings, [](const Finding& finding) { return finding.severity != Severity::error; });
    return findings;
}

std::optional<Landmarks> landmarks_of(const ScanEntry& entry) {
    try {
        return load(entry).landmarks;
    } catch (const InputError&) {
        return std::nullopt;
    }
}

std::vector<Finding> check_scan(const ScanEntry& entry, const ScanEntry* neutral, const DoctorOptions& options) {
    const auto neutral_landmarks = neutral && side_shows_at_mouth(entry.id) ? landmarks_of(*neutral) : std::nullopt;
    const auto* landmarks = neutral_landmarks ? &*neutral_landmarks : nullptr;
    std::string reason;
    try {
        return check_scan(load(entry), landmarks, options);
    } catch (const InputError& e) {
        reason = e.what();
    }
    // Bad landmarks should not hide what is wrong with the scan itself, nor the other way round.
    Report report(entry.scan_file.string());
    const auto landmarks_unreadable = [&](const std::string& what) {
        report.add(Severity::error, "unreadable", what, "mend, replace or restore the landmark file",
                   entry.landmarks_file.string());
    };
    ScanEntry alone = entry;
    alone.landmarks_file.clear();
    alone.landmarks2d_file.clear();
    std::vector<Finding> of_scan;
    try {
        of_scan = check_scan(load(alone), nullptr, options);
        landmarks_unreadable(reason);
    } catch (const InputError& e) {
        report.add(Severity::error, "unreadable", e.what(), "mend or replace the file");
        try {
            if (!entry.landmarks_file.empty()) (void)io::read_landmarks(entry.landmarks_file, {}, entry.unit);
        } catch (const InputError& of_landmarks) {
            landmarks_unreadable(of_landmarks.what());
        }
    }
    auto findings = report.finish();
    for (auto& finding : of_scan)
        if (finding.kind != "landmarks-missing") findings.push_back(std::move(finding));
    return findings;
}

std::string to_json(const std::vector<Finding>& findings) {
    auto array = nlohmann::json::array();
    for (const auto& f : findings)
        array.push_back({{"severity", to_string(f.severity)},
                         {"kind", f.kind},
                         {"what", f.what},
                         {"where", f.where},
                         {"mend", f.mend}});
    return array.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::vector<Finding> findings_from_json(std::string_view json) {
    try {
        std::vector<Finding> findings;
        for (const auto& item : io::parse_json(json, "findings")) {
            const auto severity = item.at("severity").get<std::string>();
            findings.push_back({severity == "error"     ? Severity::error
                                : severity == "warning" ? Severity::warning
                                                        : Severity::note,
                                item.at("kind").get<std::string>(), item.at("what").get<std::string>(),
                                item.at("where").get<std::string>(), item.at("mend").get<std::string>()});
        }
        return findings;
    } catch (const nlohmann::json::exception& e) {
        throw InputError(fmt::format("findings: not the JSON that the doctor writes ({})", e.what()));
    }
}

}  // namespace mimik::database
