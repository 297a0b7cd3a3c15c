#include "animation/feature_vertices.h"

#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "animation/lid_field.h"
#include "base/errors.h"
#include "capture/feature_motion.h"
#include "geometry/landmarks.h"

namespace mimik::animation {
namespace {

using geometry::Landmark;
using geometry::Point;
using preprocessing::LipSide;

/// Where a feature is looked for, average frame, and whether its depth is only guessed.
struct Place {
    Point position_mm;
    bool depth_known = true;
    LipSide lip = LipSide::neither;
};

class Finder {
public:
    Finder(const PreparedTarget& target, std::span<const LipSide> lip_sides)
        : target_(target), lip_sides_(lip_sides), face_(target.normalised(modeling::Normalisation::similarity)) {}

    [[nodiscard]] std::optional<Place> place(std::string_view name) const {
        const auto lip = name.starts_with("upper_lip_inner")   ? LipSide::upper
                         : name.starts_with("lower_lip_inner") ? LipSide::lower
                                                               : LipSide::neither;
        if (const auto* mark = face_.landmarks.find(name)) return Place{mark->position_mm, true, lip};
        const bool left = name.ends_with("_left");
        const std::string side = left ? "_left" : "_right";
        if (name.starts_with("brow_outer_middle")) return between("brow_outer" + side, "brow_middle" + side, 0.5);
        if (name.starts_with("brow_inner_middle")) return between("brow_inner" + side, "brow_middle" + side, 0.5);
        if (name == "nose_base") return between("nose_tip", "upper_lip_outer", 0.55);
        if (name.starts_with("nostril")) return nostril(side);
        if (name.starts_with("lid_")) return lid(name, left);
        if (name.find("lip") != std::string_view::npos || name.starts_with("mouth_corner_inner"))
            return lip_point(name, side, lip);
        return std::nullopt;
    }

    /// The present vertex nearest to it, of the right lip.
    [[nodiscard]] std::optional<std::uint32_t> vertex(const Place& place) const {
        double best = std::numeric_limits<double>::infinity();
        std::optional<std::uint32_t> found;
        const double depth_weight = place.depth_known ? 1.0 : 0.05;
        const auto& present = target_.surface().present;
        for (std::uint32_t v = 0; v < present.size(); ++v) {
            if (!present[v]) continue;
            if (place.lip != LipSide::neither && !lip_sides_.empty() && lip_sides_[v] != place.lip) continue;
            const Point d = face_.vertices_mm[v] - place.position_mm;
            const double distance = d.x() * d.x() + d.y() * d.y() + depth_weight * d.z() * d.z();
            if (distance < best) {
                best = distance;
                found = v;
            }
        }
        return found;
    }

private:
    [[nodiscard]] const Point* mark(const std::string& name) const {
        const auto* found = face_.landmarks.find(name);
        return found ? &found->position_mm : nullptr;
    }
    [[nodiscard]] std::optional<Place> between(const std::string& from, const std::string& to, double share) const {
        const auto *a = mark(from), *b = mark(to);
        if (!a || !b) return std::nullopt;
        return Place{*a + share * (*b - *a), false};
    }
    [[nodiscard]] std::optional<Place> nostril(const std::string& side) const {
        const auto base = between("nose_tip", "upper_lip_outer", 0.55);
        const auto* wing = mark("nose_wing" + side);
        if (!base || !wing) return std::nullopt;
        return Place{0.5 * (base->position_mm + *wing), false};
    }

