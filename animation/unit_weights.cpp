#include "animation/unit_weights.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::animation {

using geometry::Vector;

void UnitWeightsOptions::check() const {
    if (!(pull >= 0 && pull <= 100)) throw InputError(fmt::format("pull is {}; give 0 to 100", pull));
    if (!(most > 0 && most <= 100)) throw InputError(fmt::format("most is {}; give more than 0, up to 100", most));
}

UnitWeights::UnitWeights(std::span<const std::vector<Vector>> motions_mm, const UnitWeightsOptions& options)
    : most_(options.most) {
    options.check();
    const std::size_t markers = motions_mm.empty() ? 0 : motions_mm.front().size();
    motions_.resize(static_cast<Eigen::Index>(3 * markers), static_cast<Eigen::Index>(motions_mm.size()));
    for (std::size_t u = 0; u < motions_mm.size(); ++u) {
        if (motions_mm[u].size() != markers)
            throw InputError(fmt::format("unit weights: unit {} moves {} markers, and the first {}", u,
                                         motions_mm[u].size(), markers));
        for (std::size_t k = 0; k < markers; ++k)
            motions_.block<3, 1>(static_cast<Eigen::Index>(3 * k), static_cast<Eigen::Index>(u)) = motions_mm[u][k];
    }
    if (!motions_.allFinite()) throw InputError("unit weights: a motion is not finite");
    gram_ = motions_.transpose() * motions_;
    const double mean = gram_.cols() > 0 ? gram_.trace() / static_cast<double>(gram_.cols()) : 0;
    gram_.diagonal().array() += options.pull * mean;
}

std::vector<double> UnitWeights::of(std::span<const Vector> motion_mm) const {
    if (3 * motion_mm.size() != static_cast<std::size_t>(motions_.rows()))
        throw InputError(
            fmt::format("unit weights: {} markers, and the units move {}", motion_mm.size(), motions_.rows() / 3));
    Eigen::VectorXd wanted(motions_.rows());
    for (std::size_t k = 0; k < motion_mm.size(); ++k)
        wanted.segment<3>(static_cast<Eigen::Index>(3 * k)) = motion_mm[k];
    const Eigen::VectorXd right = motions_.transpose() * wanted;
    Eigen::VectorXd w = Eigen::VectorXd::Zero(gram_.cols());
    constexpr int most_rounds = 2000;
    constexpr double still = 1e-9;  // of a weight
    for (int round = 0; round < most_rounds; ++round) {
        double largest = 0;
        for (Eigen::Index u = 0; u < w.size(); ++u) {
            if (!(gram_(u, u) > 0)) continue;
            const double next = std::clamp(w[u] + (right[u] - gram_.col(u).dot(w)) / gram_(u, u), 0.0, most_);
            largest = std::max(largest, std::abs(next - w[u]));
            w[u] = next;
        }
        if (largest < still) break;
    }
    return {w.begin(), w.end()};
}

}  // namespace mimik::animation
