#include "video/curve_fit.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::video {
namespace {

using enum FaceCurve;

struct GroupCurves {
    FaceCurve upper, lower;  ///< of a nostril the same
    bool corners_shared;
};
GroupCurves curves_of(FeatureGroup group) {
    switch (group) {
        case FeatureGroup::brow_right:
            return {brow_right_upper, brow_right_lower, false};
        case FeatureGroup::brow_left:
            return {brow_left_upper, brow_left_lower, false};
        case FeatureGroup::eye_right:
            return {lid_right_upper, lid_right_lower, true};
        case FeatureGroup::eye_left:
            return {lid_left_upper, lid_left_lower, true};
        case FeatureGroup::nostril_right:
            return {nostril_right, nostril_right, false};
        case FeatureGroup::nostril_left:
            return {nostril_left, nostril_left, false};
        case FeatureGroup::lips_outer:
            return {lip_outer_upper, lip_outer_lower, true};
        default:
            return {lip_inner_upper, lip_inner_lower, true};
    }
}
bool is_nostril(FeatureGroup group) {
    return group == FeatureGroup::nostril_right || group == FeatureGroup::nostril_left;
}

SnakeGroup group_of(const FaceCurves& curves, FeatureGroup group) {
    const auto [upper, lower, shared] = curves_of(group);
    SnakeGroup made;
    const auto& u = curves[upper].control;
    const auto& l = curves[lower].control;
    if (is_nostril(group)) {  // the dark hole lies above its lower rim
        made.points.assign(u.begin(), u.end());
        made.curves = {{{0, 1, 2, 3}, -1}};
    } else if (shared) {
        made.points = {0.5 * (u[0] + l[0]), u[1], u[2], 0.5 * (u[3] + l[3]), l[1], l[2]};
        made.curves = {{{0, 1, 2, 3}, 1}, {{0, 4, 5, 3}, -1}};
    } else {
        made.points = {u[0], u[1], u[2], u[3], l[0], l[1], l[2], l[3]};
        made.curves = {{{0, 1, 2, 3}, 1}, {{4, 5, 6, 7}, -1}};
    }
    return made;
}

void put_back(const SnakeGroup& group, FeatureGroup which, FaceCurves& curves) {
    const auto [upper, lower, shared] = curves_of(which);
    curves[upper] = group.curve(0);
    if (group.curves.size() > 1) curves[lower] = group.curve(1);
}

const std::vector<SnakeLevel>& levels_for(const PatchLevels& levels, FeatureGroup group) {
    if (group == FeatureGroup::eye_right || group == FeatureGroup::eye_left) return levels.eye;
    return group == FeatureGroup::lips_inner ? levels.mouth : levels.feature;
}
const FloatImage& map_for(const PatchLevels& levels, FeatureGroup group) {
    if (group == FeatureGroup::eye_right || group == FeatureGroup::eye_left) return levels.maps.eye;
    return group == FeatureGroup::lips_inner ? levels.maps.mouth : levels.maps.feature;
}

BlobBox bounds(const SnakeGroup& group) {
    BlobBox box{1e9, 1e9, -1e9, -1e9};
    for (std::size_t c = 0; c < group.curves.size(); ++c)
        for (int k = 0; k <= 8; ++k) {
            const Pixel at = group.curve(c).at(k / 8.0);
            box = {std::min(box.left, at.x()), std::min(box.top, at.y()), std::max(box.right, at.x()),
                   std::max(box.bottom, at.y())};
        }
    return box;
}

/// The group scaled and moved so that its curves fill a box.
SnakeGroup filling(SnakeGroup group, const BlobBox& box) {
    const auto own = bounds(group);
    const double across = box.width() / std::max(1.0, own.width());
    const double down = own.height() > 2 ? box.height() / own.height() : 1.0;
    for (auto& p : group.points)
        p = {box.left + (p.x() - own.left) * across,
             own.height() > 2 ? box.top + (p.y() - own.top) * down
                              : 0.5 * (box.top + box.bottom) + p.y() - 0.5 * (own.top + own.bottom)};
    if (own.height() > 2 || box.height() < 3 || group.curves.size() < 2) return group;
    // Curves that lie on each other part: the middle points take the box's height.
    const double part = 0.5 * box.height() / 0.75;
    for (const std::size_t k : {1, 2}) group.points[k].y() -= part;
    for (const std::size_t k : {4, 5}) group.points[k].y() += part;
    return group;
}

/// The mean face's curves turned, scaled and moved in the patch.
FaceCurves placed_mean(double dx, double dy, double scale, double turn_rad) {
    FaceCurves placed = mean_face_curves();
    const Eigen::Rotation2Dd turn(turn_rad);
    // About a point between eyes and mouth: a wrong size or turn then moves all features alike.
    const Pixel pivot(0, 0.35);
    for (auto& curve : placed.curve)
        for (auto& p : curve.control) p = patch_from_mean(Pixel(turn * (scale * (p - pivot))) + pivot) + Pixel(dx, dy);
    return placed;
}

double face_contrast(const FaceCurves& curves, const PatchLevels& levels) {
    constexpr double offset_px = 6;
    double sum = 0;
    const auto add = [&](FaceCurve curve, double inside, const SnakeLevel& level, double weight) {
        sum += weight * std::min(0.8, snake_contrast(curves[curve], inside, level.intensity, offset_px));
    };
    const auto& feature = levels.feature.front();
    const auto& eye = levels.eye.front();
    for (const auto brow : {brow_right_upper, brow_left_upper}) add(brow, 1, feature, 0.7);
    for (const auto brow : {brow_right_lower, brow_left_lower}) add(brow, -1, feature, 0.7);
    for (const auto lid : {lid_right_upper, lid_left_upper}) add(lid, 1, eye, 1);
    for (const auto lid : {lid_right_lower, lid_left_lower}) add(lid, -1, eye, 1);
    for (const auto nostril : {nostril_right, nostril_left}) add(nostril, -1, feature, 0.7);
    add(lip_outer_upper, 1, feature, 1.2);
    add(lip_outer_lower, -1, feature, 1.2);
    return sum / 10.6;
}

}  // namespace

