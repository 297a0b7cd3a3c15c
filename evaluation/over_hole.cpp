#include "evaluation/over_hole.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <utility>

#include "geometry/face_axes.h"

namespace mimik::evaluation {

using geometry::FaceSurface;
using geometry::Point;
using geometry::QuadGrid;
using geometry::VertexMask;

namespace {

constexpr double over_mm = 1.5;  // twice the spacing of the scan, and more than its border's own jags

/// The cells of a grid and one ring of empty ones around it; cell (row, col) has vertex (row, col) at its upper right.
class GridCells {
public:
    explicit GridCells(const QuadGrid& grid)
        : rows_(grid.rows + 1), cols_(grid.cols + 1), part_(static_cast<std::size_t>(rows_ * cols_), empty) {
        for (int row = 0; row + 1 < grid.rows; ++row)
            for (int col = 0; col + 1 < grid.cols; ++col) {
                const auto corners = {grid.index(row, col), grid.index(row, col + 1), grid.index(row + 1, col),
                                      grid.index(row + 1, col + 1)};
                if (std::all_of(corners.begin(), corners.end(), [&](auto v) { return grid.measured(v); }))
                    at(row + 1, col + 1) = full;
            }
        fill(0, 0, outside);
        mark_holes(smallest_hole_cells(grid));
    }

    /// Whether one of the four cells about a vertex is of a hole, and none is outside the scan.
    [[nodiscard]] bool rim(int row, int col) const {
        const std::array<std::uint8_t, 4> around = {at(row, col), at(row, col + 1), at(row + 1, col),
                                                    at(row + 1, col + 1)};
        return std::count(around.begin(), around.end(), hole) > 0 &&
               std::count(around.begin(), around.end(), outside) == 0;
    }

private:
    enum Part : std::uint8_t { empty, full, outside, hole, small_hole };

    [[nodiscard]] std::size_t cell(int row, int col) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(cols_) + static_cast<std::size_t>(col);
    }
    [[nodiscard]] std::uint8_t& at(int row, int col) { return part_[cell(row, col)]; }
    [[nodiscard]] std::uint8_t at(int row, int col) const { return part_[cell(row, col)]; }

    static double smallest_hole_cells(const QuadGrid& grid) {
        constexpr double smallest_mm2 = std::numbers::pi * over_mm * over_mm;
        for (int row = 0; row + 1 < grid.rows; ++row)
            for (int col = 0; col + 1 < grid.cols; ++col) {
                const auto a = grid.index(row, col), b = grid.index(row + 1, col + 1);
                if (!grid.measured(a) || !grid.measured(b)) continue;
                const auto diagonal = (grid.vertices_mm[b] - grid.vertices_mm[a]).head<2>().eval();
                return smallest_mm2 / std::abs(diagonal.x() * diagonal.y());  // the grid is regular in x and y
            }
        return 0;
    }

    /// Empty cells that hang together by their sides take the new part. @return which
    std::vector<std::pair<int, int>> fill(int row, int col, Part part) {
        std::vector<std::pair<int, int>> open = {{row, col}}, filled;
        while (!open.empty()) {
            const auto [r, c] = open.back();
            open.pop_back();
            if (r < 0 || c < 0 || r >= rows_ || c >= cols_ || at(r, c) != empty) continue;
            at(r, c) = part;
            filled.emplace_back(r, c);
            for (const auto& next :
                 {std::pair(r + 1, c), std::pair(r - 1, c), std::pair(r, c + 1), std::pair(r, c - 1)})
                open.push_back(next);
        }
        return filled;
    }

    void mark_holes(double smallest_cells) {
        for (int row = 0; row < rows_; ++row)
            for (int col = 0; col < cols_; ++col) {
                if (at(row, col) != empty) continue;
                const auto cells = fill(row, col, hole);
                if (static_cast<double>(cells.size()) >= smallest_cells) continue;
                for (const auto& [r, c] : cells) at(r, c) = small_hole;
            }
    }

