#include "capture/stabilise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "base/text.h"
#include "geometry/rigid_fit.h"
#include "geometry/statistics.h"

namespace mimik::capture {

using geometry::Transform;

void StabiliseOptions::check() const {
    if (!std::isfinite(noise_mm) || noise_mm <= 0)
        throw InputError(fmt::format("noise_mm is {}; give more than 0", noise_mm));
    if (!jig.empty() && !by.empty())
        throw InputError("jig and by are both given; a jig alone says how the head moves, give one of them");
    const auto& names = jig.empty() ? by : jig;
    if (std::set<std::string>(names.begin(), names.end()).size() != names.size())
        throw InputError(fmt::format("{} names a marker twice; name each once", jig.empty() ? "by" : "jig"));
    if (!names.empty() && names.size() < 3)
        throw InputError(fmt::format("{} names {}; three are the least that say a rotation", jig.empty() ? "by" : "jig",
                                     base::counted(names.size(), "marker")));
}

namespace {

constexpr int most_iterations = 40;
constexpr double settled_mm = 1e-6, settled_rotation = 1e-9;

struct Pairs {
    std::vector<Point> frame_mm, rest_mm;
};

struct Pose {
    Transform rest_from_frame = Transform::Identity();
    double residual_mm = 0;
};

std::vector<double> residuals(const Pairs& pairs, const Transform& rest_from_frame) {
    std::vector<double> list;
    list.reserve(pairs.rest_mm.size());
    for (std::size_t i = 0; i < pairs.rest_mm.size(); ++i)
        list.push_back((rest_from_frame * pairs.frame_mm[i] - pairs.rest_mm[i]).norm());
    return list;
}

double weighted_rms(const std::vector<double>& residual, std::span<const double> weights) {
    double sum = 0, of = 0;
    for (std::size_t i = 0; i < residual.size(); ++i) {
        const double w = weights.empty() ? 1 : weights[i];
        sum += w * residual[i] * residual[i];
        of += w;
    }
    return std::sqrt(sum / of);
}

std::optional<Pose> plain_pose(const Pairs& pairs) {
    const auto fit = geometry::rigid_fit(pairs.frame_mm, pairs.rest_mm);
    if (!fit) return std::nullopt;
    return Pose{*fit, weighted_rms(residuals(pairs, *fit), {})};
}

/// First the least sum of distances, which half the markers cannot pull away; then Tukey's biweight from there.
std::optional<Pose> robust_pose(const Pairs& pairs, double noise_mm) {
    auto fit = geometry::rigid_fit(pairs.frame_mm, pairs.rest_mm);
    if (!fit) return std::nullopt;
    std::vector<double> weights(pairs.rest_mm.size(), 1.0);
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        const auto residual = residuals(pairs, *fit);
        const bool tukey = 2 * iteration >= most_iterations;
        // 1.4826: the median of a normal residual's size to its deviation; 4.685: 95 % efficient where all is normal.
        const double reach_mm = 4.685 * std::max(noise_mm, 1.4826 * geometry::median(residual));
        for (std::size_t i = 0; i < weights.size(); ++i) {
            const double share = residual[i] / reach_mm;
            weights[i] = !tukey      ? 1 / std::max(noise_mm, residual[i])
                         : share < 1 ? (1 - share * share) * (1 - share * share)
                                     : 0;
        }
        const auto next = geometry::rigid_fit(pairs.frame_mm, pairs.rest_mm, weights);
        if (!next) break;  // too few are left: the last one stands
        const bool settled = (next->linear() - fit->linear()).norm() < settled_rotation &&
                             (next->translation() - fit->translation()).norm() < settled_mm;
        fit = next;
        if (settled && tukey) break;
    }
    return Pose{*fit, weighted_rms(residuals(pairs, *fit), weights)};
}

class Stabiliser {
public:
    Stabiliser(const MarkerSequence& sequence, const StabiliseOptions& options)
        : sequence_(sequence), options_(options) {
        const auto& names = options.jig.empty() ? options.by : options.jig;
        for (const auto& name : names) used_.push_back(sequence.index(name));
        if (names.empty()) {
            used_.resize(sequence.markers());
            std::iota(used_.begin(), used_.end(), std::size_t{0});
        }
        if (sequence.frames() == 0) throw InputError("the recording has no frame; there is nothing to stabilise");
        rest_frame_ = find_rest();
        for (const auto marker : used_)
            reference_.push_back(sequence.valid(rest_frame_, marker)
                                     ? std::optional(sequence.at_mm(rest_frame_, marker))
                                     : std::nullopt);
        if (!options.jig.empty()) average_reference();
    }

    [[nodiscard]] std::size_t rest_frame() const { return rest_frame_; }
    [[nodiscard]] std::size_t used_at_rest() const { return seen(rest_frame_); }
    [[nodiscard]] std::size_t used() const { return used_.size(); }

