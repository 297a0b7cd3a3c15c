#include "synthesis/builtin_muscles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "synthesis/builtin_curves.h"

namespace mimik::synthesis {
namespace {

using geometry::Point;
using geometry::Vector;

/// How much of a pull follows the skin away from the insertion: the rest of its component along the normal stays.
constexpr double slide_over_bone = 0.9;
/// How far from the insertion, as a share of the reach, the part of a pull across the skin is felt.
constexpr double depth_of_attachment = 0.75;
/// Tissue spreads what it gathers over about this length, mm.
constexpr double spread_mm = 4.0;
constexpr int spread_rounds = 2;  ///< of smoothing along columns and rows in turn

/// How much of a pull reaches skin at `s`: the side of the face is held by the bone under it, and a cheek that is
/// carried past where the face turns would hang over it.
double on_front(double s) { return 1 - smooth_step(48, 84, std::abs(s)); }

/// What lies between skin and bone, mm: rounded after the tallied depths of Stephan and Simpson (2008). Nothing on lids
/// and lips' red, whose motion the sphincters describe.
double tissue_depth_mm(const SheetVertex& p) {
    using namespace place;
    const double a = std::abs(p.s);
    const auto patch = [&](double s, double t, double width, double height) {
        return bell(a - s, width) * bell(p.t - t, height);
    };
    double depth = 5.5 + 7 * smooth_step(-12, -40, p.t);
    depth += 4 * patch(48, -58, 16, 24) + 2 * patch(70, -60, 16, 26) - 4.5 * patch(0, -64, 15, 7);
    depth *= 1 - 0.9 * patch(mouth_corner, stomion, 6, 5.5);  // the knot of muscles at the corner keeps its form
    depth += 4 * patch(36, 11, 17, 9);                        // the pad of fat that the brow rides on
    depth *= 1 - 0.75 * (1 - smooth_step(12, 21, a)) * smooth_step(-60, -52, p.t) * smooth_step(2, -12, p.t);  // nose
    depth *= 1 - plateau(p.v + 8, 7, 16) * hump(p.across_eye, 1.9);
    const double red = smooth_step(upper_lip + 2, upper_lip - 2, p.v) * smooth_step(lower_lip - 2, lower_lip + 2, p.v) *
                       (1 - smooth_step(mouth_corner - 5, mouth_corner + 2, a));
    return depth * (1 - red) * (1 - smooth_step(44, 76, a));
}

/// How much of what is gathered does not rise: within the nasolabial fold, from the wing of the nose to above the
/// corner, skin is bound to muscle. What a smile gathers is the cheek, which comes to lie over the fold.
double bound_share(const SheetVertex& p) {
    const double a = std::abs(p.s), fold = 17 - 0.5 * (p.t + 43);
    return 0.85 * smooth_step(fold + 3, fold - 5, a) * smooth_step(-40, -50, p.t) * smooth_step(-96, -84, p.t);
}

/// The line with its corners cut (Chaikin), so that a furrow bends like skin.
std::vector<Place> rounded(std::vector<Place> line) {
    for (int round = 0; round < 3 && line.size() > 2; ++round) {
        std::vector<Place> cut = {line.front()};
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            const auto &a = line[i], &b = line[i + 1];
            if (i > 0) cut.push_back({0.75 * a.s + 0.25 * b.s, 0.75 * a.t + 0.25 * b.t});
            if (i + 2 < line.size()) cut.push_back({0.25 * a.s + 0.75 * b.s, 0.25 * a.t + 0.75 * b.t});
        }
        cut.push_back(line.back());
        line = std::move(cut);
    }
    return line;
}

/// Distance from p to a line of places, and how far along it (0..1) the nearest point is.
std::pair<double, double> to_line(const std::vector<Place>& line, double s, double t) {
    double best = std::numeric_limits<double>::max(), along = 0, total = 0, at = 0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const double ds = line[i + 1].s - line[i].s, dt = line[i + 1].t - line[i].t, length = std::hypot(ds, dt);
        const double f = std::clamp(((s - line[i].s) * ds + (t - line[i].t) * dt) / (length * length), 0.0, 1.0);
        const double d = std::hypot(s - line[i].s - f * ds, t - line[i].t - f * dt);
        if (d < best) best = d, at = total + f * length;
        total += length;
    }
    along = at / total;
    return {best, along};
}

}  // namespace

