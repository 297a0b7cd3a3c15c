#include "capture/fill_gaps.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/text.h"
#include "geometry/rigid_fit.h"

namespace mimik::capture {

using geometry::Transform;
using geometry::Vector;

void FillOptions::check() const {
    if (!std::isfinite(longest_gap_s) || longest_gap_s < 0)
        throw InputError(fmt::format("longest_gap_s is {}; give 0 or more seconds", longest_gap_s));
    if (nearest < 3) throw InputError(fmt::format("nearest is {}; three are the least that say a rotation", nearest));
}

namespace {

/// The markers nearest to one in the first frame in which it is there with enough others; empty if there is none.
std::vector<std::size_t> nearest_markers(const MarkerSequence& sequence, std::size_t marker, std::size_t count) {
    for (std::size_t frame = 0; frame < sequence.frames(); ++frame) {
        if (!sequence.valid(frame, marker)) continue;
        std::vector<std::pair<double, std::size_t>> others;
        for (std::size_t other = 0; other < sequence.markers(); ++other)
            if (other != marker && sequence.valid(frame, other))
                others.emplace_back((sequence.at_mm(frame, other) - sequence.at_mm(frame, marker)).squaredNorm(),
                                    other);
        if (others.size() < 3) continue;
        std::sort(others.begin(), others.end());
        std::vector<std::size_t> nearest;
        for (std::size_t k = 0; k < std::min(count, others.size()); ++k) nearest.push_back(others[k].second);
        return nearest;
    }
    return {};
}

/// How a group moved from one frame to another; empty where too few of it are there in both.
std::optional<Transform> motion(const MarkerSequence& sequence, const std::vector<std::size_t>& group, std::size_t from,
                                std::size_t to) {
    std::vector<Point> source, target;
    for (const auto marker : group) {
        if (!sequence.valid(from, marker) || !sequence.valid(to, marker)) continue;
        source.push_back(sequence.at_mm(from, marker));
        target.push_back(sequence.at_mm(to, marker));
    }
    return geometry::rigid_fit(source, target);
}

/// Where its group carries a marker that is missing in `frame`.
std::optional<Point> carried(const MarkerSequence& sequence, const std::vector<std::size_t>& group,
                             const MarkerGap& gap, std::size_t frame) {
    std::optional<Point> by_earlier, by_later;
    const auto from = [&](std::size_t seen) -> std::optional<Point> {
        const auto to_frame = motion(sequence, group, seen, frame);
        return to_frame ? std::optional<Point>(*to_frame * sequence.at_mm(seen, gap.marker)) : std::nullopt;
    };
    if (gap.first > 0) by_earlier = from(gap.first - 1);
    if (gap.last + 1 < sequence.frames()) by_later = from(gap.last + 1);
    if (!by_earlier) return by_later;
    if (!by_later) return by_earlier;
    const double share = static_cast<double>(frame - gap.first + 1) / static_cast<double>(gap.last - gap.first + 2);
    return (1 - share) * *by_earlier + share * *by_later;
}

}  // namespace

Filled fill_gaps(const MarkerSequence& sequence, const MarkerSet& set, const FillOptions& options) {
    options.check();
    Filled result{
        sequence, std::vector<std::size_t>(sequence.markers()), std::vector<std::size_t>(sequence.markers()), {}};
    std::vector<std::vector<std::size_t>> groups(sequence.markers());
    std::vector<std::string> unknown;
    std::size_t too_long = 0;
    for (const auto& gap : gaps(sequence)) {
        const auto& name = sequence.names()[gap.marker];
        auto& group = groups[gap.marker];
        if (group.empty()) {
            if (const auto* known = set.find(name))
                for (const auto& other : known->group)
                    if (const auto index = sequence.find(other)) group.push_back(*index);
            if (group.size() < 3) {  // the set does not know it, or the recording has too few of what surrounds it
                group = nearest_markers(sequence, gap.marker, options.nearest);
                unknown.push_back(name);
            }
        }
        const auto frames = gap.last - gap.first + 1;
        const bool skipped =
            options.longest_gap_s > 0 && static_cast<double>(frames) > options.longest_gap_s * sequence.rate_hz();
        too_long += skipped ? 1 : 0;
        for (std::size_t frame = gap.first; frame <= gap.last; ++frame) {
            const auto position = skipped ? std::nullopt : carried(sequence, group, gap, frame);
            if (position) result.markers.set(frame, gap.marker, *position);
            ++(position ? result.filled : result.left)[gap.marker];
        }
    }
    std::sort(unknown.begin(), unknown.end());
    unknown.erase(std::unique(unknown.begin(), unknown.end()), unknown.end());
    if (!unknown.empty())
        result.remarks.push_back(fmt::format("{} no group of the {} in the recording; carried by the {} nearest: {}",
                                             base::counted(unknown.size(), "marker has", "markers have"), set.name,
                                             options.nearest, fmt::join(unknown, ", ")));
    if (too_long > 0)
        result.remarks.push_back(fmt::format("{} longer than {} s; left", base::counted(too_long, "gap is", "gaps are"),
                                             options.longest_gap_s));
    return result;
}

namespace {

/// The frame that three points span: origin at the first, right-handed and orthonormal. Empty where they are on a line.
std::optional<Transform> frame_of(const Point& origin, const Point& along_from, const Point& along_to,
                                  const Point& towards) {
    const Vector along = along_to - along_from;
    const Vector normal = along.cross(towards - origin);
    if (!(normal.norm() > 1e-9 * along.squaredNorm()) || !(along.norm() > 0)) return std::nullopt;
    Transform parent_from_local = Transform::Identity();
    parent_from_local.linear().col(0) = along.normalized();
    parent_from_local.linear().col(2) = normal.normalized();
    parent_from_local.linear().col(1) = parent_from_local.linear().col(2).cross(parent_from_local.linear().col(0));
    parent_from_local.translation() = origin;
    return parent_from_local;
}

/// What one derived marker needs of the sequence: indices of markers and where all of it is at rest.
struct Hanging {
    std::vector<std::size_t> on;  ///< sibling, along, along, towards; or the group
    std::vector<Point> on_rest_mm;
    Point rest_mm = Point::Zero();
    bool framed = false;
    Transform rest_from_local = Transform::Identity();
};

std::optional<Hanging> hanging(const MarkerSequence& sequence, const geometry::Landmarks& rest,
                               const DerivedMarker& derived, std::vector<std::string>& remarks) {
    const auto* place = rest.find(derived.name);
    if (!place) return std::nullopt;
    Hanging one;
    one.rest_mm = place->position_mm;
    one.framed = derived.frame.has_value();
    const auto& frame = derived.frame;
    const auto names = frame
                           ? std::vector<std::string>{frame->sibling, frame->along[0], frame->along[1], frame->towards}
                           : derived.group;
    std::vector<std::string> lacking;
    for (const auto& name : names) {
        const auto index = sequence.find(name);
        const auto* mark = rest.find(name);
        if (!index || !mark) {
            lacking.push_back(name);
            continue;
        }
        one.on.push_back(*index);
        one.on_rest_mm.push_back(mark->position_mm);
    }
    if (one.framed ? !lacking.empty() : one.on.size() < 3) {
        remarks.push_back(fmt::format("{} is not made: it hangs on {}, and the recording or its rest lacks {}",
                                      derived.name, fmt::join(names, ", "), fmt::join(lacking, ", ")));
        return std::nullopt;
    }
    if (!one.framed) return one;
    const auto local = frame_of(one.on_rest_mm[0], one.on_rest_mm[1], one.on_rest_mm[2], one.on_rest_mm[3]);
    if (!local) {
        remarks.push_back(
            fmt::format("{} is not made: at rest its sibling and neighbours lie on one line", derived.name));
        return std::nullopt;
    }
    one.rest_from_local = *local;
    return one;
}

std::optional<Point> position(const MarkerSequence& sequence, const Hanging& one, std::size_t frame) {
    std::vector<Point> now, then;
    for (std::size_t k = 0; k < one.on.size(); ++k) {
        if (!sequence.valid(frame, one.on[k])) continue;
        now.push_back(sequence.at_mm(frame, one.on[k]));
        then.push_back(one.on_rest_mm[k]);
    }
    if (!one.framed) {
        const auto frame_from_rest = geometry::rigid_fit(then, now);
        return frame_from_rest ? std::optional<Point>(*frame_from_rest * one.rest_mm) : std::nullopt;
    }
    if (now.size() < 4) return std::nullopt;
    const auto local = frame_of(now[0], now[1], now[2], now[3]);
    if (!local) return std::nullopt;
    return *local * (one.rest_from_local.inverse(Eigen::Isometry) * one.rest_mm);
}

}  // namespace

Derived derive_markers(const MarkerSequence& sequence, const geometry::Landmarks& rest, const MarkerSet& set) {
    Derived result;
    std::vector<Hanging> all;
    std::vector<std::string> names(sequence.names().begin(), sequence.names().end());
    for (const auto& derived : set.derived) {
        if (sequence.find(derived.name)) {
            result.remarks.push_back(fmt::format("{} is in the recording already; kept", derived.name));
            continue;
        }
        if (auto one = hanging(sequence, rest, derived, result.remarks)) {
            all.push_back(std::move(*one));
            result.derived.push_back(derived.name);
            names.push_back(derived.name);
        }
    }
    result.markers = MarkerSequence(std::move(names), sequence.rate_hz(), sequence.frames(), sequence.first_frame());
    for (std::size_t frame = 0; frame < sequence.frames(); ++frame) {
        for (std::size_t marker = 0; marker < sequence.markers(); ++marker) {
            if (sequence.valid(frame, marker)) result.markers.set(frame, marker, sequence.at_mm(frame, marker));
            if (sequence.has_residuals())
                result.markers.set_residual_mm(frame, marker, sequence.residual_mm(frame, marker));
        }
        for (std::size_t k = 0; k < all.size(); ++k)
            if (const auto p = position(sequence, all[k], frame)) result.markers.set(frame, sequence.markers() + k, *p);
    }
    return result;
}

}  // namespace mimik::capture
