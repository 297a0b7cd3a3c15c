#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/case_row.h"
#include "evaluation/estimator.h"
#include "geometry/mesh.h"

namespace mimik::evaluation {

/// Cases whose error is wanted vertex by vertex.
struct CaseChoice {
    std::string target, expression;
    std::string method;  ///< with its magnitude where that is not 1: "default@0.8"
    std::string source;  ///< empty: every one that the method learns from

    [[nodiscard]] bool fits(const CaseKey& key) const;
    [[nodiscard]] std::string text() const;  ///< as it is written
    bool operator==(const CaseChoice&) const = default;
};
/// "bs000:12:default" or, with a source, "bs000:12:default:bs001". @throws InputError for anything else.
[[nodiscard]] CaseChoice parse_case_choice(std::string_view text);

/// Distance of every vertex to the nearest point of the real expressive scan, as "surface_distance" takes its mean:
/// mm, one per vertex of the judged face; NaN where the vertex is not scored. One without an answer, or that stays
/// where it was, has the distance of doing nothing.
[[nodiscard]] std::vector<double> vertex_errors_mm(const JudgedFace& face);

/// The synthetic face as a mesh, in the scanner frame of the target's neutral scan: the vertices that are part of the
/// face, with the attributes `error_mm` (as vertex_errors_mm), `in_zone` (0 or 1), `displacement_mm` (3 numbers, from
/// the neutral face) and `grid_vertex` (its place in the neutral scan's grid).
[[nodiscard]] geometry::Mesh judged_mesh(const JudgedFace& face, const std::vector<double>& error_mm);

/// "bs000_12_default_bs001", without what a file's name should not hold; with 8 digits of a hash where that was
/// replaced.
[[nodiscard]] std::string file_stem(const CaseKey& key);

}  // namespace mimik::evaluation
