#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace mimik::geometry {

/// Items 0, 1, ... that are joined to sets (union-find). The lowest item of a set stands for it, in whatever order they
/// were joined.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t items) : parent_(items) { std::iota(parent_.begin(), parent_.end(), 0U); }

    [[nodiscard]] std::uint32_t root(std::uint32_t item) {
        while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
        return item;
    }
    void join(std::uint32_t one, std::uint32_t other) {
        if (share_parent(one, other)) return;
        const auto a = root(one), b = root(other);
        parent_[std::max(a, b)] = std::min(a, b);
    }
    /// True only of items of one set, but not of all of them: a look that costs nothing.
    [[nodiscard]] bool share_parent(std::uint32_t one, std::uint32_t other) const {
        return parent_[one] == parent_[other];
    }

private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace mimik::geometry
