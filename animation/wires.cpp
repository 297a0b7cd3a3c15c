#include "animation/wires.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/parallel.h"

namespace mimik::animation {

using geometry::Point;
using geometry::Vector;

void WireOptions::check() const {
    if (!(least_radius_mm > 0 && largest_radius_mm >= least_radius_mm && largest_radius_mm <= 1000))
        throw InputError(
            fmt::format("least_radius_mm and largest_radius_mm are {} and {}; give 0 < least <= largest "
                        "<= 1000",
                        least_radius_mm, largest_radius_mm));
    if (radii < 1 || radii > 100) throw InputError(fmt::format("radii is {}; give 1 to 100", radii));
    if (!(scale_range >= 0 && scale_range < 1))
        throw InputError(fmt::format("scale_range is {}; give 0 to below 1", scale_range));
    if (sweeps < 1 || sweeps > 100) throw InputError(fmt::format("sweeps is {}; give 1 to 100", sweeps));
    if (samples < 1) throw InputError(fmt::format("samples is {}; give 1 or more", samples));
}

WireCurve::WireCurve(std::span<const Point> points_mm) {
    constexpr std::size_t pieces = 6;  // per span; the sagitta of a lip's span is then below 0.05 mm
    const auto count = points_mm.size();
    for (std::size_t k = 0; k + 1 < count; ++k) {
        const Point &b = points_mm[k], &c = points_mm[k + 1];
        const Point a = k > 0 ? points_mm[k - 1] : Point(2 * b - c);
        const Point d = k + 2 < count ? points_mm[k + 2] : Point(2 * c - b);
        for (std::size_t piece = 0; piece < pieces; ++piece) {
            const double t = static_cast<double>(piece) / pieces;
            chain_mm_.emplace_back(0.5 * (2 * b + t * (c - a) + t * t * (2 * a - 5 * b + 4 * c - d) +
                                          t * t * t * (3 * b - a - 3 * c + d)));
        }
    }
    if (count > 0) chain_mm_.push_back(points_mm.back());
}

WireCurve::Foot WireCurve::nearest(const Point& position_mm) const {
    Foot best{0, 0, std::numeric_limits<double>::infinity()};
    if (chain_mm_.size() == 1) best.distance_mm = (position_mm - chain_mm_[0]).norm();
    for (std::size_t k = 0; k + 1 < chain_mm_.size(); ++k) {
        const Vector along = chain_mm_[k + 1] - chain_mm_[k];
        const double squared = along.squaredNorm();
        const double share = squared > 0 ? std::clamp(along.dot(position_mm - chain_mm_[k]) / squared, 0.0, 1.0) : 0.0;
        const double distance = (position_mm - chain_mm_[k] - share * along).norm();
        if (distance < best.distance_mm) best = {k, share, distance};
    }
    return best;
}

Point WireCurve::at(const Foot& foot) const {
    if (chain_mm_.size() == 1) return chain_mm_[0];
    return chain_mm_[foot.piece] + foot.share * (chain_mm_[foot.piece + 1] - chain_mm_[foot.piece]);
}

Vector WireCurve::tangent(const Foot& foot) const {
    if (chain_mm_.size() == 1) return Vector::Zero();
    const Vector along = chain_mm_[foot.piece + 1] - chain_mm_[foot.piece];
    const double length = along.norm();
    return length > 0 ? Vector(along / length) : Vector::Zero();
}

double wire_falloff(double x) {
    if (x >= 1) return 0;
    const double inner = 1 - x * x;
    return inner * inner;
}

Vector wire_displacement(const Point& position_mm, const WireCurve& reference, const WireCurve& wire,
                         const WireCurve::Foot& foot, double scale, double falloff) {
    const Point on_reference = reference.at(foot);
    Vector arm = (1 + (scale - 1) * falloff) * (position_mm - on_reference);
    const Vector from = reference.tangent(foot), to = wire.tangent(foot);
    const Vector axis = from.cross(to);
    const double sine = axis.norm();
    if (sine > 1e-12) arm = Eigen::AngleAxisd(falloff * std::atan2(sine, from.dot(to)), axis / sine) * arm;
    return on_reference + arm + falloff * (wire.at(foot) - on_reference) - position_mm;
}

namespace {

/// A wire that says itself where f is 1 has all of its own points.
double share_of(double falloff) { return falloff / (1 - falloff + 1e-6); }

/// The feature lines, by names of features; `opposite` lies with it at rest and parts from it.
struct Line {
    const char* name;
    std::vector<const char*> features;
    const char* opposite = "";
};

const std::vector<Line>& lines() {
    static const std::vector<Line> all = {
        {"brow_right",
         {"brow_outer_right", "brow_outer_middle_right", "brow_middle_right", "brow_inner_middle_right",
          "brow_inner_right"}},
        {"brow_left",
         {"brow_inner_left", "brow_inner_middle_left", "brow_middle_left", "brow_outer_middle_left",
          "brow_outer_left"}},
        {"nose", {"nose_wing_right", "nostril_right", "nose_base", "nostril_left", "nose_wing_left"}},
        {"upper_lid_right",
         {"eye_outer_right", "lid_upper_outer_right", "lid_upper_inner_right", "eye_inner_right"},
         "lower_lid_right"},
        {"lower_lid_right",
         {"eye_outer_right", "lid_lower_outer_right", "lid_lower_inner_right", "eye_inner_right"},
         "upper_lid_right"},
        {"upper_lid_left",
         {"eye_inner_left", "lid_upper_inner_left", "lid_upper_outer_left", "eye_outer_left"},
         "lower_lid_left"},
        {"lower_lid_left",
         {"eye_inner_left", "lid_lower_inner_left", "lid_lower_outer_left", "eye_outer_left"},
         "upper_lid_left"},
        {"upper_lip_outer",
         {"mouth_corner_right", "upper_lip_outer_side_right", "upper_lip_outer_peak_right", "upper_lip_outer",
          "upper_lip_outer_peak_left", "upper_lip_outer_side_left", "mouth_corner_left"},
         "lower_lip_inner"},
        {"lower_lip_outer",
         {"mouth_corner_right", "lower_lip_outer_side_right", "lower_lip_outer_peak_right", "lower_lip_outer",
          "lower_lip_outer_peak_left", "lower_lip_outer_side_left", "mouth_corner_left"},
         "upper_lip_inner"},
        {"upper_lip_inner",
         {"mouth_corner_right", "upper_lip_inner_right", "upper_lip_inner", "upper_lip_inner_left",
          "mouth_corner_left"},
         "lower_lip_inner"},
        {"lower_lip_inner",
         {"mouth_corner_right", "lower_lip_inner_right", "lower_lip_inner", "lower_lip_inner_left",
          "mouth_corner_left"},
         "upper_lip_inner"},
        {"chin", {"chin"}},
    };
    return all;
}

std::vector<Point> positions(std::span<const Point> neutral_mm, std::span<const std::uint32_t> vertices) {
    std::vector<Point> points;
    for (const auto v : vertices) points.push_back(neutral_mm[v]);
    return points;
}

WireCurve moved_curve(std::span<const Point> neutral_mm, const Wire& wire, std::size_t example) {
    auto points = positions(neutral_mm, wire.vertices);
    for (std::size_t k = 0; k < points.size(); ++k) points[k] += wire.displacement_mm[example][k];
    return WireCurve(points);
}

/// The wires of a face that has the features of a line, at least half of them; vertices that come twice count once.
std::vector<Wire> laid_wires(const FacialExamples& examples) {
    std::vector<Wire> wires;
    for (const auto& line : lines()) {
        Wire wire{line.name, {}, 20.0, std::vector<double>(examples.examples.size(), 1.0), {}};
        std::size_t found = 0;
        for (const auto* name : line.features)
            for (const auto& [feature, vertex] : examples.feature_vertices)
                if (feature == name) {
                    ++found;
                    if (wire.vertices.empty() || wire.vertices.back() != vertex) wire.vertices.push_back(vertex);
                }
        if (2 * found < line.features.size() || wire.vertices.empty()) continue;
        for (const auto& example : examples.examples) {
            auto& row = wire.displacement_mm.emplace_back();
            for (const auto v : wire.vertices) row.push_back(example.displacement_mm[v]);
        }
        wires.push_back(std::move(wire));
    }
    if (wires.empty())
        throw InputError(
            "the examples do not say where the features lie, so no wire can be laid; make them by "
            "'mimik examples', or add a table [feature_vertices] to examples.toml");
    return wires;
}

/// Per wire, the vertices that move as the opposite wire does rather than as this.
std::vector<std::vector<std::uint8_t>> opposite_sides(const FacialExamples& examples, std::span<const Wire> wires) {
    const auto& neutral_mm = examples.neutral.vertices_mm;
    std::vector<WireCurve> references;
    for (const auto& wire : wires) references.emplace_back(positions(neutral_mm, wire.vertices));
    // Sum over the examples of how far a vertex's motion is from that of the wire at its foot.
    const auto unlike = [&](std::size_t wire, std::size_t v, std::span<const WireCurve> moved) {
        const auto foot = references[wire].nearest(neutral_mm[v]);
        double sum = 0;
        for (std::size_t i = 0; i < examples.examples.size(); ++i)
            sum += (examples.examples[i].displacement_mm[v] - (moved[i].at(foot) - references[wire].at(foot)))
                       .squaredNorm();
        return sum;
    };
    std::vector<std::vector<WireCurve>> moved(wires.size());
    for (std::size_t k = 0; k < wires.size(); ++k)
        for (std::size_t i = 0; i < examples.examples.size(); ++i)
            moved[k].push_back(moved_curve(neutral_mm, wires[k], i));
    std::vector<std::vector<std::uint8_t>> not_of(wires.size());
    for (std::size_t k = 0; k < wires.size(); ++k) {
        const auto line =
            std::find_if(lines().begin(), lines().end(), [&](const Line& l) { return wires[k].name == l.name; });
        const auto other = std::find_if(wires.begin(), wires.end(), [&](const Wire& w) {
            return line != lines().end() && w.name == line->opposite;
        });
        if (other == wires.end()) continue;
        const auto o = static_cast<std::size_t>(other - wires.begin());
        not_of[k].assign(neutral_mm.size(), 0);
        base::parallel_for(neutral_mm.size(), 512, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v)
                not_of[k][v] = unlike(o, v, moved[o]) < unlike(k, v, moved[k]) ? 1 : 0;
        });
    }
    return not_of;
}

