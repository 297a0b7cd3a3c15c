#pragma once

#include <vector>

#include <Eigen/Core>

#include "base/fields.h"

namespace mimik::modeling {

struct CardinalBasisOptions {
    /// The face at rest is a point, too: there all weights are 0. The paper leaves it out; then a face at rest moves.
    bool with_rest = true;
    /// Ridge of the least squares, as a share of the largest singular value squared of the examples: keeps weights
    /// small along directions in which examples hardly differ. The radial part still makes examples exact. 0: the
    /// paper's plain least squares.
    double ridge_share = 0.0;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("with_rest", self.with_rest);
        visit("ridge_share", self.ridge_share);
    }
    void check() const;  ///< throws InputError
};
static_assert(base::lists_every_field<CardinalBasisOptions>());

/// Weights that are 1 at the example they belong to and 0 at all others: a linear part by least squares (Eq. 9), and
/// on what it leaves (Eq. 10) cubic B-splines of the distance, as wide as the nearest other example is far (Eqs 11 and
/// 12). After "Online expression mapping ..." (ICEC 2007), Sec. 5; Sloan, Rose and Cohen 2001.
class CardinalBasis {
public:
    /// @param examples  a row per example: its place in the parameter space
    /// @throws InputError naming two examples (by number from 0; "rest") at one place; NumericalError where the radial
    /// equations have no answer.
    explicit CardinalBasis(const Eigen::MatrixXd& examples, const CardinalBasisOptions& options = {});

    /// w_i(p) of Eq. 8, one per example.
    [[nodiscard]] Eigen::VectorXd weights(const Eigen::VectorXd& parameters) const;

    /// How far the linear part alone is from 1 or 0 at the examples, at most: 0 where it is exact already.
    [[nodiscard]] double largest_residual() const { return largest_residual_; }
    /// Of the equations for the radial part; of 1 they are as sound as can be.
    [[nodiscard]] double condition() const { return condition_; }
    [[nodiscard]] Eigen::Index examples() const { return linear_.cols(); }

private:
    Eigen::MatrixXd centres_;    ///< a row per example, and one for the face at rest
    Eigen::VectorXd dilations_;  ///< alpha, per centre
    Eigen::MatrixXd linear_;     ///< a_il: dimensions + 1 rows, a column per example
    Eigen::MatrixXd radial_;     ///< r_ji: a row per centre, a column per example
    double largest_residual_ = 0.0, condition_ = 1.0;
};

/// The cubic B-spline with knots at -2, -1, 0, 1, 2: 2/3 at 0, 1/6 at 1, 0 from 2 on.
[[nodiscard]] double cubic_b_spline(double x);

}  // namespace mimik::modeling
