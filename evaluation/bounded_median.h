#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mimik::evaluation {

/// Median of any number of values in bounded memory: exact up to `exact_values` of them (8 MB); of more, each is
/// counted in a step of `step` between `low` and `high` (what lies beyond, in the first or last step), and the median
/// is off by half a step at most. Independent of the order of the values.
class BoundedMedian {
public:
    static constexpr std::size_t exact_values = std::size_t{1} << 20;
    static constexpr double low = -9.0, high = 1.0, step = 1e-5;  ///< explained fractions never exceed 1

    void add(double value);
    [[nodiscard]] double median() const;  ///< 0 of no value

private:
    void count(double value);
    [[nodiscard]] double counted(std::uint64_t rank) const;

    std::vector<double> values_;         // until there are too many
    std::vector<std::uint64_t> counts_;  // from then on; one per step
    std::uint64_t size_ = 0;
};

}  // namespace mimik::evaluation