/// Vertices that some example moves, about as many as asked for, evenly over their order.
std::vector<std::uint32_t> moving_samples(const FacialExamples& examples, std::size_t count) {
    std::vector<std::uint32_t> moving;
    for (std::uint32_t v = 0; v < examples.neutral.vertices_mm.size(); ++v)
        if (std::any_of(examples.examples.begin(), examples.examples.end(),
                        [&](const FacialExample& e) { return e.displacement_mm[v].squaredNorm() > 0.01; }))
            moving.push_back(v);
    if (moving.size() <= count) return moving;
    std::vector<std::uint32_t> some;
    for (std::size_t k = 0; k < count; ++k) some.push_back(moving[k * moving.size() / count]);
    return some;
}

/// Radii and scales by trying one wire at a time, what the others do kept.
class Fit {
public:
    Fit(const FacialExamples& examples, std::vector<Wire>& wires, const std::vector<std::vector<std::uint8_t>>& not_of,
        const WireOptions& options)
        : examples_(examples),
          wires_(wires),
          options_(options),
          samples_(moving_samples(examples, static_cast<std::size_t>(options.samples))) {
        const auto& neutral_mm = examples.neutral.vertices_mm;
        terms_.resize(wires.size());
        for (std::size_t k = 0; k < wires.size(); ++k) {
            references_.emplace_back(positions(neutral_mm, wires[k].vertices));
            auto& moved = moved_.emplace_back();
            for (std::size_t i = 0; i < examples.examples.size(); ++i)
                moved.push_back(moved_curve(neutral_mm, wires[k], i));
            for (const auto v : samples_) {
                auto foot = references_[k].nearest(neutral_mm[v]);
                if (!not_of[k].empty() && not_of[k][v]) foot.distance_mm = std::numeric_limits<double>::infinity();
                feet_.push_back(foot);
            }
        }
        for (std::size_t k = 0; k < wires.size(); ++k) terms_[k] = term(k);
    }

