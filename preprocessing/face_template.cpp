#include "preprocessing/face_template.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "base/errors.h"
#include "geometry/surface_index.h"

namespace mimik::preprocessing {

using geometry::Point;
using geometry::QuadGrid;
using geometry::Triangle;

void FaceTemplateOptions::check() const {
    if (!(spacing_mm >= 0.5 && spacing_mm <= 10))
        throw InputError(fmt::format("spacing_mm is {}; give 0.5 to 10", spacing_mm));
}

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// The depth of the average face at any place, the same on both sides.
class SymmetricDepth {
public:
    explicit SymmetricDepth(const QuadGrid& grid) : grid_(grid) {
        x0_ = grid.vertices_mm.front().x();
        y0_ = grid.vertices_mm.front().y();
        dx_ = (grid.vertices_mm[grid.index(0, grid.cols - 1)].x() - x0_) / (grid.cols - 1);
        dy_ = (grid.vertices_mm[grid.index(grid.rows - 1, 0)].y() - y0_) / (grid.rows - 1);
        if (!(dx_ > 0 && dy_ > 0)) throw InputError("the average face has no surface; make the workspace again");
    }
    [[nodiscard]] std::optional<double> operator()(double x, double y) const {
        const auto here = one_side(x, y), there = one_side(-x, y);
        if (!here || !there) return std::nullopt;
        return 0.5 * (*here + *there);
    }
    [[nodiscard]] double half_width_mm() const { return std::max(std::abs(x0_), x0_ + dx_ * (grid_.cols - 1)); }
    [[nodiscard]] double lowest_mm() const { return y0_; }
    [[nodiscard]] double highest_mm() const { return y0_ + dy_ * (grid_.rows - 1); }

private:
    /// Bilinear in the cell, all of whose corners must be inside.
    [[nodiscard]] std::optional<double> one_side(double x, double y) const {
        const double column = (x - x0_) / dx_, row = (y - y0_) / dy_;
        if (!(column >= 0 && row >= 0 && column <= grid_.cols - 1 && row <= grid_.rows - 1)) return std::nullopt;
        const int c = std::min(static_cast<int>(column), grid_.cols - 2),
                  r = std::min(static_cast<int>(row), grid_.rows - 2);
        const double u = column - c, v = row - r;
        double depth = 0;
        for (int k = 0; k < 4; ++k) {
            const auto vertex = grid_.index(r + k / 2, c + k % 2);
            if (!grid_.inside(vertex)) return std::nullopt;
            depth += (k % 2 ? u : 1 - u) * (k / 2 ? v : 1 - v) * grid_.vertices_mm[vertex].z();
        }
        return depth;
    }

    const QuadGrid& grid_;
    double x0_, y0_, dx_, dy_;
};

/// Where the lips meet, seen from the front: a parabola on each side through the corner and the middle.
struct LipLine {
    double corner_x_mm, corner_y_mm, middle_y_mm;

    explicit LipLine(const geometry::Landmarks& marks) {
        const Point &left = marks.position_mm("mouth_corner_left"), &right = marks.position_mm("mouth_corner_right");
        corner_x_mm = 0.5 * (left.x() - right.x());
        corner_y_mm = 0.5 * (left.y() + right.y());
        middle_y_mm = 0.5 * (marks.position_mm("upper_lip_inner").y() + marks.position_mm("lower_lip_inner").y());
    }
    [[nodiscard]] double y_mm(double x_mm) const {
        const double aside = std::min(1.0, std::abs(x_mm) / corner_x_mm);
        return middle_y_mm + (corner_y_mm - middle_y_mm) * aside * aside;
    }
};

/// A square lattice with a vertex on the mid-line, whose rows are bent on to the lip line and cut there.
class TemplateBuilder {
public:
    TemplateBuilder(const AverageFace& average, double spacing_mm)
        : average_(average), depth_(average.grid), lips_(average.landmarks) {
        // Two columns stand at the corners of the mouth: the slit ends where the lips end.
        const double columns = std::max(2.0, std::round(lips_.corner_x_mm / spacing_mm));
        step_mm_ = lips_.corner_x_mm / columns;
        corner_column_ = static_cast<int>(columns);
        half_ = static_cast<int>(std::floor(depth_.half_width_mm() / step_mm_));
        rows_ = static_cast<int>(std::floor((depth_.highest_mm() - depth_.lowest_mm()) / step_mm_)) + 1;
    }

    FaceTemplate build() {
        choose_lip_rows();
        place_vertices();
        if (made_.surface.vertices_mm.empty())
            throw InputError("the average face has no surface; make the workspace again");
        add_triangles();
        drop_unused();
        check_lips();
        made_.surface.present.assign(made_.size(), 1);
        made_.surface.measured.assign(made_.size(), 1);
        made_.surface.landmarks = average_.landmarks;
        bind_landmarks();
        return std::move(made_);
    }

private:
    [[nodiscard]] double row_y(int row) const { return depth_.lowest_mm() + step_mm_ * row; }
    [[nodiscard]] std::size_t at(int row, int column) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(2 * half_ + 1) +
               static_cast<std::size_t>(column + half_);
    }
    [[nodiscard]] bool on_lips(int column) const { return std::abs(column) <= corner_column_; }

