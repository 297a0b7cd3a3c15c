#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "geometry/landmarks.h"
#include "geometry/range_scan.h"

namespace mimik::test {

/// A face-like height field in closed form: an ellipsoid with a nose, eye hollows, brows, lips and a chin. Good for
/// known answers, no more: z(x, y) and all 22 landmarks follow from `scale` and `smile_mm` alone.
struct AnalyticFace {
    double scale = 1.0;
    double smile_mm = 0.0;  ///< mouth corners move out and up by this much, the skin around them along

    [[nodiscard]] static double bump(double x, double y, double cx, double cy, double sx, double sy) {
        return std::exp(-0.5 * ((x - cx) * (x - cx) / (sx * sx) + (y - cy) * (y - cy) / (sy * sy)));
    }
    /// Depth of the neutral face at unit scale.
    [[nodiscard]] static double depth(double x, double y) {
        double z =
            70.0 * std::sqrt(std::max(0.0, 1.0 - x * x / (85.0 * 85.0) - (y - 5) * (y - 5) / (115.0 * 115.0))) - 70.0;
        z += 22.0 * bump(x, y, 0, 0, 9, 14);                                   // nose
        z -= 5.0 * (bump(x, y, 32, 35, 12, 7) + bump(x, y, -32, 35, 12, 7));   // eye hollows
        z += 3.0 * (bump(x, y, 32, 52, 16, 5) + bump(x, y, -32, 52, 16, 5));   // brows
        z += 3.5 * (bump(x, y, 0, -27, 15, 3.5) + bump(x, y, 0, -36, 13, 4));  // lips
        z -= 2.0 * bump(x, y, 0, -31.5, 20, 1.5);                              // between the lips
        z += 5.0 * bump(x, y, 0, -60, 14, 9);                                  // chin
        return z;
    }
    /// How the smile moves a point of the unit face in x and y.
    [[nodiscard]] Eigen::Vector2d shift(double x, double y) const {
        Eigen::Vector2d moved(0, 0);
        for (const double side : {-1.0, 1.0})
            moved += smile_mm * bump(x, y, side * 25, -31.5, 12, 12) * Eigen::Vector2d(0.6 * side, 0.8);
        return moved;
    }
    [[nodiscard]] geometry::Point point(double x, double y) const {
        const Eigen::Vector2d d = shift(x, y);
        return scale * geometry::Point(x + d.x(), y + d.y(), depth(x, y));
    }
    [[nodiscard]] geometry::Landmarks landmarks() const {
        std::vector<geometry::Landmark> marks;
        const auto pair = [&](const std::string& name, double x, double y) {
            marks.push_back({name + "_right", point(-x, y), ""});
            marks.push_back({name + "_left", point(x, y), ""});
        };
        pair("brow_outer", 50, 48);
        pair("brow_middle", 33, 54);
        pair("brow_inner", 14, 51);
        pair("eye_outer", 45, 35);
        pair("eye_inner", 17, 34);
        pair("nose_saddle", 9, 32);
        pair("nose_wing", 17, -4);
        pair("mouth_corner", 25, -31.5);
        marks.push_back({"nose_tip", point(0, 0), ""});
        marks.push_back({"upper_lip_outer", point(0, -24), ""});
        marks.push_back({"upper_lip_inner", point(0, -30.5), ""});
        marks.push_back({"lower_lip_inner", point(0, -32.5), ""});
        marks.push_back({"lower_lip_outer", point(0, -41), ""});
        marks.push_back({"chin", point(0, -60), ""});
        return geometry::Landmarks(std::move(marks));
    }
    /// A mesh of quads over these lines of x and y, without a lattice; inside |x| < 66, -70 < y < 80 it is the face.
    [[nodiscard]] geometry::RangeScan mesh(const std::vector<double>& x, const std::vector<double>& y) const {
        geometry::RangeScan mesh;
        for (const double row : y)
            for (const double col : x) mesh.points_mm.push_back(point(col, row));
        const auto cols = static_cast<std::uint32_t>(x.size());
        for (std::uint32_t v = 0; v + cols < mesh.points_mm.size(); ++v)
            if ((v + 1) % cols != 0) mesh.faces.add(std::array<std::uint32_t, 4>{v, v + 1, v + cols + 1, v + cols});
        return mesh;
    }
    /// From `first` to `last` in steps.
    [[nodiscard]] static std::vector<double> lines(double first, double last, double step_mm) {
        std::vector<double> at;
        for (double value = first; value <= last + 1e-9; value += step_mm) at.push_back(value);
        return at;
    }
    /// The lattice of a scanner looking along -z; `step_mm` apart. The smile moves lattice points with the skin.
    [[nodiscard]] geometry::RangeScan scan(double step_mm = 1.0) const {
        geometry::RangeScan scan;
        scan.cols = static_cast<int>(150 / step_mm) + 1;
        scan.rows = static_cast<int>(180 / step_mm) + 1;
        for (int row = 0; row < scan.rows; ++row)
            for (int col = 0; col < scan.cols; ++col) {
                const double x = -75 + step_mm * col, y = -85 + step_mm * row;
                const bool on_face = x * x / (72.0 * 72.0) + (y - 5) * (y - 5) / (92.0 * 92.0) < 1;
                scan.points_mm.push_back(on_face ? point(x, y)
                                                 : geometry::Point::Constant(std::numeric_limits<double>::quiet_NaN()));
                scan.texture_coordinates.emplace_back((x + 75) / 150, (y + 85) / 180);
            }
        return scan;
    }
};

}  // namespace mimik::test
