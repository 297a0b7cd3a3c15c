#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "geometry/cholesky_simd.h"
#include "geometry/thin_plate_spline_simd.h"

namespace mimik::geometry::simd {
namespace {

/// Runs a check once for every instruction set of this machine, the plainest included.
template <class Check>
void on_every_instruction_set(Check check) {
    auto sets = hwy::SupportedTargets();
    for (; sets != 0; sets &= sets - 1) {
        const auto one =
            static_cast<std::int64_t>(std::uint64_t{1} << std::countr_zero(static_cast<std::uint64_t>(sets)));
        hwy::SetSupportedTargetsForTest(one);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        SCOPED_TRACE(hwy::TargetName(one));
        check();
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

double between(std::mt19937_64& engine, double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
}

std::vector<double> numbers(std::size_t count, double low, double high, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    std::vector<double> values(count);
    for (auto& v : values) v = between(engine, low, high);
    return values;
}

TEST(KernelValues, of_r2_log_r2_are_those_of_the_library_logarithm_at_every_distance) {
    on_every_instruction_set([] {
        // Along one axis r^2 is exact to its last bit; 1e-150 .. 1e150 covers what a square can hold.
        std::mt19937_64 engine(1);
        std::vector<double> points;
        for (int i = 0; i < 4001; ++i) {
            const double near_one = between(engine, 0.5, 2.0);
            points.insert(points.end(), {i % 2 == 0 ? near_one : std::pow(10.0, between(engine, -150, 150)), 0.0, 0.0});
        }
        std::vector<double> values(points.size() / 3);
        const double centre[3] = {};
        kernel_values(SplineKernel::r2_log_r2, centre, points.data(), values.data(), values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double squared = points[3 * i] * points[3 * i];
            // Two ulps of the logarithm, or of 1 where the logarithm is small.
            const double tolerance =
                squared * (std::abs(std::log(squared)) + 1) * 2 * std::numeric_limits<double>::epsilon();
            EXPECT_NEAR(values[i], squared * std::log(squared), tolerance) << points[3 * i];
        }
    });
}

TEST(KernelValues, are_zero_at_the_centre_and_finite_next_to_it) {
    on_every_instruction_set([] {
        const double centre[3] = {1, 2, 3};
        const double points[9] = {1, 2, 3, 1 + 1e-16, 2, 3, 1, 2, 3 + 1e-15};
        for (const auto kernel : {SplineKernel::r, SplineKernel::r2_log_r2}) {
            double values[3] = {9, 9, 9};
            kernel_values(kernel, centre, points, values, 3);
            EXPECT_EQ(values[0], 0);
            EXPECT_LT(std::abs(values[1]) + std::abs(values[2]), 1e-14);
        }
        const double tiny[3] = {1e-160, 0, 0}, origin[3] = {};  // r^2 is denormal
        double value = 9;
        kernel_values(SplineKernel::r2_log_r2, origin, tiny, &value, 1);
        EXPECT_LT(std::abs(value), 1e-300);
    });
}

TEST(EvaluateSpline, equals_the_plain_sum_for_every_count_of_points) {
    const auto centres = numbers(51, -80, 80, 2), weights = numbers(51, -1e-3, 1e-3, 3);
    const auto points = numbers(120, -90, 90, 4);
    const double affine[12] = {1.1, 0.1, -0.2, 5, 0.3, 0.9, 0.1, -6, 0, 0.2, 1.2, 7};
    on_every_instruction_set([&] {
        for (const auto kernel : {SplineKernel::r, SplineKernel::r2_log_r2}) {
            const SplineTerms spline{kernel, centres.data(), weights.data(), 17, affine};
            std::vector<double> all(points.size());
            evaluate_spline(spline, points.data(), all.data(), 40);
            for (std::size_t i = 0; i < 40; ++i) {
                const double* p = &points[3 * i];
                for (std::size_t c = 0; c < 3; ++c) {
                    double sum = affine[4 * c + 3];
                    for (std::size_t k = 0; k < 3; ++k) sum += affine[4 * c + k] * p[k];
                    for (std::size_t j = 0; j < 17; ++j) {
                        double squared = 0;
                        for (std::size_t k = 0; k < 3; ++k) squared += std::pow(p[k] - centres[3 * j + k], 2);
                        sum += weights[3 * j + c] *
                               (kernel == SplineKernel::r ? -std::sqrt(squared) : squared * std::log(squared));
                    }
                    EXPECT_NEAR(all[3 * i + c], sum, 1e-11);  // terms of up to 1e3, 17 of them, 16 digits
                }
            }
            // Any part gives the same bits as the whole, and nothing is written beyond it.
            for (std::size_t count = 0; count < 40; ++count) {
                std::vector<double> part(points.size(), -7.0);
                evaluate_spline(spline, points.data(), part.data(), count);
                for (std::size_t i = 0; i < part.size(); ++i) EXPECT_EQ(part[i], i < 3 * count ? all[i] : -7.0);
            }
        }
    });
}

TEST(Cholesky, factor_and_forward_solution_equal_those_of_eigen_for_every_size) {
    on_every_instruction_set([] {
        for (const Eigen::Index n : {1, 2, 7, 23, 24, 25, 48, 61, 97, 130}) {
            const auto random = numbers(static_cast<std::size_t>(n * n), -1, 1, static_cast<std::uint64_t>(n));
            const Eigen::Map<const Eigen::MatrixXd> M(random.data(), n, n);
            const Eigen::MatrixXd A = M * M.transpose() + static_cast<double>(n) * Eigen::MatrixXd::Identity(n, n);
            const auto right = numbers(static_cast<std::size_t>(3 * n), -1, 1, 5);
            const Eigen::MatrixXd B = Eigen::Map<const Eigen::MatrixXd>(right.data(), n, 3);
            const auto stride = static_cast<Eigen::Index>(cholesky_stride(static_cast<std::size_t>(n + 3)));
            Eigen::MatrixXd a = Eigen::MatrixXd::Zero(stride, n);
            a.topRows(n).triangularView<Eigen::Lower>() = A;
            a.middleRows<3>(n) = B.transpose();
            ASSERT_TRUE(factor_cholesky(a.data(), static_cast<std::size_t>(n + 3), static_cast<std::size_t>(n),
                                        static_cast<std::size_t>(stride), 0.0));
            const Eigen::LLT<Eigen::MatrixXd> expected(A);
            const Eigen::MatrixXd L = a.topRows(n).triangularView<Eigen::Lower>();
            // Well conditioned (condition below 10): n terms, 16 digits.
            EXPECT_LT((L - Eigen::MatrixXd(expected.matrixL())).norm(), 1e-13 * L.norm());
            EXPECT_LT((a.middleRows<3>(n).transpose() - expected.matrixL().solve(B)).norm(), 1e-13 * B.norm());
            EXPECT_EQ(a.bottomRows(stride - n - 3).norm(), 0);
        }
    });
}

TEST(Cholesky, a_matrix_that_is_not_positive_definite_is_refused) {
    on_every_instruction_set([] {
        for (const Eigen::Index bad : {0, 5, 39}) {
            const Eigen::Index n = 40;
            const auto stride = static_cast<Eigen::Index>(cholesky_stride(static_cast<std::size_t>(n)));
            Eigen::MatrixXd a = Eigen::MatrixXd::Zero(stride, n);
            a.diagonal().setOnes();
            a(bad, bad) = 1e-15;
            const auto factored = [&](double least_pivot) {
                Eigen::MatrixXd copy = a;
                return factor_cholesky(copy.data(), 40, 40, static_cast<std::size_t>(stride), least_pivot);
            };
            EXPECT_TRUE(factored(1e-16));
            EXPECT_FALSE(factored(1e-14));
            a(bad, bad) = std::numeric_limits<double>::quiet_NaN();
            EXPECT_FALSE(factored(0));
        }
    });
}

}  // namespace
}  // namespace mimik::geometry::simd