    /// From the middle outwards a row at most one away from the last, so that lattice edges join them.
    void choose_lip_rows() {
        lip_row_.assign(static_cast<std::size_t>(corner_column_) + 1, 0);
        for (int c = 0; c <= corner_column_; ++c) {
            auto row = static_cast<int>(std::lround((lips_.y_mm(c * step_mm_) - depth_.lowest_mm()) / step_mm_));
            if (c > 0) row = std::clamp(row, lip_row_[c - 1] - 1, lip_row_[c - 1] + 1);
            lip_row_[c] = row;
        }
    }
    [[nodiscard]] int lip_row(int column) const { return lip_row_[static_cast<std::size_t>(std::abs(column))]; }

    void place_vertices() {
        index_.assign(at(rows_, -half_), none);
        below_.assign(index_.size(), none);
        for (int row = 0; row < rows_; ++row)
            for (int column = -half_; column <= half_; ++column) {
                const double x = column * step_mm_;
                const bool lip = on_lips(column) && lip_row(column) == row;
                const double y = lip ? lips_.y_mm(x) : row_y(row);
                const auto z = depth_(x, y);
                if (!z) continue;
                index_[at(row, column)] = add(x, y, *z);
                if (lip && std::abs(column) < corner_column_) below_[at(row, column)] = add(x, y, *z);
            }
        made_.mirror.assign(made_.size(), 0);
        for (int row = 0; row < rows_; ++row)
            for (int column = -half_; column <= half_; ++column)
                for (const auto* lattice : {&index_, &below_})
                    if (const auto v = (*lattice)[at(row, column)]; v != none)
                        made_.mirror[v] = (*lattice)[at(row, -column)];
        for (int column = -corner_column_; column <= corner_column_; ++column) {
            const auto place = at(lip_row(column), column);
            if (index_[place] == none) continue;
            made_.upper_lip_line.push_back(index_[place]);
            made_.lower_lip_line.push_back(below_[place] == none ? index_[place] : below_[place]);
        }
    }
    std::uint32_t add(double x, double y, double z) {
        made_.surface.vertices_mm.emplace_back(x, y, z);
        return static_cast<std::uint32_t>(made_.size() - 1);
    }

    struct Corner {
        int row, column;
    };
    void add_triangle(std::array<Corner, 3> corners) {
        Triangle triangle;
        double x = 0, y = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            triangle[k] = index_[at(corners[k].row, corners[k].column)];
            if (triangle[k] == none) return;
            x += made_.surface.vertices_mm[triangle[k]].x() / 3;
            y += made_.surface.vertices_mm[triangle[k]].y() / 3;
        }
        if (y < lips_.y_mm(x))
            for (std::size_t k = 0; k < 3; ++k)
                if (const auto lower = below_[at(corners[k].row, corners[k].column)]; lower != none)
                    triangle[k] = lower;
        made_.surface.triangles.push_back(triangle);
    }

    /// Diagonals are mirrored at the mid-line; where the lip line climbs or falls a row, the diagonal goes along it.
    void add_triangles() {
        for (int row = 0; row + 1 < rows_; ++row)
            for (int column = -half_; column < half_; ++column) {
                bool rising = column < 0;
                if (on_lips(column) && on_lips(column + 1)) {
                    const int here = lip_row(column), next = lip_row(column + 1);
                    if (std::min(here, next) == row && here != next) rising = next > here;
                }
                const Corner a{row, column}, b{row, column + 1}, c{row + 1, column + 1}, d{row + 1, column};
                if (rising) {
                    add_triangle({a, b, c});
                    add_triangle({a, c, d});
                } else {
                    add_triangle({a, b, d});
                    add_triangle({b, c, d});
                }
            }
    }

    /// Vertices of no triangle go: they are no surface.
    void drop_unused() {
        std::vector<std::uint32_t> renamed(made_.size(), none);
        for (const auto& triangle : made_.surface.triangles)
            for (const auto corner : triangle) renamed[corner] = 0;
        std::vector<Point> kept;
        std::vector<std::uint32_t> old;
        for (std::uint32_t v = 0; v < renamed.size(); ++v)
            if (renamed[v] == 0) {
                renamed[v] = static_cast<std::uint32_t>(kept.size());
                kept.push_back(made_.surface.vertices_mm[v]);
                old.push_back(v);
            }
        std::vector<std::uint32_t> mirror;
        for (const auto v : old) {
            const auto other = renamed[made_.mirror[v]];
            mirror.push_back(other == none ? static_cast<std::uint32_t>(mirror.size()) : other);
        }
        made_.mirror = std::move(mirror);
        made_.surface.vertices_mm = std::move(kept);
        for (auto& triangle : made_.surface.triangles)
            for (auto& corner : triangle) corner = renamed[corner];
        for (auto* line : {&made_.upper_lip_line, &made_.lower_lip_line})
            for (auto& v : *line) v = renamed[v];
    }

    void check_lips() const {
        const auto lost = [](std::uint32_t v) { return v == none; };
        for (const auto* line : {&made_.upper_lip_line, &made_.lower_lip_line})
            if (line->size() != static_cast<std::size_t>(2 * corner_column_ + 1) ||
                std::any_of(line->begin(), line->end(), lost))
                throw InputError(
                    "the average face has no surface between the corners of the mouth, so no template can be cut "
                    "there; "
                    "make the workspace again with scans that show the mouth");
    }

    void bind_landmarks() {
        constexpr double off_mm = 5.0;  // a landmark of the average face that the template does not reach
        const geometry::SurfaceIndex index(made_.surface.vertices_mm, made_.surface.triangles);
        for (const auto& mark : average_.landmarks.all()) {
            const auto middle = made_.upper_lip_line.size() / 2;
            if (mark.name == "upper_lip_inner" || mark.name == "lower_lip_inner") {
                const auto v = (mark.name == "upper_lip_inner" ? made_.upper_lip_line : made_.lower_lip_line)[middle];
                made_.landmarks.push_back({mark.name, {v, v, v}, Eigen::Vector3d::UnitX()});
                continue;
            }
            const auto hit = index.closest(mark.position_mm);
            if (hit.distance_mm > off_mm) continue;
            made_.landmarks.push_back({mark.name, made_.surface.triangles[hit.triangle], hit.barycentric});
        }
    }

    const AverageFace& average_;
    SymmetricDepth depth_;
    LipLine lips_;
    double step_mm_ = 0;
    int corner_column_ = 0, half_ = 0, rows_ = 0;
    std::vector<int> lip_row_;                  // by |column|
    std::vector<std::uint32_t> index_, below_;  // of the lattice: vertex; that of the lower lip where it is cut
    FaceTemplate made_;
};

}  // namespace

