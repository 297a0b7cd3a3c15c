// OpenCV's downhill simplex for who asks for it (capture/minimise_surface.cpp): a module that is loaded then, so that
// `mimik` needs no OpenCV.

#include <cstdio>
#include <exception>

#include <opencv2/core.hpp>
#include <opencv2/core/optim.hpp>

#include "base/optimiser_modules.h"

namespace {

class Function : public cv::MinProblemSolver::Function {
public:
    Function(mimik_value_function* function, void* data, std::size_t count)
        : function_(function), data_(data), count_(static_cast<int>(count)) {}
    int getDims() const override { return count_; }
    double calc(const double* x) const override {
        ++evaluations;
        return function_(data_, x);
    }
    mutable int evaluations = 0;

private:
    mimik_value_function* function_;
    void* data_;
    int count_;
};

}  // namespace

extern "C" {

__attribute__((visibility("default"))) mimik_simplex_function mimik_simplex_1;

int mimik_simplex_1(mimik_value_function* function, void* data, double* x, std::size_t count, double first_step,
                    double least_change, int* evaluations, double* value, char* message, std::size_t message_size) {
    try {  // no exception leaves the module
        const auto problem = cv::makePtr<Function>(function, data, count);
        cv::Mat at(1, problem->getDims(), CV_64F, x);
        const cv::Mat step(1, problem->getDims(), CV_64F, cv::Scalar(first_step));
        const auto solver = cv::DownhillSolver::create(
            problem, step,
            cv::TermCriteria(cv::TermCriteria::MAX_ITER + cv::TermCriteria::EPS, *evaluations, least_change));
        cv::Mat best = at.clone();
        *value = solver->minimize(best);
        for (int k = 0; k < best.cols; ++k) x[k] = best.at<double>(0, k);
        *evaluations = problem->evaluations;
        return 0;
    } catch (const std::exception& e) {
        std::snprintf(message, message_size, "%s", e.what());
    } catch (...) {
        std::snprintf(message, message_size, "OpenCV threw something unknown");
    }
    return 1;
}
}