    void run() {
        for (int sweep = 0; sweep < options_.sweeps; ++sweep)
            for (std::size_t k = 0; k < wires_.size(); ++k) {
                fit_radius(k);
                if (options_.scale_range > 0) fit_scales(k);
            }
    }

private:
    /// What one wire does to the samples: per sample its share, per example and sample share times displacement.
    struct Term {
        std::vector<double> shares;
        std::vector<Vector> pulls_mm;
    };
    [[nodiscard]] Term term(std::size_t k) const {
        Term made;
        const auto& neutral_mm = examples_.neutral.vertices_mm;
        const auto count = examples_.examples.size();
        made.pulls_mm.assign(count * samples_.size(), Vector::Zero());
        for (std::size_t s = 0; s < samples_.size(); ++s) {
            const auto& foot = feet_[k * samples_.size() + s];
            const double falloff = wire_falloff(foot.distance_mm / wires_[k].radius_mm);
            made.shares.push_back(share_of(falloff));
            if (falloff == 0) continue;
            for (std::size_t i = 0; i < count; ++i)
                made.pulls_mm[i * samples_.size() + s] =
                    made.shares.back() * wire_displacement(neutral_mm[samples_[s]], references_[k], moved_[k][i], foot,
                                                           wires_[k].scale[i], falloff);
        }
        return made;
    }
    /// Sum of squares over the samples of one example, or of all.
    [[nodiscard]] double error(std::optional<std::size_t> only = {}) const {
        double sum = 0;
        const auto count = examples_.examples.size();
        for (std::size_t s = 0; s < samples_.size(); ++s) {
            double shares = 0;
            for (const auto& term : terms_) shares += term.shares[s];
            for (std::size_t i = only.value_or(0); i < (only ? *only + 1 : count); ++i) {
                Vector pull = Vector::Zero();
                for (const auto& term : terms_) pull += term.pulls_mm[i * samples_.size() + s];
                if (shares > 0) pull /= shares;
                sum += (pull - examples_.examples[i].displacement_mm[samples_[s]]).squaredNorm();
            }
        }
        return sum;
    }
    void fit_radius(std::size_t k) {
        double best = error(), best_radius_mm = wires_[k].radius_mm;
        auto best_term = terms_[k];
        const double factor = options_.radii > 1 ? std::pow(options_.largest_radius_mm / options_.least_radius_mm,
                                                            1.0 / (options_.radii - 1))
                                                 : 1.0;
        double radius_mm = options_.least_radius_mm;
        for (int r = 0; r < options_.radii; ++r, radius_mm *= factor) {
            wires_[k].radius_mm = radius_mm;
            terms_[k] = term(k);
            if (const double now = error(); now < best) {
                best = now;
                best_radius_mm = radius_mm;
                best_term = terms_[k];
            }
        }
        wires_[k].radius_mm = best_radius_mm;
        terms_[k] = std::move(best_term);
    }
    void fit_scales(std::size_t k) {
        const auto count = examples_.examples.size();
        std::vector<double> best(count), best_scale = wires_[k].scale;
        for (std::size_t i = 0; i < count; ++i) best[i] = error(i);
        for (const double step : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
            wires_[k].scale.assign(count, 1 + step * options_.scale_range);
            terms_[k] = term(k);
            for (std::size_t i = 0; i < count; ++i)
                if (const double now = error(i); now < best[i]) {
                    best[i] = now;
                    best_scale[i] = wires_[k].scale[i];
                }
        }
        wires_[k].scale = best_scale;
        terms_[k] = term(k);
    }