FaceTemplate build_face_template(const AverageFace& average, const FaceTemplateOptions& options) {
    options.check();
    return TemplateBuilder(average, options.spacing_mm).build();
}

namespace {

constexpr double lip_reach_mm = 12.0;

/// How far above the cut between the lips a place is, seen from the front; empty beside the mouth.
std::optional<double> above_lip_line_mm(const FaceTemplate& face_template, double x_mm, double y_mm) {
    const auto& vertices = face_template.surface.vertices_mm;
    const auto& line = face_template.upper_lip_line;  // ascending in x
    const auto right = std::upper_bound(line.begin(), line.end(), x_mm,
                                        [&](double x, std::uint32_t v) { return x < vertices[v].x(); });
    if (right == line.begin() || right == line.end()) return std::nullopt;
    const Point &a = vertices[*(right - 1)], &b = vertices[*right];
    return y_mm - a.y() - (b.y() - a.y()) * (x_mm - a.x()) / std::max(b.x() - a.x(), 1e-9);
}

}  // namespace

std::vector<LipSide> lip_sides(const FaceTemplate& face_template) {
    const auto& vertices = face_template.surface.vertices_mm;
    std::vector<LipSide> sides;
    for (const auto& t : face_template.surface.triangles) {
        const Point middle = (vertices[t[0]] + vertices[t[1]] + vertices[t[2]]) / 3;
        const auto above_mm = above_lip_line_mm(face_template, middle.x(), middle.y());
        sides.push_back(!above_mm || std::abs(*above_mm) > lip_reach_mm ? LipSide::neither
                        : *above_mm > 0                                 ? LipSide::upper
                                                                        : LipSide::lower);
    }
    return sides;
}

std::vector<double> lip_shares(const FaceTemplate& face_template) {
    const auto& [surface, mirror, upper_line, lower_line, landmarks] = face_template;
    const auto sides = lip_sides(face_template);
    std::vector<double> shares(surface.size(), 0.0);
    std::vector<std::uint8_t> touches(surface.size(), 0);  // 1: a triangle of the upper lip, 2: of the lower
    for (std::size_t t = 0; t < sides.size(); ++t)
        for (const auto v : surface.triangles[t])
            touches[v] |= sides[t] == LipSide::upper ? 1 : sides[t] == LipSide::lower ? 2 : 0;
    for (std::size_t v = 0; v < shares.size(); ++v) {
        if (touches[v] != 1 && touches[v] != 2) continue;
        const auto& p = surface.vertices_mm[v];
        const double off_mm = std::abs(above_lip_line_mm(face_template, p.x(), p.y()).value_or(lip_reach_mm));
        const double t = std::max(0.0, 1.0 - off_mm / lip_reach_mm);
        shares[v] = (touches[v] == 1 ? 1.0 : -1.0) * t * t * (3 - 2 * t);
    }
    return shares;
}

Point position_mm(const BoundLandmark& landmark, std::span<const Point> vertices_mm) {
    Point position = Point::Zero();
    for (std::size_t k = 0; k < 3; ++k)
        position += landmark.weights[static_cast<Eigen::Index>(k)] * vertices_mm[landmark.corners[k]];
    return position;
}

}  // namespace mimik::preprocessing