MuscleModel::MuscleModel(const Sheet& sheet, std::vector<Point> mean_face_mm)
    : sheet_(sheet), mean_(std::move(mean_face_mm)) {
    std::vector<Point> base;
    for (const auto& p : sheet.vertices) base.push_back(p.base);
    triangles_ = geometry::triangulate(sheet.faces);
    normals_ = geometry::vertex_normals(base, triangles_);
    std::map<std::uint32_t, SheetLine> rows, columns;
    for (std::uint32_t i = 0; i < sheet.vertices.size(); ++i) {
        const auto& p = sheet.vertices[i];
        depth_.push_back(tissue_depth_mm(p));
        bound_.push_back(bound_share(p));
        rows[p.row].add(i, p.s);
        // A column that the mouth cuts is two lines: upper lip and lower lip.
        columns[2 * p.column + (sheet.lower_lip_side[i] && std::abs(p.s) < place::mouth_corner ? 1 : 0)].add(i, -p.t);
    }
    columns_ = columns.size();
    for (auto* set : {&columns, &rows})  // rows last: they smooth over where the columns part
        for (auto& [number, line] : *set) lines_.push_back(std::move(line));
    std::map<std::uint32_t, std::vector<std::uint32_t>> eye;
    std::map<std::uint32_t, std::array<std::uint32_t, 2>> seam;
    for (std::uint32_t i = 0; i < sheet.vertices.size(); ++i) {
        const auto& p = sheet.vertices[i];
        held_.push_back(smooth_step(place::rim - 2, 92, std::abs(p.s)) * smooth_step(place::top - 2, 62, p.t) *
                        smooth_step(place::bottom + 3, -128, p.v));
        if (p.s > 0 && std::abs(p.across_eye) < 1.45 && p.v < 12 && p.v > -26) eye[p.column].push_back(i);
        if (p.v == place::stomion && std::abs(p.s) < place::mouth_corner)
            seam[p.column][sheet.lower_lip_side[i] ? 1 : 0] = i;
    }
    for (auto& [column, vertices] : eye)
        eye_columns_.push_back(vertices);  // vertices are numbered from the top row down
    for (auto& [column, pair] : seam) seam_.push_back(pair);
}

double MuscleModel::lip_share(std::size_t vertex, Lip lip) const {
    if (lip == Lip::both || sheet_.lower_lip_side[vertex] == (lip == Lip::lower)) return 1;
    return smooth_step(9, place::mouth_corner, std::abs(sheet_.vertices[vertex].s));
}

void MuscleModel::pull(const Muscle& muscle, double side, std::span<const Point> neutral_mm,
                       std::vector<Vector>& moved) const {
    const Place in = {side * muscle.insertion.s, muscle.insertion.t}, from = {side * muscle.origin.s, muscle.origin.t};
    const auto inserted = sheet_.nearest(in.s, in.t), origin = sheet_.nearest(from.s, from.t);
    // Along the person's own line, as it runs in the skin: a receding forehead does not pull a brow off the bone. How
    // far a larger face moves is a variance of its own (VarianceOptions).
    const Vector& normal = normals_[inserted];
    const auto in_skin = [&](const Vector& line) { return Vector(line - line.dot(normal) * normal); };
    const Vector mean_line = in_skin(mean_[origin] - mean_[inserted]),
                 own_line = in_skin(neutral_mm[origin] - neutral_mm[inserted]);
    const Vector side_pull(side * muscle.pull_mm.x(), muscle.pull_mm.y(), muscle.pull_mm.z());
    Vector pull_mm = Eigen::Quaterniond::FromTwoVectors(mean_line, own_line) * side_pull;
    if (in.s == 0) pull_mm.x() = 0;
    const double normal_pull = pull_mm.dot(normals_[inserted]);

    const double ds = from.s - in.s, dt = from.t - in.t, length = std::hypot(ds, dt);
    const double reach = std::max({muscle.ahead_mm, muscle.behind_mm, muscle.side_mm});
    for (std::size_t i = 0; i < moved.size(); ++i) {
        const auto& p = sheet_.vertices[i];
        const double u = p.s - in.s, v = p.t - in.t;
        if (std::abs(u) > reach || std::abs(v) > reach) continue;
        const double along = (u * ds + v * dt) / length, across = (u * dt - v * ds) / length;
        const double r = std::hypot(along / (along > 0 ? muscle.ahead_mm : muscle.behind_mm), across / muscle.side_mm);
        if (r >= 1) continue;
        const double share = lip_share(i, muscle.lip) * on_front(p.s), along_skin = share * hump(r, 1);
        const double across_skin = share * hump(r, depth_of_attachment) * normal_pull;
        const double lifted = along_skin * pull_mm.dot(normals_[i]) - across_skin;
        moved[i] += along_skin * pull_mm - slide_over_bone * lifted * normals_[i];
    }
}