    [[nodiscard]] std::optional<Pose> pose(std::size_t frame) const {
        const auto both = pairs(frame);
        return options_.jig.empty() ? robust_pose(both, options_.noise_mm) : plain_pose(both);
    }

private:
    [[nodiscard]] std::size_t seen(std::size_t frame) const {
        return static_cast<std::size_t>(std::count_if(
            used_.begin(), used_.end(), [&](std::size_t marker) { return sequence_.valid(frame, marker); }));
    }
    /// The first frame with the most of the markers; without a gap the first of all.
    [[nodiscard]] std::size_t find_rest() const {
        std::size_t best = 0, most = 0;
        for (std::size_t frame = 0; frame < sequence_.frames() && most < used_.size(); ++frame)
            if (const auto count = seen(frame); count > most) {
                best = frame;
                most = count;
            }
        return best;
    }
    [[nodiscard]] Pairs pairs(std::size_t frame) const {
        Pairs both;
        for (std::size_t k = 0; k < used_.size(); ++k) {
            if (!sequence_.valid(frame, used_[k]) || !reference_[k]) continue;
            both.frame_mm.push_back(sequence_.at_mm(frame, used_[k]));
            both.rest_mm.push_back(*reference_[k]);
        }
        return both;
    }
    /// A jig is one rigid body, so the median of a marker's places over all frames is nearer to its shape than its
    /// place in one frame, whose noise every pose would bear; and one bent frame does not move it. It stands where the
    /// jig is at rest.
    void average_reference() {
        std::vector<std::array<std::vector<double>, 3>> seen_at(used_.size());
        for (std::size_t frame = 0; frame < sequence_.frames(); ++frame) {
            const auto fit = plain_pose(pairs(frame));
            if (!fit) continue;
            for (std::size_t k = 0; k < used_.size(); ++k) {
                if (!sequence_.valid(frame, used_[k])) continue;
                const Point at = fit->rest_from_frame * sequence_.at_mm(frame, used_[k]);
                for (std::size_t axis = 0; axis < 3; ++axis)
                    seen_at[k][axis].push_back(at[static_cast<Eigen::Index>(axis)]);
            }
        }
        std::vector<std::optional<Point>> shape(used_.size());
        Pairs at_rest;
        for (std::size_t k = 0; k < used_.size(); ++k) {
            auto& [x, y, z] = seen_at[k];
            if (x.empty()) continue;
            shape[k] =
                Point(geometry::median(std::move(x)), geometry::median(std::move(y)), geometry::median(std::move(z)));
            if (!reference_[k]) continue;
            at_rest.frame_mm.push_back(*shape[k]);
            at_rest.rest_mm.push_back(*reference_[k]);
        }
        const auto rest_from_shape = plain_pose(at_rest);
        if (!rest_from_shape) return;
        for (std::size_t k = 0; k < used_.size(); ++k)
            if (shape[k]) reference_[k] = rest_from_shape->rest_from_frame * *shape[k];
    }

    const MarkerSequence& sequence_;
    const StabiliseOptions& options_;
    std::vector<std::size_t> used_;
    std::size_t rest_frame_ = 0;
    std::vector<std::optional<Point>> reference_;  ///< of every marker used; none: it is never seen with the others
};

}  // namespace

Stabilised stabilise(const MarkerSequence& sequence, const StabiliseOptions& options) {
    options.check();
    const Stabiliser stabiliser(sequence, options);
    Stabilised result{sequence, stabiliser.rest_frame(), {}, {}, {}};
    if (!stabiliser.pose(stabiliser.rest_frame()))
        throw NumericalError(fmt::format("{}: in no frame are three of its markers there and off one line; name others",
                                         options.jig.empty() ? "the robust fit" : "the jig"));
    if (stabiliser.used_at_rest() < stabiliser.used())
        result.remarks.push_back(fmt::format(
            "in no frame are all {} there; frame {} with {} is the rest",
            base::counted(stabiliser.used(), "marker of the fit", "markers of the fit"),
            sequence.first_frame() + static_cast<std::int64_t>(stabiliser.rest_frame()), stabiliser.used_at_rest()));
    result.rest_from_frame.assign(sequence.frames(), Transform::Identity());
    result.residual_mm.resize(sequence.frames());
    base::parallel_for(sequence.frames(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t frame = begin; frame < end; ++frame) {
            const auto pose = stabiliser.pose(frame);
            if (pose) {
                result.rest_from_frame[frame] = pose->rest_from_frame;
                result.residual_mm[frame] = pose->residual_mm;
            }
            for (std::size_t marker = 0; marker < sequence.markers(); ++marker) {
                if (!pose)
                    result.markers.set_missing(frame, marker);
                else if (sequence.valid(frame, marker))
                    result.markers.set(frame, marker, pose->rest_from_frame * sequence.at_mm(frame, marker));
            }
        }
    });
    const auto lost = std::count(result.residual_mm.begin(), result.residual_mm.end(), std::nullopt);
    if (lost > 0)
        result.remarks.push_back(
            fmt::format("{} no pose, since too few markers of the fit are there; their samples are "
                        "missing",
                        base::counted(static_cast<std::uint64_t>(lost), "frame has", "frames have")));
    return result;
}

}  // namespace mimik::capture
