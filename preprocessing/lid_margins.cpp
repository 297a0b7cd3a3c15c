#include "preprocessing/lid_margins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "base/errors.h"
#include "geometry/point_index.h"
#include "geometry/topology.h"
#include "geometry/weld.h"

namespace mimik::preprocessing {

using geometry::Point;
using geometry::Triangle;
using geometry::Vector;

namespace {

constexpr double degree = std::numbers::pi / 180;
// Elevations are told apart to a fifth of a degree: 0.05 mm on an eyeball.
constexpr double bin_rad = 0.2 * degree, highest_rad = 75 * degree;
constexpr int bins = 750;
static_assert(bins * 0.2 == 2 * 75);

double elevation_rad(const Vector& local) { return std::atan2(local.y(), local.z()); }
double rho_mm(const Vector& local) { return std::hypot(local.y(), local.z()); }

struct Sphere {
    Point centre_mm = Point::Zero();
    double radius_mm = 0.0;
    double rms_mm = 0.0;
};

/// Least squares without a start. Empty of fewer than 10 points or of points in a plane.
std::optional<Sphere> fit_sphere(std::span<const Point> points) {
    if (points.size() < 10) return std::nullopt;
    Point middle = Point::Zero();
    for (const auto& p : points) middle += p / static_cast<double>(points.size());
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const auto& p : points) {
        const Vector q = p - middle;
        const Eigen::Vector4d row(2 * q.x(), 2 * q.y(), 2 * q.z(), 1.0);
        normal += row * row.transpose();
        right += row * q.squaredNorm();
    }
    const Eigen::LDLT<Eigen::Matrix4d> solver(normal);
    if (!(solver.rcond() > 1e-9)) return std::nullopt;
    const Eigen::Vector4d answer = solver.solve(right);
    const double squared = answer.w() + answer.head<3>().squaredNorm();
    if (!(squared > 0)) return std::nullopt;
    Sphere sphere{middle + answer.head<3>(), std::sqrt(squared), 0.0};
    double sum = 0;
    for (const auto& p : points) sum += std::pow((p - sphere.centre_mm).norm() - sphere.radius_mm, 2);
    sphere.rms_mm = std::sqrt(sum / static_cast<double>(points.size()));
    return sphere;
}

/// What everybody here looks at.
struct Face {
    std::span<const Point> vertices_mm;
    std::span<const Triangle> triangles;
    const geometry::VertexMask& measured;
    const LidMarginOptions& options;
    std::vector<std::uint32_t> part = {};  ///< per vertex: one vertex of its part of the mesh
    std::uint32_t skin = 0;                ///< the part that the nose belongs to
};

/// Hair may have more vertices than skin, but the tip of the nose is skin.
void find_parts(Face& face, const geometry::Landmarks& landmarks) {
    const auto parts = geometry::connected_parts(face.vertices_mm, face.triangles);
    std::vector<std::size_t> count(parts.size(), 0);
    face.part.resize(parts.size());
    for (std::uint32_t v = 0; v < parts.size(); ++v) {
        face.part[v] = parts[v] == geometry::not_welded ? v : parts[v];
        ++count[face.part[v]];
    }
    if (const auto* nose = landmarks.find("nose_tip")) {
        const auto nearest = geometry::nearest_point(face.vertices_mm, nose->position_mm,
                                                     [&](std::size_t v) { return parts[v] != geometry::not_welded; });
        if (nearest) face.skin = face.part[*nearest];
    } else if (!count.empty()) {
        face.skin = static_cast<std::uint32_t>(std::max_element(count.begin(), count.end()) - count.begin());
    }
}

/// The frame of an eye, and an eyeball where most have it.
EyeLids begin(const Point& right_corner, const Point& left_corner, double outward, const LidMarginOptions& options) {
    EyeLids eye;
    eye.width_mm = (left_corner - right_corner).norm();
    const Vector along = (left_corner - right_corner) / eye.width_mm;
    const Vector out = (Vector::UnitZ() - along * along.z()).normalized();
    eye.axes.row(0) = along;
    eye.axes.row(1) = out.cross(along);
    eye.axes.row(2) = out;
    eye.radius_mm = options.usual_radius * eye.width_mm;
    // Corners lie below the middle of the eyeball, and the inner one is farther from it (both heads that were looked
    // at).
    eye.centre_mm =
        (left_corner + right_corner) / 2 + eye.axes.transpose() * (eye.width_mm * Vector(outward * 0.06, 0.05, -0.38));
    return eye;
}

/// The eyeball that is a part of the mesh, and what lies within it (iris, lens): marked.
void find_eyeball_part(const Face& face, EyeLids& eye, geometry::VertexMask& eyeball) {
    std::map<std::uint32_t, std::vector<Point>> parts;
    for (const auto& t : face.triangles)
        for (const auto v : t)
            if (face.part[v] != face.skin) parts[face.part[v]].push_back(face.vertices_mm[v]);
    std::optional<Sphere> best;
    std::size_t most = 0;
    for (const auto& [part, points] : parts) {
        if ((points.front() - eye.centre_mm).norm() > eye.width_mm) continue;
        const auto sphere = fit_sphere(points);
        if (!sphere || sphere->radius_mm < 0.3 * eye.width_mm || sphere->radius_mm > 0.65 * eye.width_mm ||
            sphere->rms_mm > 0.1 * sphere->radius_mm || points.size() <= most ||
            (sphere->centre_mm - eye.centre_mm).norm() > 0.35 * eye.width_mm)
            continue;
        best = sphere;
        most = points.size();
    }
    if (!best) return;
    eye.eyeball = EyeballKind::part;
    eye.centre_mm = best->centre_mm;
    eye.radius_mm = best->radius_mm;
    constexpr double cornea = 1.15;  // it stands out of the ball
    for (const auto& [part, points] : parts)
        if (std::all_of(points.begin(), points.end(),
                        [&](const Point& p) { return (p - eye.centre_mm).norm() < cornea * eye.radius_mm; }))
            for (std::uint32_t v = 0; v < face.part.size(); ++v)
                if (face.part[v] == part) eyeball[v] = 1;
}

struct Interval {
    int first = 0, last = 0;  ///< bins; both open
    [[nodiscard]] int overlap(const Interval& other) const {
        return std::min(last, other.last) - std::max(first, other.first) + 1;
    }
};

/// One section across the eye: the elevations at which there is skin.
class Section {
public:
    Section(const EyeLids& eye, double x_mm) : x_mm_(x_mm), rho_mm_(bins, 0.0) {
        const double ball = std::sqrt(std::max(eye.radius_mm * eye.radius_mm - x_mm * x_mm, 0.0));
        least_rho_mm_ = ball;
    }
    void least_rho(double rho_mm) { least_rho_mm_ = rho_mm; }
    [[nodiscard]] double ball_rho() const { return least_rho_mm_; }