/// Soft tissue keeps its volume: where a pull crowds the skin it rises, where it stretches the skin it thins.
void MuscleModel::gather(std::span<const Point> neutral_mm, std::vector<Vector>& moved) const {
    constexpr double most_crowded = 0.35, most_stretched = -0.4;
    std::vector<double> before(moved.size(), 0), after(moved.size(), 0);
    for (const auto& t : triangles_) {
        if (moved[t[0]].isZero() && moved[t[1]].isZero() && moved[t[2]].isZero()) continue;
        const Point &a = neutral_mm[t[0]], &b = neutral_mm[t[1]], &c = neutral_mm[t[2]];
        const double was = (b - a).cross(c - a).norm();
        const double is = (b - a + moved[t[1]] - moved[t[0]]).cross(c - a + moved[t[2]] - moved[t[0]]).norm();
        for (const auto i : t) before[i] += was, after[i] += is;
    }
    std::vector<double> rise(moved.size(), 0);
    for (std::size_t i = 0; i < moved.size(); ++i)
        if (before[i] > 0) {
            const double crowded =
                std::clamp(before[i] / std::max(after[i], 0.1 * before[i]) - 1, most_stretched, most_crowded);
            rise[i] = depth_[i] * crowded * (crowded > 0 ? 1 - bound_[i] : 1);
        }
    for (int round = 0; round < spread_rounds; ++round)
        for (const auto& line : lines_) smooth_along(line, rise);
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += rise[i] * normals_[i];
}

/// Solves (1 - spread^2 d2/dx2) f = values along a line of the sheet, with level ends: a low pass of constant length on
/// uneven spacing.
void MuscleModel::smooth_along(const SheetLine& line, std::vector<double>& values) const {
    constexpr double square = spread_mm * spread_mm / spread_rounds;
    if (std::all_of(line.vertices.begin(), line.vertices.end(), [&](auto i) { return values[i] == 0; })) return;
    const std::size_t n = line.vertices.size();
    std::vector<double> upper(n), right(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double before = i > 0 ? line.at[i] - line.at[i - 1] : 0,
                     next = i + 1 < n ? line.at[i + 1] - line.at[i] : 0;
        const double cell = 0.5 * (before + next), low = i > 0 ? square / (before * cell) : 0,
                     high = i + 1 < n ? square / (next * cell) : 0;
        const double diagonal = 1 + low + high - (i > 0 ? low * upper[i - 1] : 0);
        upper[i] = high / diagonal;
        right[i] = (values[line.vertices[i]] + (i > 0 ? low * right[i - 1] : 0)) / diagonal;
    }
    for (std::size_t i = n; i-- > 0;)
        values[line.vertices[i]] = right[i] = right[i] + (i + 1 < n ? upper[i] * right[i + 1] : 0);
}

void MuscleModel::heap(const Motion& motion, double side, std::vector<Vector>& moved) const {
    for (const auto& f : motion.furrows) {
        double low_s = 1e9, high_s = -1e9, low_t = 1e9, high_t = -1e9;
        for (const auto& q : f.line) {
            low_s = std::min(low_s, q.s), high_s = std::max(high_s, q.s);
            low_t = std::min(low_t, q.t), high_t = std::max(high_t, q.t);
        }
        const double margin = 6 * f.width_mm;
        const auto line = rounded(f.line);
        for (std::size_t i = 0; i < moved.size(); ++i) {
            const auto& p = sheet_.vertices[i];
            const double s = side * p.s;
            if (s < low_s - margin || s > high_s + margin || p.t < low_t - margin || p.t > high_t + margin) continue;
            const auto [distance, along] = to_line(line, s, p.t);
            const double taper = smooth_step(0, 0.3, along) * smooth_step(1, 0.7, along);
            const double shape = -bell(distance, f.width_mm) + 0.45 * bell(distance - 2.4 * f.width_mm, f.width_mm);
            moved[i] += f.depth_mm * taper * shape * lip_share(i, f.lip) * normals_[i];
        }
    }
    for (const auto& b : motion.bulges)
        for (std::size_t i = 0; i < moved.size(); ++i) {
            const auto& p = sheet_.vertices[i];
            const double r = std::hypot((side * p.s - b.centre.s) / b.reach_s_mm, (p.t - b.centre.t) / b.reach_t_mm);
            if (r < 1) moved[i] += b.height_mm * hump(r, 1) * lip_share(i, b.lip) * normals_[i];
        }
}

