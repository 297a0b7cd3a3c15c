#include "animation/expression_mapping.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/quantile.h"
#include "base/text.h"

namespace mimik::animation {

using geometry::Point;
using geometry::Vector;

void ExpressionMappingOptions::check() const {
    parameters.check();
    basis.check();
    if (!(gain >= 0 && gain <= 10)) throw InputError(fmt::format("gain is {}; give 0 to 10", gain));
    if (!(hold_s >= 0 && hold_s <= 3600)) throw InputError(fmt::format("hold_s is {}; give 0 to 3600 s", hold_s));
    if (!(relax_s > 0 && relax_s <= 3600))
        throw InputError(fmt::format("relax_s is {}; give more than 0 and up to 3600 s", relax_s));
    if (!(least_features > 0 && least_features <= 1))
        throw InputError(fmt::format("least_features is {}; give more than 0 and up to 1", least_features));
}

namespace {

/// What is alike is said by name.
modeling::CardinalBasis basis_of(const modeling::SourceExamples& source, const modeling::ExampleParameters& parameters,
                                 const modeling::CardinalBasisOptions& options) {
    try {
        return modeling::CardinalBasis(parameters.examples, options);
    } catch (const InputError& e) {
        std::string list;
        for (std::size_t k = 0; k < source.examples.size(); ++k)
            list += fmt::format("{}{} {}", k == 0 ? "" : ", ", k, source.examples[k]);
        throw InputError(fmt::format("{} (examples: {})", e.what(), list));
    }
}

std::optional<std::size_t> place_in(const capture::FeatureMotion& motion, const PerformerRest& rest,
                                    const std::string& feature) {
    const auto k = motion.find(feature);
    return k && rest.known[*k] ? k : std::nullopt;
}

/// Depth never leaves rest: nobody measured it, as in tables of pixels and in motions of 'mimik capture'.
bool is_flat(const capture::FeatureMotion& motion, const PerformerRest& rest) {
    constexpr double rounding_mm = 2e-3;  // tables have few digits, and so has the median of them
    for (const auto& frame : motion.frames)
        for (std::size_t k = 0; k < frame.features.size(); ++k)
            if (rest.known[k] && frame.features[k].valid &&
                std::abs(frame.features[k].head_mm.z() - rest.position_mm[k].z()) > rounding_mm)
                return false;
    return true;
}

}  // namespace

ExpressionMapping::ExpressionMapping(modeling::SourceExamples source, const ExpressionMappingOptions& options)
    : options_((options.check(), options)),
      source_(std::move(source)),
      parameters_(modeling::example_parameters(source_, options.parameters)),
      basis_(basis_of(source_, parameters_, options.basis)) {}

MappedExpression ExpressionMapping::map(std::span<const Vector> displacement_mm,
                                        std::span<const std::uint8_t> valid) const {
    const auto count = source_.features.size();
    if (displacement_mm.size() != count || valid.size() != count)
        throw InputError(fmt::format("{} displacements for {} features", displacement_mm.size(), count));
    const auto& f = parameters_.feature_matrix;
    Eigen::VectorXd seen = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * count));
    Eigen::MatrixXd axes = f;
    std::size_t missing = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const auto at = static_cast<Eigen::Index>(3 * k);
        if (valid[k]) {
            seen.segment<3>(at) = displacement_mm[k];
        } else {
            axes.middleCols<3>(at).setZero();
            ++missing;
        }
    }
    Eigen::VectorXd p = axes * seen;
    if (missing > 0) {
        // F F^T is the identity where all are seen; the ridge keeps axes that nobody sees at rest.
        constexpr double ridge = 1e-3;
        Eigen::MatrixXd normal = axes * axes.transpose();
        normal.diagonal().array() += ridge;
        p = normal.ldlt().solve(p);
    }
    MappedExpression mapped;
    const auto coordinates = static_cast<double>(3 * (count - missing));
    mapped.unexplained_rms_mm =
        coordinates > 0 ? std::sqrt((seen - axes.transpose() * p).squaredNorm() / coordinates) : 0.0;
    mapped.weights = basis_.weights(p);
    return mapped;
}