    void add(const std::array<Vector, 3>& corners) {
        std::array<Vector, 2> ends;
        int found = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const auto &a = corners[c], &b = corners[(c + 1) % 3];
            if ((a.x() < x_mm_) == (b.x() < x_mm_)) continue;
            if (found < 2) ends[static_cast<std::size_t>(found++)] = a + (b - a) * ((x_mm_ - a.x()) / (b.x() - a.x()));
        }
        if (found < 2) return;
        const int steps = 1 + static_cast<int>((ends[0] - ends[1]).norm() / 0.025);
        for (int k = 0; k <= steps; ++k) {
            const Vector p = ends[0] + (ends[1] - ends[0]) * (static_cast<double>(k) / steps);
            const double rho = rho_mm(p);
            if (rho < least_rho_mm_ || p.z() < 0) continue;
            const int bin = static_cast<int>(std::floor((elevation_rad(p) + highest_rad) / bin_rad));
            if (bin >= 0 && bin < bins)
                rho_mm_[static_cast<std::size_t>(bin)] = std::max(rho_mm_[static_cast<std::size_t>(bin)], rho);
        }
    }
    /// The opening, bounded by skin on both sides, that shares most with another. Empty: none.
    [[nodiscard]] std::optional<Interval> opening(const Interval& about) const {
        std::optional<Interval> best;
        int start = -1;
        for (int bin = 0; bin < bins; ++bin) {
            const bool open = rho_mm_[static_cast<std::size_t>(bin)] == 0.0;
            if (open && start < 0 && bin > 0) start = bin;
            if (open && bin == 0) start = bins;  // no skin below
            if (!open && start >= 0) {
                if (const Interval here{start, bin - 1};
                    start < bins && here.overlap(about) > (best ? best->overlap(about) : 0))
                    best = here;
                start = -1;
            }
        }
        return best;
    }
    [[nodiscard]] LidSection margins(const Interval& open) const {
        return {x_mm_, (open.last + 1) * bin_rad - highest_rad, open.first * bin_rad - highest_rad,
                rho_mm_[static_cast<std::size_t>(open.last) + 1], rho_mm_[static_cast<std::size_t>(open.first) - 1]};
    }

private:
    double x_mm_, least_rho_mm_ = 0.0;
    std::vector<double> rho_mm_;  // per bin: of the outermost skin; 0: there is none
};