    const FacialExamples& examples_;
    std::vector<Wire>& wires_;
    const WireOptions& options_;
    std::vector<std::uint32_t> samples_;
    std::vector<WireCurve> references_;
    std::vector<std::vector<WireCurve>> moved_;
    std::vector<WireCurve::Foot> feet_;  ///< per wire and sample
    std::vector<Term> terms_;
};

}  // namespace

WireExamples::WireExamples(std::vector<Point> neutral_mm, std::vector<Wire> wires, std::size_t examples)
    : neutral_mm_(std::move(neutral_mm)), wires_(std::move(wires)) {
    for (const auto& wire : wires_) {
        if (wire.vertices.empty() || wire.scale.size() != examples || wire.displacement_mm.size() != examples)
            throw InputError(fmt::format("wire {} has {} scales and {} curves for {} examples", wire.name,
                                         wire.scale.size(), wire.displacement_mm.size(), examples));
        if (!(wire.radius_mm > 0))
            throw InputError(fmt::format("wire {}: radius_mm is {}; give more than 0", wire.name, wire.radius_mm));
        for (const auto v : wire.vertices)
            if (v >= neutral_mm_.size())
                throw InputError(fmt::format("wire {} goes through vertex {} of {}", wire.name, v, neutral_mm_.size()));
        for (const auto& row : wire.displacement_mm)
            if (row.size() != wire.vertices.size())
                throw InputError(
                    fmt::format("wire {} moves {} of {} points", wire.name, row.size(), wire.vertices.size()));
        references_.emplace_back(positions(neutral_mm_, wire.vertices));
    }
    not_of_.resize(wires_.size());
    bind();
}