void CurveFitOptions::check() const {
    snake.check();
    blob.check();
    if (!(wide_blur_px >= fine_blur_px && fine_blur_px >= 0))
        throw InputError(fmt::format("wide_blur_px is {} and fine_blur_px {}; give the wider first, both 0 or more",
                                     wide_blur_px, fine_blur_px));
}

PatchLevels levels_of(const io::Image& patch, const ColourWeights& weights, const CurveFitOptions& options) {
    PatchLevels levels;
    levels.maps = transform_colours(patch, weights);
    const std::array<double, 2> blurs = {options.wide_blur_px, options.fine_blur_px};
    levels.feature = snake_levels(levels.maps.feature, blurs);
    levels.eye = snake_levels(levels.maps.eye, blurs);
    levels.mouth = snake_levels(levels.maps.mouth, blurs);
    return levels;
}

FaceCurves align_mean_face(const PatchLevels& levels, double& contrast, bool coarse) {
    std::array<double, 4> best = {0, 0, 1, 0}, step = {5, 5, 0.09, 0.1};
    contrast = -1e9;
    const auto consider = [&](const std::array<double, 4>& at) {
        // Far from where the finder saw the face there must be more to see.
        const double away = std::hypot(at[0], at[1]) / 60 + 0.6 * std::abs(at[2] - 1) + 0.3 * std::abs(at[3]);
        const double now = face_contrast(placed_mean(at[0], at[1], at[2], at[3]), levels) - 0.12 * away;
        if (now <= contrast) return false;
        contrast = now;
        best = at;
        return true;
    };
    consider(best);
    for (int x = -3; coarse && x <= 3; ++x)
        for (int y = -4; y <= 4; ++y)
            for (int s = -2; s <= 2; ++s)
                for (int r = -2; r <= 2; ++r) consider({x * step[0], y * step[1], 1 + s * step[2], r * step[3]});
    for (int round = 0; round < 5; ++round) {
        for (auto& s : step) s *= 0.5;
        for (int again = 0; again < 3; ++again)
            for (std::size_t k = 0; k < 4; ++k)
                for (const double sign : {-1.0, 1.0}) {
                    auto tried = best;
                    tried[k] += sign * step[k];
                    consider(tried);
                }
    }
    return placed_mean(best[0], best[1], best[2], best[3]);
}

