#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "geometry/face_surface.h"
#include "tests/support/analytic_face.h"

namespace mimik::test {

/// The analytic face with eyes of known lids: skin 1 mm off an eyeball, and an opening between two parabolas.
struct LiddedFace {
    enum class Eyes {
        none,     ///< smooth skin
        hole,     ///< the skin ends at the margins
        ball,     ///< the same, before eyeballs that are parts of the mesh
        surface,  ///< lids and eyeballs are one surface
    };
    static constexpr double radius_mm = 13.5, lid_mm = 1.0, upper_mm = 6.0, lower_mm = 4.0;
    static constexpr double middle_x = 31.0, corner_y = 34.5, half_width_mm = 12.5, step_mm = 0.7;

    Eyes eyes = Eyes::hole;

    /// Of the left eye; the right one is its mirror.
    [[nodiscard]] static geometry::Point centre() {
        return {middle_x, corner_y + 1.2, AnalyticFace::depth(45, 35) - 8.5};
    }
    /// Heights of the margins; equal beyond the corners. @param x  on either side
    [[nodiscard]] static std::array<double, 2> margins_y(double x) {
        const double t = (std::abs(x) - middle_x) / half_width_mm;
        const double share = std::max(0.0, 1.0 - t * t);
        return {corner_y - lower_mm * share, corner_y + upper_mm * share};
    }
    [[nodiscard]] static bool open(double x, double y) {
        const auto [lower, upper] = margins_y(x);
        return y > lower && y < upper;
    }
    [[nodiscard]] static double ball_z(double x, double y, double radius) {
        const auto c = centre();
        const double squared = radius * radius - std::pow(std::abs(x) - c.x(), 2) - std::pow(y - c.y(), 2);
        return squared > 0 ? c.z() + std::sqrt(squared) : -1e9;
    }
    [[nodiscard]] double depth(double x, double y) const {
        const double skin = AnalyticFace::depth(x, y);
        if (eyes == Eyes::none) return skin;
        if (eyes == Eyes::surface && open(x, y)) return ball_z(x, y, radius_mm);
        return std::max(skin, ball_z(x, y, radius_mm + lid_mm));
    }
    /// Landmarks of the corners where the lids meet.
    [[nodiscard]] geometry::Landmarks landmarks() const {
        std::vector<geometry::Landmark> marks;
        const auto plain = AnalyticFace{}.landmarks();
        for (const auto& mark : plain.all()) {
            marks.push_back(mark);
            auto& p = marks.back().position_mm;
            if (mark.name.starts_with("eye_")) p.z() = depth(p.x(), p.y());
        }
        return geometry::Landmarks(std::move(marks));
    }
    [[nodiscard]] geometry::FaceSurface surface() const {
        geometry::Mesh mesh;
        const auto x = AnalyticFace::lines(-65.1, 65.2, step_mm), y = AnalyticFace::lines(-70, 80, step_mm);
        for (const double row : y)
            for (const double col : x) mesh.vertices_mm.emplace_back(col, row, depth(col, row));
        const auto cols = static_cast<std::uint32_t>(x.size());
        const bool cut = eyes == Eyes::hole || eyes == Eyes::ball;
        const auto gone = [&](std::uint32_t v) {
            return cut && open(mesh.vertices_mm[v].x(), mesh.vertices_mm[v].y());
        };
        const auto skin = static_cast<std::uint32_t>(mesh.vertices_mm.size());
        for (std::uint32_t v = 0; v + cols < skin; ++v) {
            if ((v + 1) % cols == 0 || gone(v) || gone(v + 1) || gone(v + cols + 1) || gone(v + cols)) continue;
            mesh.faces.add(std::array{v, v + 1, v + cols + 1, v + cols});
        }
        if (eyes == Eyes::ball)
            for (const double side : {1.0, -1.0}) add_ball(mesh, side);
        return geometry::face_surface(mesh, landmarks());
    }

private:
    static void add_ball(geometry::Mesh& mesh, double side) {
        constexpr std::uint32_t around = 24, rings = 12;
        const auto first = static_cast<std::uint32_t>(mesh.vertices_mm.size());
        auto c = centre();
        c.x() *= side;
        for (std::uint32_t ring = 1; ring < rings; ++ring)
            for (std::uint32_t k = 0; k < around; ++k) {
                const double polar = std::numbers::pi * ring / rings, turn = 2 * std::numbers::pi * k / around;
                mesh.vertices_mm.push_back(c + radius_mm * geometry::Vector(std::sin(polar) * std::cos(turn),
                                                                            std::cos(polar),
                                                                            std::sin(polar) * std::sin(turn)));
            }
        for (std::uint32_t ring = 0; ring + 2 < rings; ++ring)
            for (std::uint32_t k = 0; k < around; ++k) {
                const auto v = first + ring * around + k, next = first + ring * around + (k + 1) % around;
                mesh.faces.add(std::array{v, next, next + around, v + around});
            }
    }
};

}  // namespace mimik::test