void WireExamples::bind() {
    std::vector<std::vector<Reach>> of_vertex(neutral_mm_.size());
    base::parallel_for(neutral_mm_.size(), 512, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v)
            for (std::size_t k = 0; k < wires_.size(); ++k) {
                if (!not_of_[k].empty() && not_of_[k][v]) continue;
                const auto foot = references_[k].nearest(neutral_mm_[v]);
                const double falloff = wire_falloff(foot.distance_mm / wires_[k].radius_mm);
                if (falloff > 0) of_vertex[v].push_back({static_cast<std::uint32_t>(k), foot, falloff});
            }
    });
    reaches_.clear();
    first_reach_.assign(1, 0);
    for (const auto& reaches : of_vertex) {
        reaches_.insert(reaches_.end(), reaches.begin(), reaches.end());
        first_reach_.push_back(reaches_.size());
    }
}

std::vector<Point> WireExamples::blended(std::span<const double> weights) const {
    std::vector<WireCurve> moved;
    std::vector<double> scales;
    for (const auto& wire : wires_) {
        if (weights.size() != wire.scale.size())
            throw InputError(fmt::format("{} weights for {} examples", weights.size(), wire.scale.size()));
        auto points = positions(neutral_mm_, wire.vertices);
        double scale = 1;
        for (std::size_t i = 0; i < weights.size(); ++i) {
            scale += weights[i] * (wire.scale[i] - 1);
            for (std::size_t k = 0; k < points.size(); ++k) points[k] += weights[i] * wire.displacement_mm[i][k];
        }
        moved.emplace_back(points);
        scales.push_back(scale);
    }
    auto vertices_mm = neutral_mm_;
    for (std::size_t v = 0; v < vertices_mm.size(); ++v) {
        Vector pull = Vector::Zero();
        double shares = 0;
        for (std::size_t r = first_reach_[v]; r < first_reach_[v + 1]; ++r) {
            const auto& [wire, foot, falloff] = reaches_[r];
            const double share = share_of(falloff);
            pull +=
                share * wire_displacement(neutral_mm_[v], references_[wire], moved[wire], foot, scales[wire], falloff);
            shares += share;
        }
        if (shares > 0) vertices_mm[v] += pull / shares;
    }
    return vertices_mm;
}

WireExamples extract_wires(const FacialExamples& examples, const WireOptions& options) {
    options.check();
    examples.check();
    auto wires = laid_wires(examples);
    auto not_of = opposite_sides(examples, wires);
    Fit(examples, wires, not_of, options).run();
    const auto count = examples.examples.size();
    WireExamples made(examples.neutral.vertices_mm, std::move(wires), count);
    made.not_of_ = std::move(not_of);
    made.bind();
    const auto moving = moving_samples(examples, std::numeric_limits<std::size_t>::max());
    double sum = 0, motion = 0;
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<double> weights(count, 0.0);
        weights[i] = 1;
        const auto blended = made.blended(weights);
        for (const auto v : moving) {
            const Vector truth = examples.examples[i].displacement_mm[v];
            const double off = (blended[v] - examples.neutral.vertices_mm[v] - truth).norm();
            sum += off * off;
            motion += truth.squaredNorm();
            made.error_.largest_mm = std::max(made.error_.largest_mm, off);
        }
    }
    const auto all = static_cast<double>(std::max<std::size_t>(1, count * moving.size()));
    made.error_.rms_mm = std::sqrt(sum / all);
    made.error_.motion_rms_mm = std::sqrt(motion / all);
    return made;
}

}  // namespace mimik::animation