PerformerRest performer_rest(const capture::FeatureMotion& motion, std::size_t first, std::size_t last) {
    if (first > last || last >= motion.frames.size())
        throw InputError(fmt::format("frames {} to {} are not all in a motion of {}; give frames from 0 to {}", first,
                                     last, base::counted(motion.frames.size(), "frame"),
                                     motion.frames.empty() ? 0 : motion.frames.size() - 1));
    PerformerRest rest;
    for (std::size_t k = first; k <= last; ++k)
        rest.frames += motion.frames[k].state == capture::TrackState::tracked ? 1 : 0;
    if (rest.frames == 0)
        throw InputError(
            fmt::format("the face is lost in all frames from {} to {}; name frames in which it is seen "
                        "and at rest",
                        first, last));
    for (std::size_t feature = 0; feature < motion.names.size(); ++feature) {
        std::array<std::vector<double>, 3> values;
        for (std::size_t k = first; k <= last; ++k) {
            const auto& sample = motion.frames[k].features[feature];
            if (!sample.valid) continue;
            for (std::size_t axis = 0; axis < 3; ++axis)
                values[axis].push_back(sample.head_mm[static_cast<Eigen::Index>(axis)]);
        }
        const bool known = 2 * values[0].size() >= rest.frames && !values[0].empty();
        Point middle = Point::Zero();
        if (known)
            for (std::size_t axis = 0; axis < 3; ++axis)
                middle[static_cast<Eigen::Index>(axis)] = base::median(std::move(values[axis]));
        rest.position_mm.push_back(middle);
        rest.known.push_back(known ? 1 : 0);
    }
    return rest;
}

modeling::SourceExamples performer_examples(const capture::FeatureMotion& motion, const PerformerRest& rest,
                                            std::span<const KeyFrame> keys) {
    for (const auto& key : keys) {
        if (key.frame >= motion.frames.size())
            throw InputError(fmt::format("{}={}: the motion has {}; give frames from 0 on", key.example, key.frame,
                                         base::counted(motion.frames.size(), "frame")));
        if (motion.frames[key.frame].state == capture::TrackState::lost)
            throw InputError(
                fmt::format("{}={}: the face is lost there; name a frame in which it is seen", key.example, key.frame));
    }
    modeling::SourceExamples source;
    for (const auto& key : keys) source.examples.push_back(key.example);
    source.displacement_mm.resize(keys.size());
    for (std::size_t k = 0; k < motion.names.size(); ++k) {
        const bool seen = rest.known[k] && std::all_of(keys.begin(), keys.end(), [&](const KeyFrame& key) {
                              return motion.frames[key.frame].features[k].valid;
                          });
        if (!seen) continue;
        source.features.push_back(motion.names[k]);
        source.neutral_mm.push_back(rest.position_mm[k]);
        for (std::size_t i = 0; i < keys.size(); ++i)
            source.displacement_mm[i].emplace_back(motion.frames[keys[i].frame].features[k].head_mm -
                                                   rest.position_mm[k]);
    }
    source.check();
    return source;
}

modeling::SourceExamples fitted_examples(const modeling::SourceExamples& table, const capture::FeatureMotion& motion,
                                         const PerformerRest& rest, double* factor) {
    std::vector<std::string> shared;
    for (const auto& feature : table.features)
        if (place_in(motion, rest, feature)) shared.push_back(feature);
    constexpr std::size_t least = 4;
    if (shared.size() < least)
        throw InputError(
            fmt::format("the motion and the table of examples share {}, and {} are needed; follow more "
                        "features, or give key frames",
                        base::counted(shared.size(), "feature"), least));
    double scale = 1;
    const auto left = place_in(motion, rest, "eye_outer_left"), right = place_in(motion, rest, "eye_outer_right");
    if (const auto of_table = modeling::outer_eye_distance_mm(table); of_table && left && right && *of_table > 0)
        scale = (rest.position_mm[*left] - rest.position_mm[*right]).norm() / *of_table;
    if (factor) *factor = scale;
    auto fitted = modeling::scaled(modeling::with_features(table, shared), scale);
    // Depth that was not measured is no measured 0: examples are told apart by what is seen of them.
    if (is_flat(motion, rest))
        for (auto& example : fitted.displacement_mm)
            for (auto& d : example) d.z() = 0;
    return fitted;
}

PerformanceMapper::PerformanceMapper(const capture::FeatureMotion& motion, PerformerRest rest,
                                     const ExpressionMapping& mapping)
    : mapping_(mapping),
      rest_(std::move(rest)),
      last_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mapping.source().examples.size()))) {
    for (const auto& feature : mapping_.source().features) {
        const auto k = place_in(motion, rest_, feature);
        if (!k) throw InputError(fmt::format("the motion has no {} at rest; leave it out of the examples", feature));
        place_.push_back(*k);
    }
    displacement_mm_.resize(place_.size());
    valid_.resize(place_.size());
}