/// Triangles of skin about the eye, in its frame.
std::vector<std::array<Vector, 3>> skin_about(const Face& face, const EyeLids& eye,
                                              const geometry::VertexMask& eyeball) {
    std::vector<std::array<Vector, 3>> skin;
    const double reach_mm = 1.5 * eye.width_mm;
    for (const auto& t : face.triangles) {
        std::array<Vector, 3> corners;
        bool is_skin = true;
        for (std::size_t c = 0; c < 3 && is_skin; ++c) {
            is_skin = face.measured[t[c]] && !eyeball[t[c]] && face.part[t[c]] == face.skin;
            corners[c] = eye.local_mm(face.vertices_mm[t[c]]);
            is_skin = is_skin && corners[c].norm() < reach_mm;
        }
        if (is_skin) skin.push_back(corners);
    }
    return skin;
}

/// The sections from one corner to the other, each where it belongs to the opening of its neighbour.
/// @param corner_x_mm  of the corners, in the eye's frame
std::vector<LidSection> cut(const Face& face, const EyeLids& eye, const geometry::VertexMask& eyeball,
                            const std::array<double, 2>& corner_x_mm, double corner_elevation_rad, bool ball_is_skin) {
    const auto& options = face.options;
    const double beyond_mm = options.beyond_corner * eye.width_mm;
    const double from_mm = corner_x_mm[0] - beyond_mm, to_mm = corner_x_mm[1] + beyond_mm;
    // An eyeball that is there says where a socket begins; one that is guessed lies deeper or less deep than the guess.
    const double deepest = eye.eyeball == EyeballKind::part ? 0.95 : 0.5;
    std::vector<Section> all;
    for (int k = 0; k < options.columns; ++k) {
        auto& section = all.emplace_back(eye, from_mm + (to_mm - from_mm) * k / (options.columns - 1));
        // What lies deeper than the eyeball is the wall of a socket; on one surface with it, what stands off is a lid.
        const double ball_mm = section.ball_rho();
        section.least_rho(ball_is_skin ? (ball_mm > 0 ? ball_mm + options.step_mm : 0.0)
                                       : deepest * std::max(ball_mm, 0.3 * eye.radius_mm));
    }
    const double step_mm = (to_mm - from_mm) / (options.columns - 1);
    for (const auto& triangle : skin_about(face, eye, eyeball)) {
        const auto [low, high] = std::minmax({triangle[0].x(), triangle[1].x(), triangle[2].x()});
        const int first = std::max(0, static_cast<int>(std::ceil((low - from_mm) / step_mm)));
        const int last = std::min(options.columns - 1, static_cast<int>(std::floor((high - from_mm) / step_mm)));
        for (int k = first; k <= last; ++k) all[static_cast<std::size_t>(k)].add(triangle);
    }
    const auto bin_of = [](double rad) { return static_cast<int>((rad + highest_rad) / bin_rad); };
    const std::size_t middle = all.size() / 2;
    const auto begun =
        all[middle].opening({bin_of(corner_elevation_rad - 10 * degree), bin_of(corner_elevation_rad + 20 * degree)});
    if (!begun) return {};
    std::vector<LidSection> sections = {all[middle].margins(*begun)};
    for (const int way : {-1, 1}) {
        Interval last = *begun;
        for (auto k = static_cast<int>(middle) + way; k >= 0 && k < options.columns; k += way) {
            const auto open = all[static_cast<std::size_t>(k)].opening(last);
            if (!open) break;
            last = *open;
            const auto margins = all[static_cast<std::size_t>(k)].margins(*open);
            sections.insert(way < 0 ? sections.begin() : sections.end(), margins);
        }
    }
    return sections;
}

