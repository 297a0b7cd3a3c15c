#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "base/errors.h"
#include "figures/figure.h"

/// Skips a test that draws where the machine cannot draw at all, and says why.
#define SKIP_WITHOUT_RENDERER()                \
    try {                                      \
        (void)mimik::figures::drawing_route(); \
    } catch (const mimik::InputError& e) {     \
        GTEST_SKIP() << e.what();              \
    }

namespace mimik::figures {

/// Square of `side_mm` in the x-y plane about the origin, facing the viewer, n x n vertices, rows from below.
inline geometry::Mesh square(double side_mm, std::uint32_t n = 2) {
    geometry::Mesh mesh;
    for (std::uint32_t row = 0; row < n; ++row)
        for (std::uint32_t col = 0; col < n; ++col) {
            const double u = col / double(n - 1), v = row / double(n - 1);
            mesh.vertices_mm.emplace_back(side_mm * (u - 0.5), side_mm * (v - 0.5), 0);
            mesh.texture_coordinates.emplace_back(u, v);
        }
    for (std::uint32_t row = 0; row + 1 < n; ++row)
        for (std::uint32_t col = 0; col + 1 < n; ++col) {
            const std::uint32_t a = row * n + col;
            mesh.faces.add(std::array{a, a + 1, a + n + 1, a + n});
        }
    return mesh;
}

inline geometry::Mesh sphere(double radius_mm, std::uint32_t n = 60) {
    geometry::Mesh mesh;
    for (std::uint32_t row = 0; row <= n; ++row)
        for (std::uint32_t col = 0; col < 2 * n; ++col) {
            const double down = std::numbers::pi * row / n, around = std::numbers::pi * col / n;
            mesh.vertices_mm.emplace_back(radius_mm * std::sin(down) * std::sin(around), radius_mm * std::cos(down),
                                          radius_mm * std::sin(down) * std::cos(around));
        }
    for (std::uint32_t row = 0; row < n; ++row)
        for (std::uint32_t col = 0; col < 2 * n; ++col) {
            const std::uint32_t next = (col + 1) % (2 * n), a = row * 2 * n, b = a + 2 * n;
            mesh.faces.add(std::array{a + col, b + col, b + next, a + next});
        }
    return mesh;
}

/// One panel of 200 x 200 pixels that shows 200 mm x 200 mm about the origin: one pixel is one millimetre.
inline Figure figure_of(Panel panel) {
    Figure figure;
    panel.centre_mm = geometry::Point::Zero();
    figure.panels.push_back(std::move(panel));
    figure.panel_width_px = figure.panel_height_px = 200;
    figure.height_mm = 200;
    return figure;
}

inline int margin_px(const Figure& figure) { return figure.font_size_px / 2; }

inline Colour pixel(const io::Image& image, int x, int y) {
    const auto first =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
    return {image.rgb.at(first), image.rgb.at(first + 1), image.rgb.at(first + 2)};
}

/// The pixel of figure_of() in which the point (x, y) mm of a front view lies.
inline Colour at_mm(const io::Image& image, const Figure& figure, double x_mm, double y_mm) {
    return pixel(image, margin_px(figure) + static_cast<int>(std::floor(100 + x_mm)),
                 margin_px(figure) + static_cast<int>(std::floor(100 - y_mm)));
}

inline constexpr Colour white = {255, 255, 255};

}  // namespace mimik::figures
