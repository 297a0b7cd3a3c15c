#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mimik::evaluation {

/// Units of a plan in its order, from `begin` up to but without `end`.
struct UnitRange {
    std::size_t begin = 0, end = static_cast<std::size_t>(-1);

    [[nodiscard]] bool contains(std::size_t unit) const { return begin <= unit && unit < end; }
    bool operator==(const UnitRange&) const = default;
};

/// One of several equal parts of an experiment, each a run of neighbours in the plan: neighbours share an expression,
/// and with it what is learned from its participants. The rows of shard 1, then 2, then the rest are those of a run
/// from start to end.
struct Shard {
    std::size_t index = 1;  ///< 1 ... count
    std::size_t count = 1;

    /// Its part of `units`; empty where there are more shards than units. Sizes differ by one at most.
    [[nodiscard]] UnitRange of(std::size_t units) const { return {units * (index - 1) / count, units * index / count}; }
    [[nodiscard]] std::string text() const;  ///< "3/20"
    bool operator==(const Shard&) const = default;
};

inline constexpr std::size_t most_shards = 100'000;

/// "3/20". @throws InputError for anything else.
[[nodiscard]] Shard parse_shard(std::string_view text);

}  // namespace mimik::evaluation