    int rows_, cols_;
    std::vector<std::uint8_t> part_;
};

/// Whether a point of the scan lies on the border of a hole.
bool on_hole(const geometry::SurfaceIndex& scan, const VertexMask& rim, const geometry::SurfacePoint& point) {
    if (!scan.on_border(point)) return false;
    constexpr double no_weight = 1e-9;  // as SurfaceIndex::on_border
    const auto& corners = scan.triangles()[point.triangle];
    for (std::size_t k = 0; k < 3; ++k)
        if (point.barycentric[static_cast<Eigen::Index>(k)] > no_weight && !rim[corners[k]]) return false;
    return true;
}

/// The red of the lips: between the corners of the mouth, from the outer border of one lip to that of the other.
class RedOfLips {
public:
    static std::optional<RedOfLips> of(const geometry::Landmarks& landmarks) {
        const auto axes = geometry::head_axes(landmarks);
        const auto* upper = landmarks.find("upper_lip_outer");
        const auto* lower = landmarks.find("lower_lip_outer");
        if (!axes || !upper || !lower) return std::nullopt;  // corners are there, or there were no axes
        RedOfLips lips;
        lips.axes_ = *axes;
        lips.right_mm_ = axes->lateral.dot(landmarks.position_mm("mouth_corner_right"));
        lips.left_mm_ = axes->lateral.dot(landmarks.position_mm("mouth_corner_left"));
        lips.low_mm_ = axes->up.dot(lower->position_mm);
        lips.high_mm_ = axes->up.dot(upper->position_mm);
        return lips;
    }
    [[nodiscard]] bool holds(const Point& p) const {
        const double across_mm = axes_.lateral.dot(p), up_mm = axes_.up.dot(p);
        return across_mm > right_mm_ && across_mm < left_mm_ && up_mm > low_mm_ && up_mm < high_mm_;
    }

private:
    geometry::HeadAxes axes_;
    double right_mm_ = 0, left_mm_ = 0, low_mm_ = 0, high_mm_ = 0;
};

class OverHole : public Estimator {
public:
    [[nodiscard]] std::string name() const override { return "over_hole"; }
    [[nodiscard]] std::vector<Measure> measure(const JudgedFace& face) const override {
        const auto& target = face.target;
        const auto& neutral = face.neutral;
        if (target.hole_rim.empty() || !target.whole_face) return {};
        std::vector<std::uint32_t> asked;
        std::vector<Point> moved_mm;
        for (std::uint32_t v = 0; v < neutral.size(); ++v) {
            if (!neutral.measured[v]) continue;
            asked.push_back(v);
            moved_mm.emplace_back(neutral.vertices_mm[v] + face.way_mm(v));
        }
        const auto lips = RedOfLips::of(neutral.landmarks);
        const auto hits = target.expressive->closest(moved_mm);
        std::size_t all = 0, of_lips = 0;
        for (std::size_t i = 0; i < hits.size(); ++i) {
            if (hits[i].distance_mm <= over_mm || !on_hole(*target.expressive, target.hole_rim, hits[i])) continue;
            ++all;
            if (lips && lips->holds(neutral.vertices_mm[asked[i]])) ++of_lips;
        }
        std::vector<Measure> measures = {{"face", "vertices", static_cast<double>(all), "vertices"}};
        if (lips) measures.push_back({"mouth", "vertices", static_cast<double>(of_lips), "vertices"});
        return measures;
    }
};

}  // namespace

VertexMask hole_rim(const QuadGrid& grid) {
    const GridCells cells(grid);
    VertexMask rim(grid.size(), 0);
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col)
            if (grid.measured(grid.index(row, col))) rim[grid.index(row, col)] = cells.rim(row, col) ? 1 : 0;
    return rim;
}

std::unique_ptr<const Estimator> over_hole_estimator() { return std::make_unique<OverHole>(); }

}  // namespace mimik::evaluation
