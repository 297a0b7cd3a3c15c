#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "base/fields.h"
#include "modeling/source_examples.h"

namespace mimik::modeling {

struct ExampleParameterOptions {
    /// Eigenvectors of a smaller share of the whole variance are dropped. The paper has 0.00001, of its own unit.
    double least_eigenvalue_share = 1e-5;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("least_eigenvalue_share", self.least_eigenvalue_share);
    }
    void check() const;  ///< throws InputError
};
static_assert(base::lists_every_field<ExampleParameterOptions>());

/// The space in which examples are points: displacements of features, reduced by a principal component analysis.
/// "Online expression mapping for performance-driven facial animation" (ICEC 2007), Eqs 5 to 7.
struct ExampleParameters {
    Eigen::MatrixXd feature_matrix;  ///< F of Eq. 6: a row per axis that is kept, a column per coordinate of a feature
    Eigen::MatrixXd examples;        ///< p_i = F v_i of Eq. 7, mm: a row per example; the face at rest is 0
    Eigen::VectorXd eigenvalues;     ///< of the covariance, all that are not 0, falling, mm^2
    double kept_share = 1.0;         ///< of the variance
    /// What the reduction takes from the examples, mm: root mean square of v_i - F^T p_i over the coordinates, of all
    /// examples and of the one that loses most.
    double loss_rms_mm = 0.0, largest_loss_rms_mm = 0.0;
    std::size_t largest_loss_example = 0;

    [[nodiscard]] std::size_t dimensions() const { return static_cast<std::size_t>(feature_matrix.rows()); }
    /// p = F d of Eq. 13. @param displacement_mm  x, y, z of every feature in turn
    [[nodiscard]] Eigen::VectorXd project(const Eigen::VectorXd& displacement_mm) const {
        return feature_matrix * displacement_mm;
    }
};

/// The face at rest counts as one more point, at 0, so that the kept axes span it, too.
/// @throws InputError for bad options or if no example moves a feature.
[[nodiscard]] ExampleParameters example_parameters(const SourceExamples& source,
                                                   const ExampleParameterOptions& options = {});

/// x, y, z of every feature in turn.
[[nodiscard]] Eigen::VectorXd concatenated(const std::vector<geometry::Vector>& displacement_mm);

}  // namespace mimik::modeling
