// Ceres for who asks for it (capture/minimise_surface.cpp): a module that is loaded then, since Ceres comes with
// SuiteSparse, LAPACK and glog.

#include <cstdio>
#include <exception>
#include <stdexcept>
#include <vector>

#include <ceres/ceres.h>

#include "base/optimiser_modules.h"

namespace {

class Term : public ceres::CostFunction {
public:
    Term(mimik_residual_function* residual, void* problem, std::size_t term, std::size_t blocks)
        : residual_(residual), problem_(problem), term_(term) {
        set_num_residuals(1);
        for (std::size_t k = 0; k < blocks; ++k) mutable_parameter_block_sizes()->push_back(3);
    }
    bool Evaluate(double const* const* blocks, double* residuals, double** gradients) const override {
        residuals[0] = residual_(problem_, term_, blocks, gradients);
        return true;
    }

private:
    mimik_residual_function* residual_;
    void* problem_;
    std::size_t term_;
};

void solve(mimik_residual_function* residual, void* data, const mimik_residuals& residuals, double* x,
           int most_iterations, double least_change, int* evaluations) {
    ceres::Problem problem;
    for (std::size_t term = 0; term < residuals.terms; ++term) {
        std::vector<double*> blocks;
        for (auto k = residuals.first[term]; k < residuals.first[term + 1]; ++k)
            blocks.push_back(x + 3 * residuals.block[k]);
        problem.AddResidualBlock(new Term(residual, data, term, blocks.size()), nullptr, blocks);
    }
    for (std::size_t block = 0; block < residuals.blocks; ++block)
        if (residuals.holding[block] && problem.HasParameterBlock(x + 3 * block))
            problem.SetParameterBlockConstant(x + 3 * block);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.num_threads = 1;  // the same input, the same bytes
    options.max_num_iterations = most_iterations;
    options.function_tolerance = least_change;
    options.parameter_tolerance = least_change;
    options.gradient_tolerance = 0;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable()) throw std::runtime_error(summary.message);
    *evaluations = summary.num_residual_evaluations + summary.num_jacobian_evaluations;
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) mimik_ceres_function mimik_ceres_1;

int mimik_ceres_1(mimik_residual_function* residual, void* problem, const mimik_residuals* residuals, double* x,
                  int most_iterations, double least_change, int* evaluations, char* message, std::size_t message_size) {
    try {  // no exception leaves the module
        solve(residual, problem, *residuals, x, most_iterations, least_change, evaluations);
        return 0;
    } catch (const std::exception& e) {
        std::snprintf(message, message_size, "%s", e.what());
    } catch (...) {
        std::snprintf(message, message_size, "Ceres threw something unknown");
    }
    return 1;
}
}
