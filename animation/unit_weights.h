#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/fields.h"
#include "geometry/types.h"

namespace mimik::animation {

struct UnitWeightsOptions {
    /// A pull of every weight to 0, share of the mean of |motion|^2 of the units at the markers: units whose markers
    /// move alike share a motion evenly, and noise moves none of them far.
    double pull = 0.01;
    double most = 1.5;  ///< no weight exceeds it; 1 is the AU as its models showed it
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("pull", self.pull);
        visit("most", self.most);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<UnitWeightsOptions>());

/// How strong AUs are, by the markers alone: the w >= 0 that makes
///     sum_k |sum_u w_u m_uk - d_k|^2 + pull * mean_u |m_u|^2 * |w|^2
/// least, with m_uk the motion of marker k by unit u at strength 1 and d_k the marker's own. Bounded least squares by
/// coordinate descent, which ends at the one minimum there is (Friedman, Hastie and Tibshirani 2010, "Regularization
/// paths for generalized linear models via coordinate descent", J. Stat. Software 33(1)).
class UnitWeights {
public:
    /// @param motions_mm  [unit][marker]  @throws InputError if they are not all as long, or not finite.
    explicit UnitWeights(std::span<const std::vector<geometry::Vector>> motions_mm,
                         const UnitWeightsOptions& options = {});
    /// @param motion_mm  of every marker, from rest  @throws InputError if the count differs.
    [[nodiscard]] std::vector<double> of(std::span<const geometry::Vector> motion_mm) const;
    [[nodiscard]] std::size_t units() const { return static_cast<std::size_t>(gram_.cols()); }

private:
    double most_ = 1.5;
    Eigen::MatrixXd motions_;  ///< 3 markers x units
    Eigen::MatrixXd gram_;     ///< with the pull
};

}  // namespace mimik::animation
