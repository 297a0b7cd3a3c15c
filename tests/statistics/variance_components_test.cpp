#include "statistics/variance_components.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/random_stream.h"

namespace mimik::statistics {
namespace {

struct Cells {
    std::vector<double> values;
    std::vector<std::uint32_t> source, target;
    void add(std::uint32_t i, std::uint32_t j, double value) {
        values.push_back(value);
        source.push_back(i);
        target.push_back(j);
    }
    [[nodiscard]] VarianceComponents components() const { return variance_components(values, source, target); }
};

TEST(VarianceComponents, of_a_full_table_are_the_analysis_of_variance_by_hand) {
    // Sources -3, 0, 3; targets -1, 0, 1; the rest sums to 0 in each row and column. Mean squares: 3 * 18 / 2 = 27,
    // 3 * 2 / 2 = 3, 4 / 4 = 1. Variances: (27 - 1) / 3, (3 - 1) / 3, 1.
    const std::array<std::array<double, 3>, 3> rest = {{{1, -1, 0}, {-1, 1, 0}, {0, 0, 0}}};
    Cells cells;
    for (std::uint32_t i = 0; i < 3; ++i)
        for (std::uint32_t j = 0; j < 3; ++j) cells.add(7 + i, 90 - j, 5 + 3 * (i - 1.0) + (j - 1.0) + rest[i][j]);
    const auto of = cells.components();
    EXPECT_DOUBLE_EQ(of.mean, 5);
    EXPECT_NEAR(of.source.variance, 26.0 / 3, 1e-12);
    EXPECT_NEAR(of.target.variance, 2.0 / 3, 1e-12);
    EXPECT_NEAR(of.residual.variance, 1, 1e-12);
    EXPECT_NEAR(of.source.share, 26.0 / 31, 1e-12);
    EXPECT_NEAR(of.source.f, 27, 1e-12);
    // F with 2 and 4 degrees: P(F >= f) = (1 + f / 2)^-2.
    EXPECT_NEAR(of.source.p, 1 / (14.5 * 14.5), 1e-12);
    EXPECT_EQ(of.residual.degrees, 4U);
    EXPECT_EQ(of.cells, 9U);
}

/// Six people, nobody their own source.
Cells people(double source_sd, double target_sd, base::RandomStream& chance) {
    std::array<double, 6> as_source{}, as_target{};
    for (double& one : as_source) one = source_sd * chance.normal();
    for (double& one : as_target) one = target_sd * chance.normal();
    Cells cells;
    for (std::uint32_t i = 0; i < 6; ++i)
        for (std::uint32_t j = 0; j < 6; ++j)
            if (i != j) cells.add(i, j, as_source[i] + as_target[j] + chance.normal());
    return cells;
}

TEST(VarianceComponents, with_a_missing_diagonal_are_right_on_average) {
    constexpr int tables = 2000;
    std::array<double, 3> sum{}, squares{};
    base::RandomStream chance(1, "tables");
    for (int k = 0; k < tables; ++k) {
        const auto of = people(1, 2, chance).components();
        const std::array<double, 3> variances = {of.source.variance, of.target.variance, of.residual.variance};
        for (std::size_t c = 0; c < 3; ++c) {
            sum[c] += variances[c] / tables;
            squares[c] += variances[c] * variances[c] / tables;
        }
    }
    const std::array<double, 3> truth = {1, 4, 1};
    for (std::size_t c = 0; c < 3; ++c) {
        const double error = std::sqrt((squares[c] - sum[c] * sum[c]) / tables);
        EXPECT_NEAR(sum[c], truth[c], 3 * error) << c;  // of the mean of 2000 tables
        EXPECT_LT(error, 0.06) << c;
    }
}

TEST(VarianceComponents, of_the_source_are_not_moved_by_what_targets_do) {
    base::RandomStream chance(2, "tables");
    const auto cells = people(1, 0, chance);
    auto lifted = cells;
    for (std::size_t k = 0; k < lifted.values.size(); ++k) lifted.values[k] += lifted.target[k] == 3 ? 50 : 0;
    const auto before = cells.components(), after = lifted.components();
    EXPECT_NEAR(after.source.variance, before.source.variance, 1e-10);  // of squares of 50
    EXPECT_NEAR(after.residual.variance, before.residual.variance, 1e-10);
    EXPECT_GT(after.target.share, 0.9);
}

TEST(VarianceComponents, below_zero_count_as_no_share) {
    // Checkered: rows and columns have the same means, less than chance would give.
    Cells cells;
    for (std::uint32_t i = 0; i < 4; ++i)
        for (std::uint32_t j = 0; j < 4; ++j) cells.add(i, j, (i + j) % 2 ? 1.0 : -1.0);
    const auto of = cells.components();
    EXPECT_NEAR(of.residual.variance, 16.0 / 9, 1e-12);
    EXPECT_NEAR(of.source.variance, -4.0 / 9, 1e-12);  // (0 - 16 / 9) / 4
    EXPECT_EQ(of.source.share, 0);
    EXPECT_EQ(of.residual.share, 1);
    EXPECT_NEAR(of.source.p, 1, 1e-12);
}

TEST(VarianceComponents, that_cannot_be_told_apart_are_refused) {
    Cells ring;  // each source has one target
    for (std::uint32_t i = 0; i < 5; ++i) ring.add(i, (i + 1) % 5, i);
    EXPECT_THROW((void)ring.components(), NumericalError);
    Cells additive;
    for (std::uint32_t i = 0; i < 3; ++i)
        for (std::uint32_t j = 0; j < 3; ++j) additive.add(i, j, 0.1 * i + 0.3 * j);
    EXPECT_THROW((void)additive.components(), NumericalError);
    EXPECT_THROW((void)variance_components(std::vector<double>{1}, {}, {}), InputError);
}

}  // namespace
}  // namespace mimik::statistics