PerformanceMapper::Frame PerformanceMapper::next(const capture::FeatureFrame& seen) {
    const auto& options = mapping_.options();
    std::size_t seen_features = 0;
    for (std::size_t k = 0; k < place_.size(); ++k) {
        const auto& sample = seen.features[place_[k]];
        valid_[k] = sample.valid ? 1 : 0;
        seen_features += valid_[k];
        displacement_mm_[k] = sample.valid ? Vector(sample.head_mm - rest_.position_mm[place_[k]]) : Vector::Zero();
    }
    Frame frame;
    frame.tracked = seen.state == capture::TrackState::tracked &&
                    static_cast<double>(seen_features) >= options.least_features * static_cast<double>(place_.size());
    if (!frame.tracked) {
        const double since_s = seen.time_s - last_time_s_ - options.hold_s;
        frame.weights = last_ * (since_s <= 0 ? 1.0 : std::exp(-since_s / options.relax_s));
        return frame;
    }
    const auto expression = mapping_.map(displacement_mm_, valid_);
    frame.unexplained_rms_mm = expression.unexplained_rms_mm;
    frame.least = expression.weights.minCoeff();
    frame.largest = expression.weights.maxCoeff();
    last_ = expression.weights;
    if (options.clamp) last_ = last_.cwiseMax(0.0).cwiseMin(1.0);
    last_ *= options.gain;
    last_time_s_ = seen.time_s;
    frame.weights = last_;
    return frame;
}

MappedPerformance map_performance(const capture::FeatureMotion& motion, const PerformerRest& rest,
                                  const ExpressionMapping& mapping) {
    PerformanceMapper mapper(motion, rest, mapping);
    MappedPerformance mapped;
    mapped.examples = mapping.source().examples;
    mapped.rate_hz = motion.rate_hz;
    mapped.weights = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(motion.frames.size()),
                                           static_cast<Eigen::Index>(mapped.examples.size()));
    std::vector<double> unexplained_mm;
    for (std::size_t k = 0; k < motion.frames.size(); ++k) {
        const auto frame = mapper.next(motion.frames[k]);
        mapped.times_s.push_back(motion.frames[k].time_s);
        mapped.tracked.push_back(frame.tracked ? 1 : 0);
        mapped.weights.row(static_cast<Eigen::Index>(k)) = frame.weights.transpose();
        if (!frame.tracked) {
            ++mapped.lost;
            continue;
        }
        unexplained_mm.push_back(frame.unexplained_rms_mm);
        mapped.least_weight = std::min(mapped.least_weight, frame.least);
        mapped.largest_weight = std::max(mapped.largest_weight, frame.largest);
        constexpr double much = 0.05;  // what nobody sees is not counted
        mapped.negatives += frame.least < -much ? 1 : 0;
        mapped.overshoots += frame.largest > 1 + much ? 1 : 0;
    }
    if (!unexplained_mm.empty()) mapped.median_unexplained_mm = base::median(std::move(unexplained_mm));
    return mapped;
}

std::string weights_header(std::span<const std::string> examples) {
    std::string text = "frame,time,state";
    for (const auto& name : examples) text += ',' + base::csv_field(name);
    return text + '\n';
}

std::string weights_row(std::size_t frame, double time_s, bool tracked, std::span<const double> weights) {
    auto text = fmt::format("{},{},{}", frame, time_s, tracked ? "tracked" : "lost");
    for (const double weight : weights)
        fmt::format_to(std::back_inserter(text), ",{:.6f}", std::abs(weight) < 5e-7 ? 0.0 : weight);  // no -0
    return text + '\n';
}

std::string encode_weights(const MappedPerformance& performance) {
    auto text = weights_header(performance.examples);
    for (std::size_t frame = 0; frame < performance.times_s.size(); ++frame) {
        const Eigen::VectorXd row = performance.weights.row(static_cast<Eigen::Index>(frame));
        text += weights_row(frame, performance.times_s[frame], performance.tracked[frame] != 0,
                            {row.data(), static_cast<std::size_t>(row.size())});
    }
    return text;
}

}  // namespace mimik::animation
