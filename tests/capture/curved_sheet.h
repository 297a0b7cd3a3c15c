#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "capture/control_surface.h"
#include "capture/marker_set.h"
#include "facs/reference_face.h"
#include "geometry/mesh.h"
#include "geometry/surface_index.h"

namespace mimik::test {

/// A sheet about as large and as curved as a face, and the 76 labels of the built-in set on it.
struct CurvedSheet {
    std::vector<geometry::Point> vertices_mm;
    std::vector<geometry::Triangle> triangles;
    geometry::Landmarks labels;

    CurvedSheet() {
        constexpr int columns = 61, rows = 81;
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column)
                vertices_mm.push_back(place(-90 + 3.0 * column, -120 + 3.0 * row));
        for (std::uint32_t row = 0; row + 1 < rows; ++row)
            for (std::uint32_t column = 0; column + 1 < columns; ++column) {
                const auto a = row * columns + column;
                triangles.push_back({a, a + 1, a + columns + 1});
                triangles.push_back({a, a + columns + 1, a + columns});
            }
        const geometry::SurfaceIndex index(vertices_mm, triangles);
        std::vector<geometry::Landmark> list;
        const auto places = capture::place_markers(capture::builtin_marker_set(), facs::reference_landmarks());
        for (const auto& mark : places.all()) {
            const auto at = place(mark.position_mm.x(), mark.position_mm.y());
            list.push_back({mark.name, index.closest(at).position_mm, ""});
        }
        labels = geometry::Landmarks(std::move(list));
    }
    [[nodiscard]] static geometry::Point place(double x, double y) {
        return {x, y, -x * x / 120 - y * y / 300 + 3 * std::sin(x / 15) * std::cos(y / 20)};
    }
    [[nodiscard]] geometry::SurfaceIndex index() const { return {vertices_mm, triangles}; }
    /// Twelve of the labels.
    [[nodiscard]] geometry::Landmarks points() const {
        std::vector<geometry::Landmark> list;
        for (const char* name : {"forehead_high", "eye_outer_left", "eye_inner_left", "eye_inner_right",
                                 "eye_outer_right", "nose_tip", "mouth_corner_left", "mouth_corner_right",
                                 "lip_upper_middle", "chin", "jaw_outer_left", "jaw_outer_right"})
            list.push_back(labels.at(name));
        return geometry::Landmarks(std::move(list));
    }
};

}  // namespace mimik::test
