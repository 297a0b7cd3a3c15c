// The doctor's rules on unit and frame (database/doctor.h).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "database/doctor_report.h"
#include "geometry/box.h"
#include "geometry/face_axes.h"
#include "geometry/statistics.h"

namespace mimik::database {
namespace {

using geometry::HeadAxes;
using geometry::Landmarks;
using geometry::Vector;

std::optional<double> distance_mm(const Landmarks& marks, std::string_view a, std::string_view b) {
    const auto* p = marks.find(a);
    const auto* q = marks.find(b);
    return p && q ? std::optional((p->position_mm - q->position_mm).norm()) : std::nullopt;
}

/// Size against the adult mean (3D Facial Norms, men and women together): the median over what can be measured, so that
/// one mark in a wrong place is not taken for another unit.
std::optional<double> size_ratio(const Landmarks& marks) {
    struct Norm {
        std::string_view a, b;
        double mean_mm;
    };
    static constexpr std::array<Norm, 4> norms = {{{"eye_outer_left", "eye_outer_right", 87.0},
                                                   {"eye_inner_left", "eye_inner_right", 32.0},
                                                   {"mouth_corner_left", "mouth_corner_right", 49.0},
                                                   {"nose_wing_left", "nose_wing_right", 34.0}}};
    std::vector<double> ratios;
    for (const auto& norm : norms)
        if (const auto measured = distance_mm(marks, norm.a, norm.b)) ratios.push_back(*measured / norm.mean_mm);
    return ratios.empty() ? std::nullopt : std::optional(geometry::median(std::move(ratios)));
}

constexpr double usual_extent_mm = 270.0;  // a face with hair and neck has 200 to 350 mm across

double extent_ratio(const geometry::RangeScan& scan) {
    return geometry::box_of(scan.points_mm).diagonal().norm() / usual_extent_mm;
}

struct Unit {
    double mm;
    const char *name, *of_manifest;  ///< null: manifest.csv has no word for it
};
constexpr std::array<Unit, 8> units = {{{1, "millimetres", "mm"},
                                        {10, "centimetres", "cm"},
                                        {1000, "metres", "m"},
                                        {25.4, "inches", "inch"},
                                        {100, "decimetres", nullptr},
                                        {304.8, "feet", nullptr},
                                        {0.1, "tenths of a millimetre", nullptr},
                                        {0.001, "micrometres", nullptr}}};

/// The unit in which coordinates are `ratio` times as large as they should be in mm; null if none fits.
const Unit* unit_of(double ratio, double least, double most) {
    const auto* unit = std::min_element(units.begin(), units.end(), [&](const Unit& a, const Unit& b) {
        return std::abs(std::log(ratio * a.mm)) < std::abs(std::log(ratio * b.mm));
    });
    return ratio * unit->mm >= least && ratio * unit->mm <= most ? unit : nullptr;
}

/// Without landmarks the extent must do, and it tells little: a crop of the eyes and a whole body are faces in mm.
void check_extent(const LoadedScan& loaded, Report& report) {
    const double ratio = extent_ratio(loaded.scan);
    constexpr double least = 0.35, most = 9.0, least_of_crop = 0.15;
    if (ratio >= least && ratio <= most) return;
    const std::string what = fmt::format("it is {:.3g} times the size of an adult face", ratio);
    if (ratio >= least_of_crop && ratio < least)
        return report.add(Severity::warning, "unit", what + ": a close crop, or another unit; no landmark tells",
                          "mark the face, and look whether its coordinates are millimetres");
    constexpr double slack = 2.7;  // an extent is no measure of a face
    const auto* unit = unit_of(ratio, 1 / slack, slack);
    const bool in_table = unit && unit->of_manifest && loaded.entry.layout == DatabaseLayout::manifest &&
                          loaded.entry.unit == io::LengthUnit::millimetre;
    report.add(
        Severity::error, "unit", unit ? fmt::format("{}: looks like {}", what, unit->name) : what,
        unit ? fmt::format(
                   "{}multiply all coordinates by {}",
                   in_table ? fmt::format("put {} in the column unit of manifest.csv, or ", unit->of_manifest) : "",
                   unit->mm)
             : "convert all coordinates to millimetres");
}

/// The nose's side of the plane of eyes and mouth, by the surface between them; unit length, empty if there is none.
std::optional<Vector> nose_side(const geometry::RangeScan& scan, const HeadAxes& axes, const Landmarks& marks) {
    const auto middle = [&](const std::string& a, const std::string& b) {
        return geometry::Point((marks.position_mm(a) + marks.position_mm(b)) / 2);
    };
    const geometry::Point eyes =
        (middle("eye_outer_left", "eye_outer_right") + middle("eye_inner_left", "eye_inner_right")) / 2;
    const geometry::Point mouth = middle("mouth_corner_left", "mouth_corner_right");
    const double width = geometry::outer_eye_distance_mm(marks), height = axes.up.dot(eyes - mouth);
    const Vector normal = axes.lateral.cross(axes.up);
    std::vector<double> heights;
    for (const auto& p : scan.points_mm) {
        if (!p.allFinite()) continue;
        // A column over the nose, without mouth and forehead; what is deeper is the back of the head.
        const double up = axes.up.dot(p - mouth), off = normal.dot(p - mouth);
        if (up > 0.3 * height && up < 0.95 * height && std::abs(axes.lateral.dot(p - eyes)) < 0.12 * width &&
            std::abs(off) < 0.6 * width)
            heights.push_back(off);
    }
    constexpr std::size_t fewest = 5;
    if (heights.size() < fewest) return std::nullopt;
    // Of a cloud with a front and a back there is no telling.
    const auto before = std::count_if(heights.begin(), heights.end(), [](double mm) { return mm > 0; });
    const auto behind = static_cast<std::ptrdiff_t>(heights.size()) - before;
    if (4 * std::min(before, behind) > static_cast<std::ptrdiff_t>(heights.size())) return std::nullopt;
    const double stands_out = geometry::median(std::move(heights));
    // A nose stands out by a sixth of the eyes' distance and more.
    if (std::abs(stands_out) < 0.03 * width) return std::nullopt;
    return stands_out > 0 ? normal : Vector(-normal);
}

/// True if the nose tip lies in the plane of eyes and mouth: then it does not tell where the face looks.
bool nose_tip_is_level(const Landmarks& marks, const HeadAxes& axes) {
    const geometry::Point mouth =
        (marks.position_mm("mouth_corner_left") + marks.position_mm("mouth_corner_right")) / 2;
    const double off = axes.lateral.cross(axes.up).dot(marks.position_mm("nose_tip") - mouth);
    return std::abs(off) < 0.03 * geometry::outer_eye_distance_mm(marks);
}

/// How a head lies in its frame.
struct HeadPose {
    HeadAxes axes;
    bool surface_says = false;     ///< `out` is the surface's; else the nose tip's
    bool nose_tip_wrong = false;   ///< the surface says the opposite of the landmark
    std::optional<bool> mirrored;  ///< by names of the subject's own side or by the image; empty: nothing tells
};

std::optional<HeadPose> head_pose(const LoadedScan& loaded, std::span<const double> off_mm) {
    const auto axes = geometry::head_axes(loaded.landmarks);
    if (!axes) return std::nullopt;
    HeadPose pose{*axes, false, false, {}};
    if (landmarks_lie_on_scan(loaded.landmarks, off_mm))
        if (const auto out = nose_side(loaded.scan, *axes, loaded.landmarks)) {
            pose.surface_says = true;
            pose.nose_tip_wrong = out->dot(axes->out) < 0;
            pose.axes.out = *out;
        }
    if (!pose.surface_says && nose_tip_is_level(loaded.landmarks, *axes)) {
        pose.axes.out = axes->lateral.cross(axes->up);
        if (pose.axes.out.z() < 0) pose.axes.out = -pose.axes.out;
    }
    const bool left_handed = pose.axes.lateral.cross(pose.axes.up).dot(pose.axes.out) < 0;
    const auto& checks = loaded.checks;
    // Labels of Bosphorus get their side from where they lie: they prove nothing. The camera sees its image unmirrored.
    if (checks.sides.pairs_agreeing + checks.sides.pairs_disagreeing == 0)
        pose.mirrored = left_handed;
    else if (const auto& right = checks.correlations.x_u ? checks.correlations.x_u : checks.correlations.x_column)
        pose.mirrored = (*right < 0) != left_handed;
    return pose;
}

/// One axis of the scan by its witnesses.
struct AxisWitnesses {
    std::optional<double> texture, lattice;  ///< correlations
    std::optional<bool> head_mirrored;       ///< by the landmarks; empty: they do not tell
};
struct AxisWords {
    const char *axis, *of_texture, *of_lattice, *mend, *turn_texture, *turn_lattice;
};

/// True if the axis is said to be mirrored.
bool check_axis(const AxisWitnesses& by, const AxisWords& words, Report& report) {
    const bool against_texture = by.texture && *by.texture < 0, against_lattice = by.lattice && *by.lattice < 0;
    if (!against_texture && !against_lattice) return false;
    const auto falls = [&](const char* of, double correlation) {
        return fmt::format("{} falls while the {} (correlation {:.2f})", words.axis, of, correlation);
    };
    // Pictures are flipped as easily as coordinates: against the texture alone it is the texture that is wrong.
    const bool two_agree = against_texture && (against_lattice || by.head_mirrored.value_or(false));
    if ((two_agree || !by.texture) && by.head_mirrored.value_or(true)) {
        report.add(
            Severity::error, "frame",
            fmt::format("{}: {} is mirrored",
                        against_texture ? falls(words.of_texture, *by.texture) : falls(words.of_lattice, *by.lattice),
                        words.axis),
            words.mend);
        return true;
    }
    const bool upright = !by.head_mirrored.value_or(true);
    if (against_texture)
        report.add(
            Severity::warning, "texture",
            fmt::format("{}, though {}: the texture coordinates are mirrored", falls(words.of_texture, *by.texture),
                        upright ? "the head stands upright" : fmt::format("nothing else says that {} is", words.axis)),
            words.turn_texture);
    if (against_lattice)
        report.add(
            Severity::warning, "frame",
            fmt::format("{}, though {}: the lattice is stored the other way", falls(words.of_lattice, *by.lattice),
                        upright ? "the head stands upright" : "not against the texture"),
            words.turn_lattice);
    return false;
}

/// True if an axis is said to be mirrored, by texture, lattice and landmarks together.
bool check_axes_by_image(const LoadedScan& loaded, const std::optional<HeadPose>& pose, Report& report) {
    const auto& found = loaded.checks.correlations;
    AxisWitnesses x{found.x_u, found.x_column, {}}, y{found.y_v, found.y_row, {}};
    // Names may follow from where the points lie (Bosphorus labels do): that left is at +x proves nothing.
    if (pose && pose->axes.lateral.x() < -0.3) x.head_mirrored = true;
    if (pose && std::abs(pose->axes.up.y()) > 0.5) y.head_mirrored = pose->axes.up.y() < 0;
    const bool x_mirrored = check_axis(
        x,
        {"x", "texture's u grows", "column grows",
         "change the sign of every x (scan and landmarks): +x is the subject's left, right in the image",
         "turn u: u -> 1 - u; if it is the face that is mirrored, change the sign of every x (scan and landmarks)",
         "write every row of the lattice the other way round: x grows with the column"},
        report);
    return check_axis(
               y,
               {"y", "texture goes up", "row goes up",
                "change the sign of every y (scan and landmarks), or turn the rows over: +y is up, row 0 the lowest",
                "turn v: v -> 1 - v", "write the rows of the lattice the other way round: row 0 is the lowest"},
               report) ||
           x_mirrored;
}

/// "-x", "z": the coordinate along which a direction mostly points; empty if it points along none.
std::string along(const Vector& direction) {
    Eigen::Index axis = 0;
    constexpr double most = 0.75;  // 41 degrees
    if (direction.cwiseAbs().maxCoeff(&axis) < most) return {};
    const std::string name(1, "xyz"[axis]);
    return direction[axis] < 0 ? "-" + name : name;
}

/// The words for a head that looks away or does not stand upright.
struct FrameWords {
    std::string what, mend;
};
FrameWords words_of(const HeadPose& pose) {
    const std::string up = along(pose.axes.up), out = along(pose.axes.out);
    const bool mirrored = pose.mirrored.value_or(false);
    if (up == "-y" && out == "-z")
        return {"y points down and z away from the camera (a camera frame)",
                mirrored ? "change the sign of every coordinate, in scan and landmarks"
                         : "turn scan and landmarks by 180 degrees about x: change the signs of y and z"};
    // If nothing tells left from right, turning is likelier than mirroring, and both are named.
    const auto turn_or_mirror = [&](const char* turn, const char* mirror, const char* if_mirrored) {
        if (mirrored) return std::string(mirror);
        return pose.mirrored ? std::string(turn) : fmt::format("{}; if {}, {} instead", turn, if_mirrored, mirror);
    };
    if (up == "-y" && out == "z")
        return {"y points down: the mouth lies above the eyes",
                turn_or_mirror("turn scan and landmarks by 180 degrees about z: change the signs of x and y",
                               "change the sign of every y, in scan and landmarks", "left and right are right")};
    if (up == "y" && out == "-z" && !pose.surface_says)
        return {"the nose tip lies behind eyes and mouth, and no surface between them tells where the face looks",
                "mark the nose tip again; if it is right, turn scan and landmarks to z toward the camera"};
    if (up == "y" && out == "-z")
        return {"z does not point toward the camera: the surface of the nose lies behind eyes and mouth",
                turn_or_mirror("turn scan and landmarks by 180 degrees about y: change the signs of x and z",
                               "change the sign of every z, in scan and landmarks", "left and right are right")};
    const Vector lateral = mirrored ? pose.axes.out.cross(pose.axes.up) : pose.axes.up.cross(pose.axes.out);
    const std::string left = along(lateral);
    const bool told = !up.empty() && !out.empty() && !left.empty();
    return {fmt::format("the head's up is {} and it looks along {}, instead of y and z",
                        up.empty() ? "between the axes" : up, out.empty() ? "no axis" : out),
            told ? fmt::format("turn scan and landmarks to y up and z toward the camera: (x, y, z) -> ({}, {}, {})",
                               left, up, out)
                 : "turn scan and landmarks to y up and z toward the camera"};
}

}  // namespace

bool landmarks_lie_on_scan(const Landmarks& landmarks, std::span<const double> off_mm) {
    const auto eyes_mm = distance_mm(landmarks, "eye_outer_left", "eye_outer_right");
    const auto ratio = size_ratio(landmarks);
    if (!eyes_mm && !ratio) return false;
    constexpr double adult_eyes_mm = 87.0, near = 0.05;
    const double limit_mm = near * (ratio ? *ratio * adult_eyes_mm : *eyes_mm);
    const auto on = std::count_if(off_mm.begin(), off_mm.end(), [&](double mm) { return mm <= limit_mm; });
    return 4 * on >= 3 * static_cast<std::ptrdiff_t>(off_mm.size()) && on > 0;
}

void check_unit(const LoadedScan& loaded, std::span<const double> off_mm, const DoctorOptions& options,
                Report& report) {
    const auto marks = size_ratio(loaded.landmarks);
    if (!marks) return check_extent(loaded, report);
    const double scan = extent_ratio(loaded.scan);
    // Shoulders, a whole body or strays make the extent larger, a crop smaller: marks that lie on the scan share its
    // unit whatever it is.
    constexpr double most_apart = 4;
    const bool apart =
        (*marks * most_apart < scan || *marks > most_apart * scan) && !landmarks_lie_on_scan(loaded.landmarks, off_mm);
    const auto fits = [&](double ratio) { return ratio >= options.min_size_ratio && ratio <= options.max_size_ratio; };
    if (!apart && fits(*marks)) return;

    const bool scan_alone = apart && fits(*marks);
    const double ratio = scan_alone ? scan : *marks;
    std::string what = fmt::format("its landmarks are {:.3g} times the size of an adult face", *marks);
    if (apart) what += fmt::format(", but the scan {:.3g} times", scan);
    const char* coordinates = scan_alone ? "the coordinates of the scan"
                              : apart    ? "the coordinates of the landmarks"
                                         : "all coordinates of scan and landmarks";
    const std::string where = apart && !scan_alone ? loaded.entry.landmarks_file.string() : std::string();
    const bool in_mm = loaded.entry.unit == io::LengthUnit::millimetre;

    // A table's unit was applied to both files: what they hold is told without it.
    const double said_mm = apart ? 1.0 : io::millimetres_per(loaded.entry.unit);
    const double slack = scan_alone ? 2 : 1;  // an extent is no measure of a face
    const auto* unit = unit_of(ratio / said_mm, options.min_size_ratio / slack, options.max_size_ratio * slack);
    // Two files of one scan in two units cannot both be in the table's.
    if (!unit || (apart && !in_mm))
        return report.add(Severity::error, "unit", what,
                          fmt::format("convert {} to {}, and check the landmarks", coordinates,
                                      in_mm ? "millimetres" : "the unit that manifest.csv gives them"),
                          where);
    const bool in_table = !apart && loaded.entry.layout == DatabaseLayout::manifest && unit->of_manifest != nullptr;
    report.add(
        Severity::error, "unit",
        fmt::format("{}: {} like {}{}", what, apart && !scan_alone ? "the landmarks look" : "looks", unit->name,
                    apart || in_mm ? "" : fmt::format(", though manifest.csv says {}", to_string(loaded.entry.unit))),
        fmt::format("{}multiply {} by {}",
                    in_table ? fmt::format("put {} in the column unit of manifest.csv, or ", unit->of_manifest) : "",
                    coordinates, unit->mm / said_mm),
        where);
}

void check_frame(const LoadedScan& loaded, std::span<const double> off_mm, Report& report) {
    auto pose = head_pose(loaded, off_mm);
    // Marks off the scan say how they lie themselves, not how the scan does; that they are off is told elsewhere.
    const bool off = pose && !pose->surface_says && !landmarks_lie_on_scan(loaded.landmarks, off_mm);
    if (off) pose.reset();
    if (pose && pose->nose_tip_wrong)
        report.add(Severity::error, "landmarks-swapped",
                   "'nose_tip' lies behind eyes and mouth, but the surface between them stands out before them",
                   "mark the nose tip again", loaded.entry.landmarks_file.string());
    const bool posed = posed_or_covered(loaded.entry.id);
    constexpr double steep = 0.5;  // cosine of 60 degrees
    const auto wrong = [&](double cosine) { return posed ? cosine < -steep : cosine < steep; };
    const bool astray = pose && (wrong(pose->axes.up.y()) || wrong(pose->axes.out.z()));
    // One mirrored axis is seen by the image, too; any other way to lie askew spoils what it says of the axes.
    const bool only_y_down =
        astray && pose->axes.up.y() < -steep && pose->axes.out.z() > steep && pose->mirrored.value_or(true);
    const bool said = (!astray || only_y_down) && check_axes_by_image(loaded, pose, report);
    if (!pose) return;
    if (astray) {
        if (said) return;
        auto words = words_of(*pose);
        return report.add(Severity::error, "frame", std::move(words.what), std::move(words.mend));
    }
    const double angle_deg =
        57.29577951308232 * std::acos(std::clamp(std::min(pose->axes.up.y(), pose->axes.out.z()), -1.0, 1.0));
    constexpr double turned_deg = 40;
    if (angle_deg > turned_deg && !posed)
        report.add(
            Severity::warning, "frame",
            fmt::format("the head is turned by {:.0f} degrees against the frame (y up, z out of the face)", angle_deg),
            "turn scan and landmarks to y up and z toward the camera, or give the scan a pose code such as YR_R45");
    if (pose->axes.lateral.x() < -0.3)
        report.add(
            Severity::error, "sides", "the landmarks named left lie at smaller x than those named right",
            "exchange left and right in the names (they are the subject's own), or change the sign of every x if the "
            "scan is mirrored");
}

}  // namespace mimik::database