BlobBox box_of(const FaceCurves& curves, FeatureGroup group) {
    auto box = bounds(group_of(curves, group));
    const double unit = patch_outer_eyes_px;
    double wide = 0.05, high = 0.07;
    if (group == FeatureGroup::lips_outer) wide = 0.1, high = 0.14;
    if (group == FeatureGroup::lips_inner) wide = 0.02, high = 0.08;
    if (group == FeatureGroup::eye_right || group == FeatureGroup::eye_left) wide = 0.04, high = 0.05;
    return {box.left - wide * unit, box.top - high * unit, box.right + wide * unit, box.bottom + high * unit};
}

namespace {

double contrast_of(const SnakeGroup& group, const FloatImage& intensity, const CurveFitOptions& options) {
    double sum = 0;
    for (std::size_t c = 0; c < group.curves.size(); ++c)
        sum += snake_contrast(group.curve(c), group.curves[c].inside, intensity, options.snake.offset_px);
    return sum / static_cast<double>(group.curves.size());
}

}  // namespace

GroupFit fit_group(FaceCurves& curves, FeatureGroup group, const PatchLevels& levels, bool try_blob,
                   const CurveFitOptions& options) {
    const auto& pyramid = levels_for(levels, group);
    const auto start = group_of(curves, group);
    auto best = start;
    GroupFit fit;
    auto snake = options.snake;
    // Of all features the mouth alone changes its width.
    snake.widen = snake.widen && (group == FeatureGroup::lips_outer || group == FeatureGroup::lips_inner);
    fit.energy = minimise_snake(best, pyramid, snake);
    if (try_blob && !is_nostril(group)) {
        const auto within = box_of(curves, group);
        if (const auto blob = feature_blob(map_for(levels, group), within, options.blob)) {
            const auto own = bounds(start);
            const double across = blob->box.width() / std::max(1.0, own.width());
            // A blob of another width is another thing: a shadow, or half of the feature.
            if (across > 0.7 && across < 1.35) {
                auto other = filling(start, blob->box);
                const double energy = minimise_snake(other, pyramid, snake);
                if (energy < fit.energy - 0.03) {
                    fit.energy = energy;
                    best = std::move(other);
                }
            }
        }
    }
    put_back(best, group, curves);
    fit.contrast = contrast_of(best, pyramid.back().intensity, options);
    return fit;
}

double contrast_of(const FaceCurves& curves, const PatchLevels& levels, const CurveFitOptions& options) {
    double sum = 0;
    for (std::size_t g = 0; g < feature_group_count; ++g) {
        const auto group = static_cast<FeatureGroup>(g);
        sum += contrast_of(group_of(curves, group), levels_for(levels, group).back().intensity, options);
    }
    return sum / static_cast<double>(feature_group_count);
}

double confidence_of(double contrast) {
    constexpr double sure = 0.4;  // rendered faces, and talking heads in good light, show more
    return std::clamp(contrast / sure, 0.0, 1.0);
}

void part_curves(FaceCurves& curves) {
    const auto part = [&](FaceCurve upper, FaceCurve lower) {
        for (std::size_t k = 0; k < 4; ++k) {
            auto& u = curves[upper].control[k];
            auto& l = curves[lower].control[k];
            if (u.y() > l.y()) u.y() = l.y() = 0.5 * (u.y() + l.y());
        }
    };
    part(lid_right_upper, lid_right_lower);
    part(lid_left_upper, lid_left_lower);
    part(lip_inner_upper, lip_inner_lower);
    // The inner lips lie within the outer ones.
    const auto within = [&](FaceCurve inner, FaceCurve outer, double sign) {
        for (std::size_t k = 1; k < 3; ++k) {
            auto& in = curves[inner].control[k];
            const double edge = curves[outer].control[k].y() + sign * 0.02 * patch_outer_eyes_px;
            in.y() = sign > 0 ? std::max(in.y(), edge) : std::min(in.y(), edge);
        }
    };
    within(lip_inner_upper, lip_outer_upper, 1);
    within(lip_inner_lower, lip_outer_lower, -1);
}

}  // namespace mimik::video