/// Moves the eyeball to where the margins lie on it; the usual one counts as a few points.
void settle_eyeball(EyeLids& eye, const std::vector<LidSection>& sections, const LidMarginOptions& options) {
    std::vector<Vector> rim;  // eye's frame
    for (const auto& s : sections) {
        if (std::abs(s.x_mm) > 0.36 * eye.width_mm) continue;
        rim.emplace_back(s.x_mm, s.upper_rho_mm * std::sin(s.upper_rad), s.upper_rho_mm * std::cos(s.upper_rad));
        rim.emplace_back(s.x_mm, s.lower_rho_mm * std::sin(s.lower_rad), s.lower_rho_mm * std::cos(s.lower_rad));
    }
    const double usual_mm = options.usual_radius * eye.width_mm;
    const double sure_of_radius = 1.0 / std::pow(0.04 * eye.width_mm, 2);
    const double sure_of_centre = 1.0 / std::pow(0.03 * eye.width_mm, 2);
    const double sure_of_point = 1.0 / std::pow(0.8, 2);  // of neighbouring sections each says little
    Vector centre = Vector::Zero();
    double radius = eye.radius_mm;
    for (int step = 0; step < 12; ++step) {
        Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
        Eigen::Vector4d right = Eigen::Vector4d::Zero();
        for (const auto& p : rim) {
            const Vector off = p - centre;
            Eigen::Vector4d row;
            row << -off.normalized(), -1.0;
            normal += sure_of_point / 8 * row * row.transpose();
            right -= sure_of_point / 8 * row * (off.norm() - radius);
        }
        normal.diagonal() += Eigen::Vector4d(sure_of_centre, sure_of_centre, sure_of_centre, sure_of_radius);
        right.head<3>() -= sure_of_centre * centre;
        right.w() -= sure_of_radius * (radius - usual_mm);
        const Eigen::Vector4d change = normal.ldlt().solve(right);
        centre += change.head<3>();
        radius += change.w();
    }
    eye.centre_mm += eye.axes.transpose() * centre;
    eye.radius_mm = radius;
}

/// Fits the eyeball on the surface between the corners. False where that is no ball.
bool eyeball_on_surface(const Face& face, EyeLids& eye, const Point& between_corners) {
    std::vector<Point> front;
    for (const auto& t : face.triangles)
        for (const auto v : t) {
            if (!face.measured[v]) continue;
            const Vector q = eye.axes * (face.vertices_mm[v] - between_corners) / eye.width_mm;
            if (std::abs(q.x()) < 0.28 && std::abs(q.y() - 0.02) < 0.10 && std::abs(q.z() - 0.1) < 0.3)
                front.push_back(face.vertices_mm[v]);
        }
    std::optional<Sphere> sphere;
    for (int step = 0; step < 4; ++step) {
        sphere = fit_sphere(front);
        if (!sphere) return false;
        const double far_mm = std::max(0.3, 2 * sphere->rms_mm);
        std::erase_if(front, [&](const Point& p) {
            return std::abs((p - sphere->centre_mm).norm() - sphere->radius_mm) > far_mm;
        });
    }
    if (!(sphere->rms_mm < 0.3) || sphere->radius_mm < 0.3 * eye.width_mm || sphere->radius_mm > 0.65 * eye.width_mm)
        return false;
    eye.centre_mm = sphere->centre_mm;
    eye.radius_mm = sphere->radius_mm;
    return true;
}

/// Median of three, then mean of three, but for the ends, where openings end steeply. @return how far that moved them,
/// mm on the eyeball, on average
double smooth(std::vector<LidSection>& sections, double radius_mm) {
    const auto before = sections;
    for (auto member :
         {&LidSection::upper_rad, &LidSection::lower_rad, &LidSection::upper_rho_mm, &LidSection::lower_rho_mm}) {
        for (const bool median : {true, false}) {
            const auto old = sections;
            for (std::size_t k = 3; k + 3 < old.size(); ++k) {
                const double a = old[k - 1].*member, b = old[k].*member, c = old[k + 1].*member;
                sections[k].*member = median ? std::max(std::min(a, b), std::min(std::max(a, b), c)) : (a + b + c) / 3;
            }
        }
    }
    double moved = 0;
    for (std::size_t k = 0; k < before.size(); ++k)
        moved += (std::abs(before[k].upper_rad - sections[k].upper_rad) +
                  std::abs(before[k].lower_rad - sections[k].lower_rad)) *
                 radius_mm / 2;
    return before.empty() ? 0.0 : moved / static_cast<double>(before.size());
}

/// Judges the sections; empty: they are the margins.
std::string fault_of(const EyeLids& eye, const std::array<double, 2>& corner_x_mm, const LidMarginOptions& options,
                     double* share) {
    if (eye.sections.empty())
        return "there is no opening between the corners of the eye: it is closed, or was not seen";
    const double middle_mm = (corner_x_mm[0] + corner_x_mm[1]) / 2, tenth_mm = (corner_x_mm[1] - corner_x_mm[0]) / 10;
    const double step_mm = (1 + 2 * options.beyond_corner) * eye.width_mm / (options.columns - 1);
    double between = 0, height_mm = 0;
    for (const auto& s : eye.sections) {
        if (std::abs(s.x_mm - middle_mm) < 4 * tenth_mm) between += step_mm;
        if (std::abs(s.x_mm - middle_mm) < 2 * tenth_mm)
            height_mm = std::max(height_mm, (s.upper_rad - s.lower_rad) * eye.radius_mm);
    }
    *share = std::min(1.0, between / (8 * tenth_mm));
    if (height_mm < options.least_height * eye.width_mm)
        return fmt::format("the opening is {:.1f} mm high: the eye is closed, or was not seen", height_mm);
    if (height_mm > options.most_height * eye.width_mm)
        return fmt::format("the hole between the corners of the eye is {:.1f} mm high: more than lids leave open",
                           height_mm);
    // A ball that does not fit to the corners takes for lids what is eye there.
    const double least_share =
        eye.eyeball == EyeballKind::surface ? std::max(options.least_share, 0.8) : options.least_share;
    if (*share < least_share)
        return fmt::format("{:.0f} % of the sections between the corners of the eye show an opening", 100 * *share);
    return {};
}

