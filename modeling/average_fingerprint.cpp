#include "modeling/average_fingerprint.h"

#include <fmt/format.h>

#include "base/content_hash.h"

namespace mimik::modeling {

std::string average_fingerprint(const preprocessing::AverageFace& average) {
    base::ContentHash hash;
    const auto& grid = average.grid;
    hash.add(fmt::format("{} {}\n", grid.rows, grid.cols));
    for (std::size_t v = 0; v < grid.size(); ++v) {
        hash.add(static_cast<double>(grid.origin[v]));
        if (!grid.inside(v)) continue;  // its depth says nothing
        for (const double x : grid.vertices_mm[v]) hash.add(x);
    }
    for (const auto& mark : average.landmarks.all()) {
        hash.add(mark.name + "\n");
        for (const double x : mark.position_mm) hash.add(x);
    }
    return hash.text();
}

}  // namespace mimik::modeling
