#include "animation/lid_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "geometry/topology.h"
#include "geometry/weld.h"

namespace mimik::animation {

using facs::Side;
using geometry::Point;
using geometry::Vector;
using modeling::Normalisation;
using preprocessing::EyeballKind;
using preprocessing::EyeLids;
using preprocessing::LidSection;

namespace {

// Lengths in eye widths. The upper lid's motion of closed eyes is at an end 3 mm above the margin on MakeHuman's heads
// and 6 mm on ICT-FaceKit's; a fold between them costs either little.
constexpr double fold_above = 0.18;   ///< the upper lid's motion fades from the margin up to its fold, so far away
constexpr double fold_below = 0.30;   ///< the lower lid's
constexpr double most_of_brow = 0.8;  ///< a fold lies no farther up than this share of the way to the brow
constexpr double model_above = 0.25;  ///< beyond the fold the model's motion comes back on this way
constexpr double model_from_below = 0.10, model_to_below = 0.30;  ///< and on this way below the lower margin
constexpr double model_aside = 0.20;                              ///< and beside the corners
constexpr double clearance_mm = 0.2;                              ///< that lids keep from the eyeball
constexpr double rim_mm = 4.5;  ///< a border of the surface so near the margin is the margin; steps of a grid are lower
/// Of closed lids of a mesh: margins are edges of some thickness, and press. A scan's hole ends beyond the margins, and
/// its rim goes too far as it is.
constexpr double mesh_overlap_mm = 0.4;
constexpr double most_step_mm = 4.0;  ///< between lids that meet; more is no lid

double smooth_step(double t) {
    const double s = std::clamp(t, 0.0, 1.0);
    return s * s * (3.0 - 2.0 * s);
}

/// Where a vertex is on an eye's lids.
struct LidPlace {
    std::uint32_t vertex = 0;
    LidSheet sheet = LidSheet::neither;
    double x_mm = 0.0, elevation_rad = 0.0, rho_mm = 0.0;
    LidSection margin;    ///< at its x
    double moves = 1.0;   ///< how much the margins move at its x
    double lid = 0.0;     ///< how far it goes with its margin: 1 there, 0 at the fold
    double slides = 0.0;  ///< how much of its motion is the lid's; the rest is the model's
    bool rim = false;     ///< the surface ends here: cells of a grid are coarser than lids, so this is the margin
};

/// Between two sections.
LidSection mixed(const LidSection& a, const LidSection& b, double t) {
    const auto between = [t](double from, double to) { return from + t * (to - from); };
    return {between(a.x_mm, b.x_mm), between(a.upper_rad, b.upper_rad), between(a.lower_rad, b.lower_rad),
            between(a.upper_rho_mm, b.upper_rho_mm), between(a.lower_rho_mm, b.lower_rho_mm)};
}

/// The margins at x; past the last section those of the last.
LidSection margins_at(const EyeLids& eye, double x_mm) {
    const auto& sections = eye.sections;
    if (x_mm <= sections.front().x_mm) return sections.front();
    if (x_mm >= sections.back().x_mm) return sections.back();
    const auto next = std::find_if(sections.begin(), sections.end(), [&](const auto& s) { return s.x_mm > x_mm; });
    const auto& before = *(next - 1);
    return mixed(before, *next, (x_mm - before.x_mm) / (next->x_mm - before.x_mm));
}

/// How much lids move so far beyond the last section, which a hole of a scan can end in some height: their skin is one
/// there, and is not pushed together by more than it is wide.
double share_beyond(const EyeLids& eye, const LidSection& last, double beyond_mm) {
    const double height_mm = (last.upper_rad - last.lower_rad) * eye.radius_mm;
    return 1.0 - smooth_step(beyond_mm / std::max(1.0, 1.5 * height_mm));
}

/// How far above the upper margin the fold lies: before the brow.
double fold_mm(const EyeLids& eye, const geometry::Landmarks& landmarks, Side side) {
    const double usual = fold_above * eye.width_mm;
    const auto* brow = landmarks.find(side == Side::left ? "brow_middle_left" : "brow_middle_right");
    if (!brow) return usual;
    const Vector local = eye.local_mm(brow->position_mm);
    const auto margin = margins_at(eye, local.x());
    const double way_mm = (std::atan2(local.y(), local.z()) - margin.upper_rad) * eye.radius_mm;
    return std::clamp(most_of_brow * way_mm, 0.4 * usual, usual);
}

/// The lids of an eye as vertices.
std::vector<LidPlace> places_of(const PreparedTarget& target, const preprocessing::LidMargins& margins, Side side,
                                const geometry::VertexMask& on_rim) {
    const auto& eye = margins.of(side);
    const auto& surface = target.surface();
    const auto& normalised = target.normalised(Normalisation::similarity);
    const double fold = fold_mm(eye, normalised.landmarks, side), width = eye.width_mm;
    std::vector<LidPlace> places;
    for (std::uint32_t v = 0; v < surface.size(); ++v) {
        if (!surface.present[v] || margins.eyeball[v]) continue;
        const Vector local = eye.local_mm(normalised.vertices_mm[v]);
        LidPlace place;
        place.vertex = v;
        place.x_mm = local.x();
        place.elevation_rad = std::atan2(local.y(), local.z());
        place.rho_mm = std::hypot(local.y(), local.z());
        const double aside_mm =
            std::max({eye.sections.front().x_mm - local.x(), local.x() - eye.sections.back().x_mm, 0.0});
        if (aside_mm >= model_aside * width || local.z() < -eye.radius_mm) continue;
        place.margin = margins_at(eye, local.x());
        place.moves = share_beyond(eye, place.margin, aside_mm);
        const double arm_mm = std::max(place.rho_mm, eye.radius_mm);  // the brow stands out of the eyeball
        const double above_mm = (place.elevation_rad - place.margin.upper_rad) * arm_mm;
        const double below_mm = (place.margin.lower_rad - place.elevation_rad) * arm_mm;
        const double aside = 1.0 - smooth_step(aside_mm / (model_aside * width));
        const bool between = above_mm < 0 && below_mm < 0;
        const double ball_mm = std::sqrt(std::max(eye.radius_mm * eye.radius_mm - local.x() * local.x(), 0.0));
        if (between &&
            (!surface.measured[v] || (eye.eyeball == EyeballKind::surface && place.rho_mm < ball_mm + 0.5))) {
            place.sheet = LidSheet::eyeball;
            place.slides = 1.0;
            places.push_back(place);
            continue;
        }
        // The wall of a socket hangs on the lids, and stays farther in.
        const double rim_rho_mm = above_mm > below_mm ? place.margin.upper_rho_mm : place.margin.lower_rho_mm;
        const double lid_from_centre_mm = std::min(eye.radius_mm, std::hypot(local.x(), rim_rho_mm));
        const double depth = smooth_step((local.norm() / lid_from_centre_mm - 0.85) / 0.12);
        if (above_mm > below_mm) {
            place.rim = on_rim[v] && above_mm < rim_mm;
            place.sheet = above_mm < fold ? LidSheet::upper : LidSheet::neither;
            place.lid = depth * (place.rim ? 1.0 : 1.0 - smooth_step(above_mm / fold));
            place.slides = aside * (1.0 - smooth_step((above_mm - fold) / (model_above * width)));
        } else {
            place.rim = on_rim[v] && below_mm < rim_mm;
            place.sheet = below_mm < fold_below * width ? LidSheet::lower : LidSheet::neither;
            place.lid = depth * (place.rim ? 1.0 : 1.0 - smooth_step(below_mm / (fold_below * width)));
            place.slides = aside * (1.0 - smooth_step((below_mm - model_from_below * width) /
                                                      ((model_to_below - model_from_below) * width)));
        }
        if (place.slides > 0) places.push_back(place);
    }
    return places;
}

struct Lids {
    preprocessing::LidMargins margins;
    std::vector<LidPlace> left, right;
    std::vector<LidSheet> sheets;
};

/// Vertices at which measured skin ends: of a grid, of cells that are not measured at every corner.
geometry::VertexMask rim_of(const geometry::FaceSurface& surface) {
    geometry::VertexMask rim(surface.size(), 0);
    if (!surface.grid) {
        // Seams of texture coordinates, and meshes whose faces share no vertex, have no border there.
        const auto first = geometry::weld(surface.vertices_mm, surface.triangles);
        std::vector<geometry::Triangle> welded;
        for (const auto& t : surface.triangles) welded.push_back({first[t[0]], first[t[1]], first[t[2]]});
        geometry::VertexMask on_border(surface.size(), 0);
        for (const auto& edge : geometry::border_edges(welded)) on_border[edge[0]] = on_border[edge[1]] = 1;
        for (std::size_t v = 0; v < rim.size(); ++v)
            rim[v] = first[v] != geometry::not_welded && on_border[first[v]] ? 1 : 0;
        return rim;
    }
    const auto rows = static_cast<std::size_t>(surface.grid->rows), cols = static_cast<std::size_t>(surface.grid->cols);
    for (std::size_t row = 0; row + 1 < rows; ++row)
        for (std::size_t col = 0; col + 1 < cols; ++col) {
            const std::size_t v = row * cols + col;
            const std::array cell = {v, v + 1, v + cols, v + cols + 1};
            if (std::any_of(cell.begin(), cell.end(), [&](std::size_t c) { return !surface.measured[c]; }))
                for (const auto c : cell) rim[c] = surface.measured[c];
        }
    return rim;
}

const Lids& lids_of(const PreparedTarget& target) {
    static const auto owner = std::make_shared<const int>(0);  // one for all: every target keeps its lids under it
    const auto kept = target.kept(owner, [&]() -> std::shared_ptr<const void> {
        const auto& surface = target.surface();
        const auto& normalised = target.normalised(Normalisation::similarity);
        auto lids = std::make_shared<Lids>();
        lids->margins = preprocessing::find_lid_margins(normalised.vertices_mm, surface.triangles, surface.measured,
                                                        normalised.landmarks);
        const auto rim = rim_of(surface);
        lids->sheets.assign(surface.size(), LidSheet::neither);
        for (const auto side : {Side::left, Side::right}) {
            if (!lids->margins.of(side).found) continue;
            auto& places = side == Side::left ? lids->left : lids->right;
            places = places_of(target, lids->margins, side, rim);
            for (const auto& place : places) lids->sheets[place.vertex] = place.sheet;
        }
        for (std::size_t v = 0; v < surface.size(); ++v)
            if (lids->margins.eyeball[v]) lids->sheets[v] = LidSheet::eyeball;
        return lids;
    });
    return *static_cast<const Lids*>(kept.get());
}

/// Out of the eyeball, x as it is.
Vector lifted(const Vector& local, double least_mm) {
    const double rho = std::hypot(local.y(), local.z());
    const double least_rho = std::sqrt(std::max(least_mm * least_mm - local.x() * local.x(), 0.0));
    if (rho >= least_rho || rho < 1e-9) return local;
    return {local.x(), local.y() * least_rho / rho, local.z() * least_rho / rho};
}

/// A vertex that is nearer than lids may be stays as near as it is.
double least_distance_mm(const EyeLids& eye, const Vector& local) {
    return std::min(local.norm(), eye.radius_mm + clearance_mm);
}

/// Where a vertex of the lids goes, in the frame of the eye.
/// @param overlap_mm  of closed lids
Vector slid(const EyeLids& eye, const LidPlace& place, const facs::LidMotion& motion, double overlap_mm) {
    const auto& margin = place.margin;
    const double height = margin.upper_rad - margin.lower_rad;
    const double lower_to = margin.lower_rad + place.moves * motion.lower_up * height;
    const double upper_to = std::max(margin.upper_rad - place.moves * motion.upper_down * height, lower_to);
    double elevation = place.elevation_rad, rho = place.rho_mm;
    Vector rest(place.x_mm, rho * std::sin(elevation), rho * std::cos(elevation));
    if (!(height > 0)) return rest;
    const double closed = std::clamp(1.0 - (upper_to - lower_to) / height, 0.0, 1.0);
    const bool upper = elevation > (margin.upper_rad + margin.lower_rad) / 2;
    if (place.rim) {
        // Steps of a grid's border become the smooth line of the margin, the more the eye closes.
        elevation += closed * ((upper ? margin.upper_rad : margin.lower_rad) - elevation);
        rho +=
            closed * std::clamp((upper ? margin.upper_rho_mm : margin.lower_rho_mm) - rho, -most_step_mm, most_step_mm);
    }
    if (elevation < margin.upper_rad && elevation > margin.lower_rad) {
        // Skin within the opening is squeezed with it.
        const double share = (elevation - margin.lower_rad) / height;
        elevation += place.lid * (lower_to + share * (upper_to - lower_to) - elevation);
    } else {
        const double pressed_rad = smooth_step(5.0 * closed - 4.0) * overlap_mm / eye.radius_mm;
        elevation += place.lid * (upper ? upper_to - pressed_rad - margin.upper_rad : lower_to - margin.lower_rad);
    }
    // Lids that meet lie in one line: the upper one comes as near to the axis as the lower one is.
    if (upper)
        rho += place.lid * closed * std::clamp(margin.lower_rho_mm - margin.upper_rho_mm, -most_step_mm, most_step_mm);
    return lifted({place.x_mm, rho * std::sin(elevation), rho * std::cos(elevation)}, least_distance_mm(eye, rest));
}

}  // namespace

const preprocessing::LidMargins& lid_margins(const PreparedTarget& target) { return lids_of(target).margins; }

std::vector<LidSheet> lid_sheets(const PreparedTarget& target) { return lids_of(target).sheets; }

bool lids_slide(const PreparedTarget& target, const facs::Expression& expression) {
    if (!facs::lid_motion(expression, Side::left) && !facs::lid_motion(expression, Side::right)) return false;
    // Both eyes or none, also where one is asked for: the two sides of an AU may be blendshapes of one file.
    const auto& margins = lids_of(target).margins;
    return margins.of(Side::left).found && margins.of(Side::right).found;
}

void slide_lids(const PreparedTarget& target, const facs::Expression& expression, geometry::DisplacementField& field,
                std::vector<std::string>* remarks) {
    const bool slides = lids_slide(target, expression);
    for (const auto side : {Side::left, Side::right}) {
        const auto motion = facs::lid_motion(expression, side);
        if (!motion) continue;
        const auto& lids = lids_of(target);
        const auto& eye = lids.margins.of(side);
        if (!slides) {
            if (remarks)
                remarks->push_back(fmt::format("{}: the lids of the {} eye of {} move as the model says: {}",
                                               expression.name(), facs::to_string(side), target.name(),
                                               eye.found ? "those of the other eye were not found" : eye.reason));
            continue;
        }
        const auto& normalised = target.normalised(Normalisation::similarity);
        const double overlap_mm = target.surface().grid ? 0.0 : mesh_overlap_mm;
        const Eigen::Matrix3d target_from_eye =
            normalised.average_from_target.linear().inverse() * eye.axes.transpose();
        for (const auto& place : side == Side::left ? lids.left : lids.right) {
            auto& mm = field.mm[place.vertex];
            if (place.sheet == LidSheet::eyeball) {
                mm.setZero();
                continue;
            }
            const Vector way =
                slid(eye, place, *motion, overlap_mm) - eye.local_mm(normalised.vertices_mm[place.vertex]);
            mm += place.slides * (target_from_eye * way - mm);
        }
        for (std::size_t v = 0; v < field.size(); ++v)
            if (lids.margins.eyeball[v]) field.mm[v].setZero();
    }
}

void keep_lids_off_eyeballs(const PreparedTarget& target, std::span<Vector> field_mm) {
    const auto& lids = lids_of(target);
    const auto& normalised = target.normalised(Normalisation::similarity);
    const Eigen::Matrix3d average_from_target = normalised.average_from_target.linear();
    for (const auto side : {Side::left, Side::right}) {
        const auto& eye = lids.margins.of(side);
        if (!eye.found) continue;
        const Eigen::Matrix3d target_from_eye = average_from_target.inverse() * eye.axes.transpose();
        for (const auto& place : side == Side::left ? lids.left : lids.right) {
            if (place.sheet != LidSheet::upper && place.sheet != LidSheet::lower) continue;
            const Vector rest = eye.local_mm(normalised.vertices_mm[place.vertex]);
            auto& mm = field_mm[place.vertex];
            const Vector moved = rest + eye.axes * average_from_target * mm;
            mm += target_from_eye * (lifted(moved, least_distance_mm(eye, rest)) - moved);
        }
    }
}

bool torn_lids(std::span<const LidSheet> lid_sheets, std::span<const Vector> field_mm,
               std::span<const std::uint32_t> corners) {
    constexpr double parted_by_mm = 1.5;
    if (lid_sheets.empty()) return false;
    for (const auto a : corners)
        for (const auto b : corners) {
            const auto one = lid_sheets[a], other = lid_sheets[b];
            if (one != other && one != LidSheet::neither && other != LidSheet::neither &&
                (field_mm[a] - field_mm[b]).norm() > parted_by_mm)
                return true;
        }
    return false;
}

}  // namespace mimik::animation