    /// At a third or two thirds of the opening; without margins 0.13 eye widths off the line of the corners.
    [[nodiscard]] std::optional<Place> lid(std::string_view name, bool left) const {
        const std::string side = left ? "_left" : "_right";
        const bool upper = name.starts_with("lid_upper"), outer = name.find("outer") != std::string_view::npos;
        const auto& lids = lid_margins(target_).of(left ? facs::Side::left : facs::Side::right);
        if (lids.found && lids.sections.size() >= 6) {
            // Sections go from the subject's right to the left: the outer corner of a left eye comes last.
            const double share = outer == left ? 2.0 / 3.0 : 1.0 / 3.0;
            const auto& section = lids.sections[static_cast<std::size_t>(
                std::lround(share * static_cast<double>(lids.sections.size() - 1)))];
            const double angle = upper ? section.upper_rad : section.lower_rad;
            const double rho = upper ? section.upper_rho_mm : section.lower_rho_mm;
            const Point local(section.x_mm, rho * std::sin(angle), rho * std::cos(angle));
            return Place{lids.axes.transpose() * local + lids.centre_mm, true};
        }
        const auto *in = mark("eye_inner" + side), *out = mark("eye_outer" + side);
        if (!in || !out) return std::nullopt;
        const Point across = *out - *in;
        return Place{
            *in + (outer ? 2.0 / 3.0 : 1.0 / 3.0) * across + Point(0, (upper ? 0.13 : -0.13) * across.norm(), 0),
            false};
    }

    /// On the parabola from the middle of a lip's edge to the corner of the mouth.
    [[nodiscard]] std::optional<Place> lip_point(std::string_view name, const std::string& side, LipSide lip) const {
        const bool corner = name.starts_with("mouth_corner_inner");
        const bool inner = corner || name.find("inner") != std::string_view::npos;
        const auto* end = mark("mouth_corner" + side);
        const auto* middle =
            mark(std::string(name.starts_with("lower") ? "lower" : "upper") + "_lip_" + (inner ? "inner" : "outer"));
        if (!end || !middle) return std::nullopt;
        double t = 0.5;
        if (corner) t = 0.92;
        if (name.find("peak") != std::string_view::npos) t = 0.3;
        if (name.find("side") != std::string_view::npos) t = 0.65;
        Point p = *middle + t * (*end - *middle);
        p.y() = middle->y() + t * t * (end->y() - middle->y());
        return Place{p, false, lip};
    }

    const PreparedTarget& target_;
    std::span<const LipSide> lip_sides_;
    const NormalisedTarget& face_;
};

}  // namespace

FeatureVertices feature_vertices(const PreparedTarget& target, std::span<const LipSide> lip_sides) {
    if (!lip_sides.empty() && lip_sides.size() != target.surface().size())
        throw InputError(fmt::format("{} sides of lips for {} vertices", lip_sides.size(), target.surface().size()));
    FeatureVertices found;
    const Finder finder(target, lip_sides);
    for (const auto& feature : capture::face_features()) {
        const auto place = finder.place(feature.name);
        const auto vertex = place ? finder.vertex(*place) : std::nullopt;
        if (!vertex) {
            found.remarks.push_back(fmt::format("{}: left out, the landmarks do not say where it is", feature.name));
            continue;
        }
        found.names.emplace_back(feature.name);
        found.vertices.push_back(*vertex);
    }
    for (const auto side : {facs::Side::left, facs::Side::right})
        if (const auto& lids = lid_margins(target).of(side); !lids.found)
            found.remarks.push_back(fmt::format("the lids of the {} eye are guessed: {}",
                                                side == facs::Side::left ? "left" : "right", lids.reason));
    return found;
}

geometry::Transform head_from_target(const PreparedTarget& target) {
    const auto& average_from_target = target.average_from_target(modeling::Normalisation::similarity);
    const Eigen::Matrix3d linear = average_from_target.linear();
    const Eigen::Matrix3d turn = linear / std::cbrt(linear.determinant());
    const auto& marks = target.surface().landmarks;
    const Point middle = 0.5 * (marks.position_mm("eye_outer_left") + marks.position_mm("eye_outer_right"));
    geometry::Transform head = geometry::Transform::Identity();
    head.linear() = turn;
    head.translation() = -(turn * middle);
    return head;
}

}  // namespace mimik::animation