/// Lids glide over the eyeball: a vertex keeps its height over the surface that it comes to lie on.
void MuscleModel::move_lids(const Sphincter& lids, std::span<const Point> neutral_mm,
                            std::vector<Vector>& moved) const {
    using namespace place;
    for (const auto& column : eye_columns_) {
        const double q = sheet_.vertices[column.front()].across_eye;
        const double width = smooth_step(1.4, 0.75, std::abs(q));
        double upper_y = 0, lower_y = 0, upper_gap = 0.5, lower_gap = 0.5;
        for (const auto i : column) {
            if (std::abs(sheet_.vertices[i].v - upper_lid) < upper_gap)
                upper_gap = std::abs(sheet_.vertices[i].v - upper_lid), upper_y = neutral_mm[i].y();
            if (std::abs(sheet_.vertices[i].v - lower_lid) < lower_gap)
                lower_gap = std::abs(sheet_.vertices[i].v - lower_lid), lower_y = neutral_mm[i].y();
        }
        const double opening = (upper_y - lower_y) * (std::abs(q) < 1 ? 1 : smooth_step(1.45, 1, std::abs(q)) * 0.2);
        const double up_mm =
            lids.upper_lid_lift_mm * width * std::max(0.0, 1 - 0.5 * q * q) - lids.upper_lid_down * opening;
        const double low_mm = lids.lower_lid_up * opening;
        const auto thickness = [&](double v) {  // of the lids over the eyeball, as the neutral surface has it
            const auto lid = lid_thickness_mm(q, v);
            return lid.upper * smooth_step(8, 3, v) + lid.lower * smooth_step(-21, -15, v);
        };
        for (const auto i : column) {
            const double v = sheet_.vertices[i].v;
            const double share = v >= upper_lid   ? 1 - smooth_step(upper_lid + 0.8, 9.5, v)
                                 : v <= lower_lid ? 0
                                                  : (v - lower_lid) / (upper_lid - lower_lid);
            const double low_share = v >= upper_lid   ? 0
                                     : v <= lower_lid ? smooth_step(-24, lower_lid - 0.8, v)
                                                      : 1 - share;
            const double dy = up_mm * share + low_mm * low_share;
            if (std::abs(dy) < 1e-6) continue;
            // The surface below, read off the same column at the new height.
            const double y = neutral_mm[i].y() + dy;
            std::size_t k = 0;
            while (k + 2 < column.size() && neutral_mm[column[k + 1]].y() > y) ++k;
            const auto under = [&](std::size_t j) {
                return neutral_mm[column[j]].z() - thickness(sheet_.vertices[column[j]].v);
            };
            const double a = neutral_mm[column[k]].y(), b = neutral_mm[column[k + 1]].y();
            const double f = std::clamp((a - y) / std::max(1e-9, a - b), 0.0, 1.0);
            const double z = under(k) + f * (under(k + 1) - under(k)) + thickness(v);
            const double shared = std::max(share, low_share) * smooth_step(1.15, 0.7, std::abs(q));
            // A lid that is lifted slips back into the orbit instead of climbing its edge.
            moved[i] += Vector(0, dy, dy > 0 && v > upper_lid - 3 ? -0.33 * dy : shared * (z - neutral_mm[i].z()));
        }
    }
}

