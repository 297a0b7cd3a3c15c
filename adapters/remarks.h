#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/text.h"
#include "geometry/mesh.h"

namespace mimik::adapters {

/// What a conversion left out or rounded, a sentence each with a count or a value; empty if nothing was lost. Every
/// conversion asks for a list, so that nothing is lost in silence.
using Remarks = std::vector<std::string>;

/// Says by how much single precision moves the points, if it is more than `worth_a_word_mm`.
inline void remark_rounding(const std::vector<geometry::Point>& points_mm, Remarks& remarks,
                            double worth_a_word_mm = 1e-4) {
    double most_mm = 0;
    for (const auto& p : points_mm)
        for (int axis = 0; axis < 3; ++axis)
            if (std::isfinite(p[axis]))
                most_mm = std::max(most_mm, std::abs(static_cast<double>(static_cast<float>(p[axis])) - p[axis]));
    if (most_mm > worth_a_word_mm)
        remarks.push_back("single precision moves points by up to " + std::to_string(most_mm) +
                          " mm: bring the mesh nearer to the origin first");
}

/// Refuses what cannot be counted with the indices of the other side.
inline void check_count(std::size_t count, std::size_t most, const std::string& what) {
    if (count > most)
        throw InputError(what + ": " + std::to_string(count) + " vertices are more than the indices can count (" +
                         std::to_string(most) + "); split the mesh");
}

/// A face that is to be added names vertices that are there.
inline void check_index(std::uint64_t index, std::size_t vertices, std::size_t face, const std::string& what) {
    if (index >= vertices)
        throw InputError(what + ": face " + std::to_string(face) + " names vertex " + std::to_string(index) +
                         ", but there are only " + std::to_string(vertices));
}

/// What Mimik's mesh has and the other side's cannot hold.
inline void remark_texture(const geometry::Mesh& mesh, const std::string& side, Remarks& remarks) {
    if (!mesh.texture_coordinates.empty())
        remarks.push_back(
            base::counted(mesh.texture_coordinates.size(), "texture coordinate is", "texture coordinates are") +
            " left out: " + side + " holds none");
}

inline void remark_attributes(const geometry::Mesh& mesh, const std::string& side, Remarks& remarks) {
    for (const auto& attribute : mesh.attributes)
        remarks.push_back("attribute \"" + attribute.name + "\" is left out: " + side + " holds none of its kind");
}

inline void remark_small_faces(std::size_t dropped, Remarks& remarks) {
    if (dropped > 0)
        remarks.push_back(
            base::counted(dropped, "face of fewer than three corners is", "faces of fewer than three corners are") +
            " left out");
}

}  // namespace mimik::adapters