/// One eye. @param outward  1 on the subject's left, -1 on the right
EyeLids find_eye(const Face& face, const Point& right_corner, const Point& left_corner, double outward,
                 geometry::VertexMask& eyeball) {
    const auto usual = begin(right_corner, left_corner, outward, face.options);
    auto eye = usual;
    if (!(usual.width_mm > 1e-6)) {
        eye.reason = "its corners are one point";
        return eye;
    }
    find_eyeball_part(face, eye, eyeball);
    const Point between = (left_corner + right_corner) / 2;
    double share = 0;
    const auto look = [&](EyeLids& at, bool ball_is_skin) {
        const std::array<double, 2> x_mm = {at.local_mm(right_corner).x(), at.local_mm(left_corner).x()};
        at.sections = cut(face, at, eyeball, x_mm, elevation_rad(at.local_mm(between)), ball_is_skin);
        const double roughness_mm = smooth(at.sections, at.radius_mm);
        at.reason = fault_of(at, x_mm, face.options, &share);
        at.found = at.reason.empty();
        at.confidence = at.found ? share * std::exp(-roughness_mm) : 0.0;
    };
    look(eye, false);
    if (eye.eyeball == EyeballKind::none) {
        for (int again = 0; again < 2 && eye.found; ++again) {
            auto settled = eye;
            settle_eyeball(settled, eye.sections, face.options);
            look(settled, false);
            if (!settled.found) break;  // what was found before stands
            eye = std::move(settled);
        }
        if (auto on_surface = usual; !eye.found && eyeball_on_surface(face, on_surface, between)) {
            on_surface.eyeball = EyeballKind::surface;
            look(on_surface, true);
            if (on_surface.found) return on_surface;
        }
    }
    return eye;
}

}  // namespace

const char* to_string(EyeballKind kind) {
    switch (kind) {
        case EyeballKind::none:
            return "none";
        case EyeballKind::part:
            return "part";
        case EyeballKind::surface:
            return "surface";
    }
    return "none";
}

void LidMarginOptions::check() const {
    if (columns < 5 || columns > 1000) throw InputError(fmt::format("columns is {}; give 5 to 1000", columns));
    for (const auto& [name, value] : {std::pair("beyond_corner", beyond_corner),
                                      std::pair("usual_radius", usual_radius), std::pair("least_height", least_height),
                                      std::pair("most_height", most_height), std::pair("least_share", least_share)})
        if (!(value >= 0 && value <= 1)) throw InputError(fmt::format("{} is {}; give 0 to 1", name, value));
    if (!(usual_radius >= 0.2)) throw InputError(fmt::format("usual_radius is {}; give 0.2 to 1", usual_radius));
    if (!(step_mm > 0)) throw InputError(fmt::format("step_mm is {}; give more than 0", step_mm));
}

LidMargins find_lid_margins(std::span<const Point> vertices_mm, std::span<const Triangle> triangles,
                            const geometry::VertexMask& measured, const geometry::Landmarks& landmarks,
                            const LidMarginOptions& options) {
    options.check();
    LidMargins margins;
    margins.eyeball.assign(vertices_mm.size(), 0);
    Face face{vertices_mm, triangles, measured, options};
    find_parts(face, landmarks);
    for (const bool left : {true, false}) {
        auto& eye = left ? margins.left : margins.right;
        const auto* outer = landmarks.find(left ? "eye_outer_left" : "eye_outer_right");
        const auto* inner = landmarks.find(left ? "eye_inner_left" : "eye_inner_right");
        if (!outer || !inner) {
            eye.reason = "a landmark of its corners is missing";
            continue;
        }
        const auto& [right_corner, left_corner] = left ? std::pair(inner, outer) : std::pair(outer, inner);
        eye = find_eye(face, right_corner->position_mm, left_corner->position_mm, left ? 1.0 : -1.0, margins.eyeball);
    }
    return margins;
}

}  // namespace mimik::preprocessing