void MuscleModel::turn_lips(const Sphincter& lips, double side, std::span<const Point> neutral_mm,
                            std::vector<Vector>& moved) const {
    using namespace place;
    std::map<std::uint32_t, double> line_y;
    for (const auto& pair : seam_) line_y[sheet_.vertices[pair[0]].column] = neutral_mm[pair[0]].y();
    for (std::size_t i = 0; i < moved.size(); ++i) {
        const auto& p = sheet_.vertices[i];
        const auto y = line_y.find(p.column);
        if (y == line_y.end() || p.v > -58 || p.v < -98) continue;
        const bool lower = sheet_.lower_lip_side[i];
        const double roll = lower ? lips.lower_roll_mm : lips.upper_roll_mm;
        if (roll == 0) continue;
        const double a = std::abs(p.s) / mouth_corner;
        double w = (1 - a * a) * (1 - a * a);
        if (side != 0) w *= smooth_step(-6, 8, side * p.s);
        const double border = lower ? lower_lip : upper_lip, beyond = lower ? -98 : -58;
        const double red = std::clamp((p.v - border) / (stomion - border), 0.0, 1.0);  // 0 at the border, 1 at the line
        const double skin = (p.v - beyond) / (border - beyond);
        const double follows = red > 0 ? 1 : smooth_step(0, 1, skin);  // the skin beyond the border, less and less
        const double dy = follows * lips.press * (y->second - neutral_mm[i].y());
        const double dz = -roll * follows * (0.35 + 0.65 * smooth_step(0, 1, red));
        moved[i] += w * Vector(0, dy, dz);
    }
}

void MuscleModel::move_jaw(const Sphincter& jaw, std::span<const Point> neutral_mm, std::vector<Vector>& moved) const {
    using namespace place;
    // The joints lie just before the ears, under the skin.
    const Point& ear = neutral_mm[sheet_.nearest(98, -24)];
    const Eigen::Vector2d axis(ear.y(), ear.z() - 13);
    // An opening jaw also glides forward and down in its joints, about 6 and 4 mm when wide open.
    constexpr double glide_forward = 17, glide_down = 11;
    const double angle = jaw.jaw_rad, c = std::cos(angle), s = std::sin(angle);
    const Vector shift(jaw.jaw_left_mm, -glide_down * angle, glide_forward * angle + jaw.jaw_forward_mm);
    for (std::size_t i = 0; i < moved.size(); ++i) {
        const auto& p = sheet_.vertices[i];
        const double a = std::abs(p.s);
        const double out = 1 - smooth_step(38, 92, a);
        double w = 0;
        if (p.v > stomion || (p.v == stomion && !sheet_.lower_lip_side[i] && a < mouth_corner))
            w = 0.5 * smooth_step(7, mouth_corner, a) * smooth_step(-50, stomion, p.v) * out;
        else {
            const double at_line = (a < mouth_corner ? 1 - 0.5 * smooth_step(7, mouth_corner, a) : 0.5) * out;
            const double low = 1 - smooth_step(62, 102, a);
            w = at_line + (low - at_line) * smooth_step(stomion, -104, p.v);
            w *= smooth_step(-148, gnathion + 2, p.v);
        }
        const double y = neutral_mm[i].y() - axis.x(), z = neutral_mm[i].z() - axis.y();
        // To one side, the skin before the ear follows less: it would hang off the branch of the jaw.
        const Vector along(shift.x() * (1 - smooth_step(30, 84, a)), shift.y(), shift.z());
        moved[i] += w * (along + Vector(0, c * y - s * z - y, s * y + c * z - z));
    }
}

/// Lips that would pass through each other share the overlap.
void MuscleModel::part_crossing_lips(std::span<const Point> neutral_mm, std::vector<Vector>& moved) const {
    using namespace place;
    std::map<std::uint32_t, double> overlap;
    bool any = false;
    for (const auto& [up, low] : seam_) {
        const double o = std::max(0.0, (neutral_mm[low] + moved[low]).y() - (neutral_mm[up] + moved[up]).y());
        overlap[sheet_.vertices[up].column] = o;
        any = any || o > 0;
    }
    if (!any) return;
    // The skin beyond a corner gives way with it.
    constexpr double beyond = 9;
    const double at_corner[2] = {overlap.begin()->second, overlap.rbegin()->second};
    for (std::uint32_t i = 0; i < sheet_.vertices.size(); ++i) {
        const auto& p = sheet_.vertices[i];
        const double out = std::abs(p.s) - mouth_corner;
        if (out >= 0 && out < beyond) overlap[p.column] = at_corner[p.s > 0 ? 1 : 0] * hump(out, beyond);
    }
    for (std::size_t i = 0; i < moved.size(); ++i) {
        const auto& p = sheet_.vertices[i];
        const auto o = overlap.find(p.column);
        if (o == overlap.end()) continue;
        if (sheet_.lower_lip_side[i])
            moved[i].y() -= 0.35 * o->second * smooth_step(-93, stomion, p.v);
        else
            moved[i] += Vector(0, 0.65, 0.25) * o->second * smooth_step(-56, stomion, p.v);
    }
}

