#include "evaluation/correlation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::evaluation {
namespace {

constexpr std::size_t fewest_pairs = 3;  // two always lie on a line

void check_sizes(std::span<const double> x, std::span<const double> y) {
    if (x.size() != y.size())
        throw InputError(fmt::format("a correlation of {} numbers with {}; give as many of each", x.size(), y.size()));
}

std::vector<double> ranks(std::span<const double> values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    std::vector<double> rank(values.size());
    for (std::size_t begin = 0; begin < order.size();) {
        std::size_t end = begin;
        while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
        for (std::size_t k = begin; k < end; ++k) rank[order[k]] = 0.5 * static_cast<double>(begin + end - 1);
        begin = end;
    }
    return rank;
}

double pairs_among(std::size_t n) { return 0.5 * static_cast<double>(n) * (static_cast<double>(n) - 1); }

/// Pairs that are equal, in a list in which equal values stand together.
template <class Equal>
double tied_pairs(std::size_t n, const Equal& equal) {
    double tied = 0;
    for (std::size_t begin = 0; begin < n;) {
        std::size_t end = begin + 1;
        while (end < n && equal(begin, end)) ++end;
        tied += pairs_among(end - begin);
        begin = end;
    }
    return tied;
}

/// Pairs out of order, by a merge sort.
double inversions(std::vector<double>& values, std::vector<double>& spare, std::size_t begin, std::size_t end) {
    if (end - begin < 2) return 0;
    const std::size_t middle = begin + (end - begin) / 2;
    double count = inversions(values, spare, begin, middle) + inversions(values, spare, middle, end);
    for (std::size_t a = begin, b = middle, k = begin; k < end; ++k) {
        if (b == end || (a < middle && values[a] <= values[b])) {
            spare[k] = values[a++];
        } else {
            count += static_cast<double>(middle - a);
            spare[k] = values[b++];
        }
    }
    const auto at = [](std::vector<double>& list, std::size_t k) {
        return list.begin() + static_cast<std::ptrdiff_t>(k);
    };
    std::copy(at(spare, begin), at(spare, end), at(values, begin));
    return count;
}

}  // namespace

std::optional<double> pearson(std::span<const double> x, std::span<const double> y) {
    check_sizes(x, y);
    if (x.size() < fewest_pairs) return std::nullopt;
    const auto n = static_cast<double>(x.size());
    const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
    const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
    double xx = 0, xy = 0, yy = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        xx += (x[k] - mean_x) * (x[k] - mean_x);
        xy += (x[k] - mean_x) * (y[k] - mean_y);
        yy += (y[k] - mean_y) * (y[k] - mean_y);
    }
    if (!(xx > 0 && yy > 0)) return std::nullopt;
    return std::clamp(xy / (std::sqrt(xx) * std::sqrt(yy)), -1.0, 1.0);
}

std::optional<double> spearman(std::span<const double> x, std::span<const double> y) {
    check_sizes(x, y);
    return pearson(ranks(x), ranks(y));
}

std::optional<double> kendall(std::span<const double> x, std::span<const double> y) {
    check_sizes(x, y);
    const std::size_t n = x.size();
    if (n < fewest_pairs) return std::nullopt;
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return x[a] != x[b] ? x[a] < x[b] : y[a] < y[b]; });
    const auto equal_x = [&](std::size_t a, std::size_t b) { return x[order[a]] == x[order[b]]; };
    const double tied_x = tied_pairs(n, equal_x);
    const double tied_both =
        tied_pairs(n, [&](std::size_t a, std::size_t b) { return equal_x(a, b) && y[order[a]] == y[order[b]]; });
    std::vector<double> values, spare(n);
    for (const auto k : order) values.push_back(y[k]);
    const double swaps = inversions(values, spare, 0, n);
    const double tied_y = tied_pairs(n, [&](std::size_t a, std::size_t b) { return values[a] == values[b]; });
    const double all = pairs_among(n);
    if (!(all > tied_x && all > tied_y)) return std::nullopt;
    return (all - tied_x - tied_y + tied_both - 2 * swaps) / (std::sqrt(all - tied_x) * std::sqrt(all - tied_y));
}

}  // namespace mimik::evaluation
