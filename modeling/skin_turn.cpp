#include "modeling/skin_turn.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "base/errors.h"
#include "geometry/rigid_fit.h"

namespace mimik::modeling {

using geometry::Point;

namespace {

/// What surrounds `node`, turned from one face to the other. An eighth of the vertices says it: surroundings are wide.
Eigen::Quaterniond turn_about(std::size_t node, std::span<const Point> from_mm, std::span<const Point> to_mm,
                              double width_mm) {
    constexpr std::size_t sample_stride = 8;
    std::vector<Point> from, to;
    std::vector<double> weights;
    for (std::size_t k = 0; k < from_mm.size(); k += sample_stride) {
        from.push_back(from_mm[k]);
        to.push_back(to_mm[k]);
        weights.push_back(std::exp(-0.5 * (from_mm[k] - from_mm[node]).squaredNorm() / (width_mm * width_mm)));
    }
    const auto fit = geometry::rigid_fit(from, to, weights);
    return fit ? Eigen::Quaterniond(fit->linear()) : Eigen::Quaterniond::Identity();
}

/// Turns at some vertices, and between them.
class TurnField {
public:
    TurnField(std::span<const Point> rest_mm, std::span<const Point> from_mm, std::span<const Point> to_mm,
              const SkinTurnOptions& options)
        : near_mm_(0.4 * options.width_mm) {
        for (std::size_t v = 0; v < from_mm.size(); v += static_cast<std::size_t>(options.stride)) {
            Eigen::Vector4d turn = turn_about(v, from_mm, to_mm, options.width_mm).coeffs();
            if (turn[3] < 0) turn = -turn;  // both signs are the same turn
            places_mm_.push_back(rest_mm[v]);
            turns_.push_back(turn);
        }
    }
    [[nodiscard]] Eigen::Quaterniond at(const Point& place_mm) const {
        Eigen::Vector4d sum = Eigen::Vector4d::Zero();
        for (std::size_t k = 0; k < turns_.size(); ++k)
            sum += std::exp(-0.5 * (places_mm_[k] - place_mm).squaredNorm() / (near_mm_ * near_mm_)) * turns_[k];
        return sum.norm() > 1e-12 ? Eigen::Quaterniond(sum.normalized()) : Eigen::Quaterniond::Identity();
    }

private:
    double near_mm_;
    std::vector<Point> places_mm_;
    std::vector<Eigen::Vector4d> turns_;  ///< x, y, z, w
};

/// 1 from the level of the eyes up, 0 from that of the nose down, smooth between.
double upper_share(double y_mm, double eyes_y_mm, double nose_y_mm) {
    const double t = std::clamp((y_mm - nose_y_mm) / (eyes_y_mm - nose_y_mm), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace

void SkinTurnOptions::check() const {
    if (!(width_mm >= 1 && width_mm <= 1e6))
        throw InputError(fmt::format("width_mm is {}; give 1 to 1000000", width_mm));
    if (stride < 1) throw InputError(fmt::format("stride is {}; give 1 or more", stride));
}

std::vector<Eigen::Quaterniond> skin_turns(const preprocessing::FaceTemplate& face_template,
                                           std::span<const Point> from_mm, std::span<const Point> to_mm,
                                           const SkinTurnOptions& options) {
    options.check();
    const auto& rest = face_template.surface;
    if (from_mm.size() != rest.size() || to_mm.size() != rest.size())
        throw InputError(fmt::format("skin_turns: {} and {} vertices, and the template has {}; give as many",
                                     from_mm.size(), to_mm.size(), rest.size()));
    std::vector<Eigen::Quaterniond> turns(rest.size(), Eigen::Quaterniond::Identity());
    const auto* left = rest.landmarks.find("eye_inner_left");
    const auto* right = rest.landmarks.find("eye_inner_right");
    const auto* nose = rest.landmarks.find("nose_tip");
    if (!left || !right || !nose) return turns;
    const double eyes_y_mm = 0.5 * (left->position_mm.y() + right->position_mm.y());
    const double nose_y_mm = nose->position_mm.y();
    if (!(eyes_y_mm > nose_y_mm)) return turns;
    const TurnField field(rest.vertices_mm, from_mm, to_mm, options);
    for (std::size_t v = 0; v < turns.size(); ++v) {
        const double share = upper_share(rest.vertices_mm[v].y(), eyes_y_mm, nose_y_mm);
        if (share > 0) turns[v] = Eigen::Quaterniond::Identity().slerp(share, field.at(rest.vertices_mm[v]));
    }
    return turns;
}

}  // namespace mimik::modeling