std::vector<Vector> MuscleModel::displacement_mm(const Motion& motion, std::span<const Point> neutral_mm) const {
    std::vector<Vector> moved(neutral_mm.size(), Vector::Zero());
    for (const auto& muscle : motion.muscles) pull(muscle, 1, neutral_mm, moved);
    if (!motion.muscles.empty()) gather(neutral_mm, moved);
    heap(motion, 1, moved);
    const auto& own = motion.sphincter;
    if (own.upper_lid_down != 0 || own.lower_lid_up != 0 || own.upper_lid_lift_mm != 0)
        move_lids(own, neutral_mm, moved);
    if (own.upper_roll_mm != 0 || own.lower_roll_mm != 0) turn_lips(own, motion.central ? 0 : 1, neutral_mm, moved);
    if (own.jaw_rad != 0 || own.jaw_forward_mm != 0 || own.jaw_left_mm != 0) move_jaw(own, neutral_mm, moved);
    part_crossing_lips(neutral_mm, moved);
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] *= held_[i];
    return moved;
}

/// Where a triangle of the front of the face has turned too far from how it lay at rest, the motion round it is
/// smoothed along the sheet until it has not. Lips and lids do turn in; they are left alone.
void MuscleModel::unfold(std::span<const Point> neutral_mm, std::vector<Vector>& moved) const {
    constexpr int rounds = 20;
    constexpr double least_cosine = 0.45;  // of the angle by which skin turns: 63 degrees is a fold
    constexpr double front = 68;           // mm from the midline: here nothing may turn from the scanner
    constexpr double underside = -106;     // of the jaw, from here on: it may turn away
    constexpr double unnoticed = 1e-3;     // a share of the smoothing that is left out, so that it stays local
    constexpr double tail_mm = 20;         // beyond, smoothing passes on less than that
    const auto free = [&](std::uint32_t i) {
        const auto& p = sheet_.vertices[i];
        const double a = std::abs(p.s);
        const bool lid = std::abs(p.across_eye) < 1.45 && p.v > -26 && p.v < 12;
        const bool lip = a < 30 && p.v < -64 && p.v > -92;
        return !lid && !lip;
    };
    const auto lines_from = [&](std::size_t first, std::size_t last) {
        return std::span(lines_).subspan(first, last - first);
    };
    const auto columns = lines_from(0, columns_), rows = lines_from(columns_, lines_.size());
    std::vector<std::uint32_t> suspects(triangles_.size());
    std::iota(suspects.begin(), suspects.end(), 0U);
    std::vector<double> folded, smooth(moved.size());
    for (int round = 0; round < rounds; ++round) {
        folded.assign(moved.size(), 0);
        bool any = false;
        for (const auto index : suspects) {
            const auto& t = triangles_[index];
            const Point &a = neutral_mm[t[0]], &b = neutral_mm[t[1]], &c = neutral_mm[t[2]];
            const Vector was = (b - a).cross(c - a);
            const Vector is = (b - a + moved[t[1]] - moved[t[0]]).cross(c - a + moved[t[2]] - moved[t[0]]);
            const auto& p = sheet_.vertices[t[0]];
            const bool away = is.z() <= 0 && was.z() > 0 && std::abs(p.s) < front && p.v > underside;
            if ((!away && is.dot(was) >= least_cosine * is.norm() * was.norm()) || !free(t[0])) continue;
            any = true;
            for (const auto i : t) folded[i] = 1;
        }
        if (!any) return;
        for (const auto& set : {columns, rows}) {
            for (const auto& line : set) smooth_along(line, folded);
            for (auto& f : folded) f = f < unnoticed ? 0 : f;
        }
        for (std::size_t i = 0; i < moved.size(); ++i)
            folded[i] = free(static_cast<std::uint32_t>(i)) ? std::min(1.0, 4 * folded[i]) : 0;
        // Only what is near is smoothed.
        const auto touched = [&](const SheetLine& line) {
            return std::any_of(line.vertices.begin(), line.vertices.end(), [&](auto i) { return folded[i] > 0; });
        };
        const auto place_of = [&](const SheetLine& column) { return sheet_.vertices[column.vertices.front()].s; };
        std::vector<double> touched_s;
        for (const auto& column : columns)
            if (touched(column)) touched_s.push_back(place_of(column));
        std::vector<const SheetLine*> near;
        for (const auto& column : columns)
            if (std::any_of(touched_s.begin(), touched_s.end(),
                            [&](double s) { return std::abs(s - place_of(column)) < tail_mm; }))
                near.push_back(&column);
        for (const auto& row : rows)
            if (touched(row)) near.push_back(&row);
        for (int axis = 0; axis < 3; ++axis) {
            for (std::size_t i = 0; i < moved.size(); ++i) smooth[i] = moved[i][axis];
            for (const auto* line : near) smooth_along(*line, smooth);
            for (std::size_t i = 0; i < moved.size(); ++i)
                if (folded[i] > 0) moved[i][axis] += folded[i] * (smooth[i] - moved[i][axis]);
        }
        // What did not move has not turned.
        suspects.clear();
        for (std::uint32_t index = 0; index < triangles_.size(); ++index) {
            const auto& t = triangles_[index];
            if (folded[t[0]] > 0 || folded[t[1]] > 0 || folded[t[2]] > 0) suspects.push_back(index);
        }
    }
}

