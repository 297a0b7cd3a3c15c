#include "evaluation/still_skin.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/point_index.h"

namespace mimik::evaluation {

using geometry::FaceSurface;
using geometry::Point;
using geometry::Vector;
using geometry::VertexMask;

namespace {

constexpr double still_share = 0.02;  // of the largest true motion: 0.1 to 0.3 mm, about what a scanner sees
// The same three numbers by which a template's vertices are taken to hold still (TemplateRegistrationOptions); there a
// smooth template is compared, here scans with their noise: so what lies around counts by its mean.
constexpr double still_within_mm = 0.3;
constexpr double still_around_mm = 7.0;
constexpr double off_zone_mm = 20.0;

/// Sums of a number over boxes of a grid, all at the cost of one.
class BoxSums {
public:
    explicit BoxSums(geometry::GridShape shape) : shape_(shape), sums_(size(shape.rows + 1, shape.cols + 1), 0) {}
    void set(std::size_t vertex, double value) {
        const auto cols = static_cast<std::size_t>(shape_.cols);
        sums_[place(static_cast<int>(vertex / cols) + 1, static_cast<int>(vertex % cols) + 1)] = value;
    }
    /// After the last set().
    void add_up() {
        for (int row = 1; row <= shape_.rows; ++row)
            for (int col = 1; col <= shape_.cols; ++col)
                sums_[place(row, col)] +=
                    sums_[place(row - 1, col)] + sums_[place(row, col - 1)] - sums_[place(row - 1, col - 1)];
    }
    /// Of the vertices up to so many rows and columns away.
    [[nodiscard]] double around(std::size_t vertex, int rows, int cols) const {
        const int row = static_cast<int>(vertex) / shape_.cols, col = static_cast<int>(vertex) % shape_.cols;
        const int bottom = std::max(0, row - rows), top = std::min(shape_.rows, row + rows + 1);
        const int left = std::max(0, col - cols), right = std::min(shape_.cols, col + cols + 1);
        return sums_[place(top, right)] - sums_[place(bottom, right)] - sums_[place(top, left)] +
               sums_[place(bottom, left)];
    }

private:
    static std::size_t size(int rows, int cols) {
        return static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
    }
    [[nodiscard]] std::size_t place(int row, int col) const {
        return size(row, shape_.cols + 1) + static_cast<std::size_t>(col);
    }
    geometry::GridShape shape_;
    std::vector<double> sums_;
};

/// So many rows and columns of the face's grid are `mm` long. Empty: no triangle says how far they are apart.
struct Cells {
    int rows = 0, cols = 0;
};
std::optional<Cells> cells_of(const FaceSurface& face, double mm) {
    if (!face.grid || face.triangles.empty()) return std::nullopt;
    Eigen::Array2d step = Eigen::Array2d::Zero();  // a grid is regular in x and y: any of its triangles will do
    const auto& triangle = face.triangles.front();
    for (const auto a : triangle)
        for (const auto b : triangle)
            step = step.max((face.vertices_mm[a] - face.vertices_mm[b]).head<2>().array().abs());
    if (!(step.minCoeff() > 0)) return std::nullopt;
    return Cells{static_cast<int>(std::lround(mm / step.y())), static_cast<int>(std::lround(mm / step.x()))};
}

class StillSkin : public Estimator {
public:
    [[nodiscard]] std::string name() const override { return "still_skin"; }
    [[nodiscard]] std::vector<Measure> measure(const JudgedFace& face) const override {
        double sum_mm = 0;
        std::size_t count = 0;
        for (std::size_t k = 0; k < face.target.still.size(); ++k) {
            if (!face.target.still[k]) continue;
            sum_mm += face.way_mm(face.target.vertices[k]).norm();
            ++count;
        }
        if (count == 0) return {};
        return {{"face", "mean", sum_mm / static_cast<double>(count), "mm"}};
    }
};

}  // namespace

VertexMask still_by_truth(std::span<const Vector> true_displacement_mm) {
    double largest_mm = 0;
    for (const auto& way : true_displacement_mm) largest_mm = std::max(largest_mm, way.norm());
    VertexMask still;
    for (const auto& way : true_displacement_mm) still.push_back(way.norm() < still_share * largest_mm ? 1 : 0);
    return still;
}

VertexMask still_by_scans(const FaceSurface& neutral, const ScoredTarget& target) {
    const auto box = cells_of(neutral, still_around_mm);
    if (!box) return {};
    BoxSums distances(*neutral.grid), counts(*neutral.grid);
    std::vector<Point> zone, scored;
    for (std::size_t k = 0; k < target.vertices.size(); ++k) {
        distances.set(target.vertices[k], target.nothing_mm[k]);
        counts.set(target.vertices[k], 1);
        scored.push_back(neutral.vertices_mm[target.vertices[k]]);
        if (target.in_zone[k]) zone.push_back(scored.back());
    }
    if (zone.empty()) return {};
    distances.add_up();
    counts.add_up();
    const auto off_zone = geometry::PointIndex(zone).nearest(scored);
    VertexMask still;
    for (std::size_t k = 0; k < target.vertices.size(); ++k) {
        const auto v = target.vertices[k];
        const double mean_mm = distances.around(v, box->rows, box->cols) / counts.around(v, box->rows, box->cols);
        still.push_back(target.nothing_mm[k] < still_within_mm && mean_mm < still_within_mm &&
                                off_zone[k].distance_mm >= off_zone_mm
                            ? 1
                            : 0);
    }
    return still;
}

std::unique_ptr<const Estimator> still_skin_estimator() { return std::make_unique<StillSkin>(); }

}  // namespace mimik::evaluation
