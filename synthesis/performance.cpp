#include "synthesis/performance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "base/random_stream.h"
#include "capture/stick_markers.h"
#include "geometry/face_axes.h"

namespace mimik::synthesis {

using geometry::Point;
using geometry::Vector;

void PerformanceOptions::check() const {
    const auto within = [](const char* name, double value, double least, double most) {
        if (!(value >= least && value <= most))
            throw InputError(fmt::format("{} is {}; give {} to {}", name, value, least, most));
    };
    within("rate_hz", rate_hz, 1, 1000);
    within("seconds_a_unit", seconds_a_unit, 0.01, 60);
    within("seconds", seconds, 0.1, 600);
    within("noise_mm", noise_mm, 0, 10);
    within("drop_outs_a_minute", drop_outs_a_minute, 0, 600);
    within("longest_drop_out_s", longest_drop_out_s, 0, 10);
    within("head_turn_deg", head_turn_deg, 0, 60);
    within("head_shift_mm", head_shift_mm, 0, 1000);
}

namespace {

constexpr double pi = std::numbers::pi;

/// Everybody at full strength, without what makes people and performances differ.
VarianceOptions exact_people(double spread) {
    VarianceOptions options;
    options.identity = spread;
    options.amplitude_person = options.amplitude_performance = options.shape = 0;
    options.asymmetry_person = options.asymmetry_performance = 0;
    options.co_activation = options.co_activation_spread = 0;
    options.size_coupling = 0;
    options.field_magnitude = options.field_direction_deg = 0;
    options.micro_expression = 0;
    return options;
}

geometry::Landmarks landmarks_of(const FaceModel& model, const std::vector<Point>& vertices_mm) {
    std::vector<geometry::Landmark> marks;
    for (const auto& [name, vertex] : model.landmark_vertices()) marks.push_back({name, vertices_mm[vertex], {}});
    return geometry::Landmarks(std::move(marks));
}

double bell(double t) { return t <= 0 || t >= 1 ? 0 : 0.5 * (1 - std::cos(2 * pi * t)); }

/// One AU as a train of pulses: how often, how long, how strong.
struct Pulses {
    int unit;
    double every_s, length_s, least, most;
};
constexpr std::array<Pulses, 10> spoken = {{{26, 0.25, 0.25, 0.2, 1.0},
                                            {25, 0.31, 0.30, 0.2, 0.9},
                                            {18, 1.10, 0.45, 0.3, 0.9},
                                            {20, 1.45, 0.50, 0.2, 0.7},
                                            {24, 0.95, 0.25, 0.2, 0.7},
                                            {16, 0.80, 0.35, 0.2, 0.7},
                                            {1, 2.60, 1.50, 0.3, 0.9},
                                            {2, 2.60, 1.50, 0.2, 0.8},
                                            {12, 3.30, 2.00, 0.3, 0.9},
                                            {43, 2.10, 0.30, 1.0, 1.0}}};

geometry::Transform head_pose(double time_s, const PerformanceOptions& options) {
    base::RandomStream chance(options.seed, "performance/head");
    std::array<double, 6> value{};
    for (auto& one : value) {  // two slow waves each; zero at the start
        const double a = 0.15 + 0.25 * chance.uniform(), b = 0.35 + 0.4 * chance.uniform();
        one = 0.65 * std::sin(2 * pi * a * time_s) + 0.35 * std::sin(2 * pi * b * time_s);
    }
    const double turn = options.head_turn_deg * pi / 180;
    geometry::Transform pose = geometry::Transform::Identity();
    pose.linear() =
        (Eigen::AngleAxisd(value[0] * turn, Vector::UnitX()) * Eigen::AngleAxisd(value[1] * turn, Vector::UnitY()) *
         Eigen::AngleAxisd(value[2] * turn, Vector::UnitZ()))
            .toRotationMatrix();
    pose.translation() = options.head_shift_mm * Vector(value[3], value[4], value[5]);
    return pose;
}

}  // namespace

std::vector<PosedExpression> units_that_show(const FaceModel& model) {
    std::vector<PosedExpression> units;
    for (const int number : {1, 2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 16, 17, 18, 20, 22, 23, 24, 25, 26, 27, 28, 34, 43}) {
        auto unit = make_expression(std::to_string(number));
        if (missing_shapes(unit, model).empty()) units.push_back(std::move(unit));
    }
    return units;
}

Score ramped_score(std::vector<PosedExpression> units, const PerformanceOptions& options) {
    options.check();
    Score score{std::move(units), options.rate_hz, {}};
    const auto frames = static_cast<std::size_t>(std::max(2.0, std::round(options.seconds_a_unit * options.rate_hz)));
    for (std::size_t u = 0; u < score.units.size(); ++u)
        for (std::size_t f = 0; f < frames; ++f) {
            std::vector<double> now(score.units.size(), 0.0);
            const double t = static_cast<double>(f) / static_cast<double>(frames);
            now[u] = t < 0.5 ? 2 * t : 2 - 2 * t;
            score.strength.push_back(std::move(now));
        }
    return score;
}

Score spoken_score(std::vector<PosedExpression> units, const PerformanceOptions& options) {
    options.check();
    constexpr double rest_s = 0.25;
    Score score{std::move(units), options.rate_hz, {}};
    const auto frames = static_cast<std::size_t>(std::round(options.seconds * options.rate_hz));
    score.strength.assign(std::max<std::size_t>(frames, 1), std::vector<double>(score.units.size(), 0.0));
    for (std::size_t u = 0; u < score.units.size(); ++u)
        for (const auto& pulses : spoken) {
            if (score.units[u].action_units.count(pulses.unit) == 0) continue;
            base::RandomStream chance(options.seed, fmt::format("performance/AU{}", pulses.unit));
            for (double start = rest_s + 0.2 * chance.uniform(); start < options.seconds;
                 start += pulses.every_s * (0.7 + 0.6 * chance.uniform())) {
                const double strength = pulses.least + (pulses.most - pulses.least) * chance.uniform();
                for (std::size_t f = 0; f < score.frames(); ++f) {
                    const double time = static_cast<double>(f) / options.rate_hz;
                    auto& now = score.strength[f][u];
                    now = std::min(1.0, std::max(now, strength * bell((time - start) / pulses.length_s)));
                }
            }
        }
    return score;
}

Performer::Performer(const FaceModel& model, const std::string& name, std::uint64_t seed, double spread,
                     const capture::MarkerSet& set)
    : model_(&model),
      subject_(draw_subject(model, name, seed, exact_people(spread))),
      landmarks_(landmarks_of(model, subject_.resting_mm)),
      skin_(subject_.resting_mm, geometry::triangulate(model.faces())) {
    auto stuck = capture::stick_markers(set, landmarks_, skin_);
    for (auto& marker : stuck.names) (set.find(marker) ? names_ : derived_).push_back(std::move(marker));
    bound_ = std::move(stuck.places);
    const double unit = geometry::outer_eye_distance_mm(landmarks_);
    const Point above = 0.5 * (landmarks_.position_mm("brow_inner_left") + landmarks_.position_mm("brow_inner_right"));
    constexpr std::array<std::array<double, 3>, 7> places_of_jig = {{{0, 0.9, -0.1},
                                                                     {0.5, 0.85, -0.3},
                                                                     {-0.5, 0.85, -0.3},
                                                                     {0.95, 0.5, -0.8},
                                                                     {-0.95, 0.5, -0.8},
                                                                     {0.3, 1.15, -0.4},
                                                                     {-0.35, 1.2, -0.6}}};
    for (std::size_t k = 0; k < places_of_jig.size(); ++k)
        jig_.emplace_back(fmt::format("jig_{}", k + 1),
                          above + unit * Vector(places_of_jig[k][0], places_of_jig[k][1], places_of_jig[k][2]));
}

geometry::Landmarks Performer::labels() const {
    std::vector<geometry::Landmark> list;
    for (std::size_t k = 0; k < names_.size(); ++k) list.push_back({names_[k], bound_[k].position_mm, ""});
    for (std::size_t k = 0; k < derived_.size(); ++k)
        list.push_back({derived_[k], bound_[names_.size() + k].position_mm, ""});
    return geometry::Landmarks(std::move(list));
}

std::vector<std::string> Performer::marker_names() const {
    auto all = names_;
    for (const auto& one : jig_) all.push_back(one.first);
    return all;
}

std::vector<Vector> Performer::motion_mm(std::span<const PosedExpression> units,
                                         std::span<const double> strengths) const {
    std::map<std::string, double> weights;
    Contact contact;
    constexpr double shut = 0.9;  // as synthesis::perform
    bool moves = false;
    for (std::size_t u = 0; u < units.size(); ++u) {
        if (strengths[u] == 0) continue;
        moves = true;
        for (const auto& part : units[u].main_shapes) {
            weights[part.shape] += strengths[u] * part.weight;
            contact.left_eye_closed |= part.shape == "eyeBlink_L" && strengths[u] * part.weight >= shut;
            contact.right_eye_closed |= part.shape == "eyeBlink_R" && strengths[u] * part.weight >= shut;
        }
    }
    std::vector<Vector> motion(subject_.resting_mm.size(), Vector::Zero());
    if (!moves) return motion;
    for (const auto& [shape, weight] : weights) {
        const auto it = std::lower_bound(subject_.shapes.begin(), subject_.shapes.end(), shape);
        if (it == subject_.shapes.end() || *it != shape) continue;  // a model may lack it
        const auto& field = subject_.shape_displacements_mm[static_cast<std::size_t>(it - subject_.shapes.begin())];
        for (std::size_t v = 0; v < motion.size(); ++v) motion[v] += weight * field[v];
    }
    model_->settle(subject_.resting_mm, contact, motion);
    return motion;
}

std::vector<Point> Performer::markers_mm(std::span<const Vector> motion_mm) const {
    std::vector<Point> all;
    for (std::size_t k = 0; k < names_.size(); ++k) {
        Point at = bound_[k].position_mm;
        const auto& corners = skin_.triangles()[bound_[k].triangle];
        for (std::size_t c = 0; c < 3; ++c)
            at += bound_[k].barycentric[static_cast<Eigen::Index>(c)] * motion_mm[corners[c]];
        all.push_back(at);
    }
    for (const auto& one : jig_) all.push_back(one.second);
    return all;
}

capture::MarkerSequence exact_recording(const Performer& performer, const Score& score) {
    capture::MarkerSequence take(performer.marker_names(), score.rate_hz, score.frames());
    std::vector<std::vector<Point>> frames(score.frames());
    base::parallel_for_each(score.frames(), [&](std::size_t f) {
        frames[f] = performer.markers_mm(performer.motion_mm(score.units, score.strength[f]));
    });
    for (std::size_t f = 0; f < frames.size(); ++f)
        for (std::size_t k = 0; k < frames[f].size(); ++k) take.set(f, k, frames[f][k]);
    return take;
}

capture::MarkerSequence laboratory_recording(const Performer& performer, const Score& score,
                                             const PerformanceOptions& options) {
    options.check();
    auto take = exact_recording(performer, score);
    const auto face_markers = take.markers() - performer.jig().size();
    base::RandomStream noise(options.seed, "performance/noise");
    for (std::size_t f = 0; f < take.frames(); ++f) {
        const auto pose = head_pose(static_cast<double>(f) / score.rate_hz, options);
        for (std::size_t k = 0; k < take.markers(); ++k) {
            Point at = pose * take.at_mm(f, k);
            for (Eigen::Index c = 0; c < 3; ++c) at[c] += options.noise_mm * noise.normal();
            take.set(f, k, at);
        }
    }
    base::RandomStream lost(options.seed, "performance/drop-outs");
    const double a_frame = options.drop_outs_a_minute / 60 / score.rate_hz;
    // The first tenth of a second is whole: a rest frame is to be found.
    const auto begin = static_cast<std::size_t>(std::ceil(0.1 * score.rate_hz));
    for (std::size_t k = 0; k < face_markers; ++k)
        for (std::size_t f = begin; f < take.frames(); ++f) {
            if (lost.uniform() >= a_frame) continue;
            const auto length =
                static_cast<std::size_t>(std::ceil(lost.uniform() * options.longest_drop_out_s * score.rate_hz));
            for (const auto end = std::min(take.frames(), f + length); f < end; ++f) take.set_missing(f, k);
        }
    return take;
}

}  // namespace mimik::synthesis