/// Lids that would pass each other share the overlap, the upper one giving way most; those of a closed eye share what
/// gap is left. They glide over the ball as move_lids has them.
void MuscleModel::meet_lids(std::span<const Point> neutral_mm, bool right, bool closed,
                            std::vector<Vector>& moved) const {
    using namespace place;
    constexpr double upper_part = 0.85;
    const auto here = [&](std::uint32_t i) { return right ? sheet_.mirror[i] : i; };
    for (const auto& column : eye_columns_) {
        const double q = sheet_.vertices[column.front()].across_eye;
        if (std::abs(q) >= 1) continue;
        double gap = 0;
        for (const auto left : column) {
            const auto i = here(left);
            const double y = neutral_mm[i].y() + moved[i].y();
            if (sheet_.vertices[left].v == upper_lid) gap += y;
            if (sheet_.vertices[left].v == lower_lid) gap -= y;
        }
        if (gap >= 0 && !closed) continue;
        const auto ball_z = [&](double y) {  // the surface under the lids at a height of this column
            std::size_t k = 0;
            while (k + 2 < column.size() && neutral_mm[here(column[k + 1])].y() > y) ++k;
            const auto under = [&](std::size_t j) {
                const double v = sheet_.vertices[column[j]].v;
                const auto lid = lid_thickness_mm(q, v);
                return neutral_mm[here(column[j])].z() - lid.upper * smooth_step(8, 3, v) -
                       lid.lower * smooth_step(-21, -15, v);
            };
            const double a = neutral_mm[here(column[k])].y(), b = neutral_mm[here(column[k + 1])].y();
            const double f = std::clamp((a - y) / std::max(1e-9, a - b), 0.0, 1.0);
            return under(k) + f * (under(k + 1) - under(k));
        };
        for (const auto left : column) {
            const double v = sheet_.vertices[left].v;
            const double upper = v >= upper_lid   ? 1 - smooth_step(upper_lid + 0.8, 9.5, v)
                                 : v <= lower_lid ? 0
                                                  : (v - lower_lid) / (upper_lid - lower_lid);
            const double lower = v >= upper_lid ? 0 : v <= lower_lid ? smooth_step(-24, lower_lid - 0.8, v) : 1 - upper;
            const double dy = gap * ((1 - upper_part) * lower - upper_part * upper);
            if (dy == 0) continue;
            const auto i = here(left);
            const double y = neutral_mm[i].y() + moved[i].y();
            const double glides = std::max(upper, lower) * smooth_step(1.15, 0.7, std::abs(q));
            moved[i] += Vector(0, dy, glides * (ball_z(y + dy) - ball_z(y)));
        }
    }
}

void MuscleModel::settle(std::span<const Point> neutral_mm, const Contact& contact, std::vector<Vector>& moved) const {
    unfold(neutral_mm, moved);
    part_crossing_lips(neutral_mm, moved);
    meet_lids(neutral_mm, false, contact.left_eye_closed, moved);
    meet_lids(neutral_mm, true, contact.right_eye_closed, moved);
}

}  // namespace mimik::synthesis
