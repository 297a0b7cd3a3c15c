#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include <Eigen/Core>
// Another library's header: what it warns of is not ours to mend.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#include <unsupported/Eigen/LevenbergMarquardt>
#pragma GCC diagnostic pop

#include "capture/smooth_terms.h"

namespace mimik::capture {

using geometry::Point;
using geometry::Vector;

namespace {

constexpr std::uint32_t holds = 0xFFFFFFFF;

/// What Eigen asks of a problem. A matrix of some hundred rows and columns: dense ones are as quick as sparse ones.
class Problem : public Eigen::DenseFunctor<double> {
public:
    Problem(const SmoothTerms& terms, const std::vector<Point>& pose_mm, std::vector<std::uint32_t> place, int moving)
        // Eigen wants as many residuals as variables: a surface of few triangles has fewer, and the others are 0.
        : DenseFunctor(3 * moving, std::max(3 * moving, static_cast<int>(terms.size()))),
          terms_(terms),
          pose_mm_(pose_mm),
          place_(std::move(place)) {}

    int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& residuals) const {
        residuals.setZero();
        each_term(x, [&](Eigen::Index row, const auto& term, const Point* corners) {
            (void)term;
            residuals[row] = terms_.residual(static_cast<std::size_t>(row), corners, nullptr);
        });
        return 0;
    }
    int df(const Eigen::VectorXd& x, Eigen::MatrixXd& jacobian) const {
        jacobian.setZero();
        each_term(x, [&](Eigen::Index row, const auto& term, const Point* corners) {
            std::array<Vector, SurfaceEnergy::most_corners> gradients;
            (void)terms_.residual(static_cast<std::size_t>(row), corners, gradients.data());
            for (std::size_t c = 0; c < term.count; ++c)
                if (const auto at = place_[term.corners[c]]; at != holds)
                    jacobian.block<1, 3>(row, 3 * static_cast<Eigen::Index>(at)) += gradients[c].transpose();
        });
        return 0;
    }
    [[nodiscard]] Point at(const Eigen::VectorXd& x, std::uint32_t vertex) const {
        if (place_[vertex] == holds) return pose_mm_[vertex];
        return x.segment<3>(3 * static_cast<Eigen::Index>(place_[vertex]));
    }

private:
    template <class Work>
    void each_term(const Eigen::VectorXd& x, const Work& work) const {
        Eigen::Index row = 0;
        for (const auto& term : terms_.energy().terms()) {
            std::array<Point, SurfaceEnergy::most_corners> corners;
            for (std::size_t c = 0; c < term.count; ++c) corners[c] = at(x, term.corners[c]);
            work(row++, term, corners.data());
        }
    }

    const SmoothTerms& terms_;
    const std::vector<Point>& pose_mm_;
    std::vector<std::uint32_t> place_;  ///< of a vertex among those that move
};

}  // namespace

std::size_t solve_by_levenberg(const SmoothTerms& terms, std::vector<Point>& pose_mm,
                               std::span<const std::uint8_t> holding, int most_iterations, double least_change) {
    std::vector<std::uint32_t> place(pose_mm.size(), holds);
    std::uint32_t moving = 0;
    for (std::size_t v = 0; v < pose_mm.size(); ++v)
        if (holding.empty() || holding[v] == 0) place[v] = moving++;
    if (moving == 0) return 0;
    Eigen::VectorXd x(3 * static_cast<Eigen::Index>(moving));
    for (std::size_t v = 0; v < pose_mm.size(); ++v)
        if (place[v] != holds) x.segment<3>(3 * static_cast<Eigen::Index>(place[v])) = pose_mm[v];
    const auto before_mm = pose_mm;
    Problem problem(terms, before_mm, place, static_cast<int>(moving));
    Eigen::LevenbergMarquardt<Problem> solver(problem);
    solver.setFtol(least_change);
    solver.setXtol(least_change);
    solver.setMaxfev(most_iterations);
    solver.minimize(x);
    for (std::uint32_t v = 0; v < pose_mm.size(); ++v) pose_mm[v] = problem.at(x, v);
    return static_cast<std::size_t>(solver.nfev() + solver.njev());
}

}  // namespace mimik::capture
