#include "animation/part_masks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "animation/dense_field.h"
#include "animation/lid_field.h"
#include "animation/mesh_lips.h"
#include "base/errors.h"
#include "capture/control_surface.h"

namespace mimik::animation {

using geometry::Point;
using preprocessing::LipSide;

void PartMaskOptions::check() const {
    for (const auto& [name, value] : {std::pair{"columns", columns}, std::pair{"rows", rows}})
        if (value < 16 || value > 8192) throw InputError(fmt::format("{} is {}; give 16 to 8192", name, value));
}

namespace {

constexpr double half_turn = std::numbers::pi / 2;

/// The lids of one eye on the template: above the line between its corners, or below it; fading with the distance from
/// the eye's middle, in eye widths.
struct EyeLine {
    Point inner, outer;
    [[nodiscard]] float share(const Point& p) const {
        constexpr double reach_across = 0.75, reach_up = 0.7;  // of the eye's width: up to the brow, down to the cheek
        const Eigen::Vector2d along = (outer - inner).head<2>(), from = (p - inner).head<2>();
        const double width = along.norm();
        const Eigen::Vector2d axis = along / width;
        const double across = from.dot(axis) / width - 0.5;
        double up = (axis.x() * from.y() - axis.y() * from.x()) / width;
        if (outer.x() < inner.x()) up = -up;  // the subject's right eye runs the other way
        const double reach = std::hypot(across / reach_across, up / reach_up);
        if (reach >= 1) return 0;
        return static_cast<float>(up >= 0 ? 1 - reach : reach - 1);
    }
};

std::optional<EyeLine> eye_line(const geometry::Landmarks& marks, const char* side) {
    const auto* inner = marks.find(std::string("eye_inner_") + side);
    const auto* outer = marks.find(std::string("eye_outer_") + side);
    if (!inner || !outer) return std::nullopt;
    return EyeLine{inner->position_mm, outer->position_mm};
}

float share_of(const PartShares& shares, const std::string& opening) {
    if (opening == "mouth") return shares.mouth;
    if (opening == "eye_left") return shares.eye_left;
    if (opening == "eye_right") return shares.eye_right;
    return 0;
}

}  // namespace

std::vector<PartShares> template_part_shares(const preprocessing::FaceTemplate& face_template) {
    const auto& surface = face_template.surface;
    const auto lips = preprocessing::lip_shares(face_template);
    const auto left = eye_line(surface.landmarks, "left"), right = eye_line(surface.landmarks, "right");
    std::vector<PartShares> shares(surface.size());
    for (std::size_t v = 0; v < shares.size(); ++v) {
        shares[v].mouth = static_cast<float>(lips[v]);
        if (left) shares[v].eye_left = left->share(surface.vertices_mm[v]);
        if (right) shares[v].eye_right = right->share(surface.vertices_mm[v]);
    }
    return shares;
}

PartTexture::PartTexture(const preprocessing::FaceTemplate& face_template, std::span<const PartShares> shares,
                         std::span<const Point> bent_mm, const PartMaskOptions& options)
    : columns_(options.columns), rows_(options.rows) {
    options.check();
    if (shares.size() != bent_mm.size() || shares.size() != face_template.size())
        throw InputError("part texture: shares and vertices are not as many as the template's");
    // The axis lies behind all of the template, so that each of its points has one angle.
    bottom_mm_ = axis_z_mm_ = std::numeric_limits<double>::infinity();
    top_mm_ = -bottom_mm_;
    for (const auto& p : bent_mm) {
        bottom_mm_ = std::min(bottom_mm_, p.y());
        top_mm_ = std::max(top_mm_, p.y());
        axis_z_mm_ = std::min(axis_z_mm_, p.z());
    }
    texels_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), {});
    std::vector<float> depth(texels_.size(), -1);
    for (const auto& triangle : face_template.surface.triangles)
        draw({bent_mm[triangle[0]], bent_mm[triangle[1]], bent_mm[triangle[2]]},
             {shares[triangle[0]], shares[triangle[1]], shares[triangle[2]]}, depth);
    fill_openings(depth);
}

/// Lips that stand apart and eyes leave a gap in the picture, and what lies in it belongs to its nearer border.
void PartTexture::fill_openings(std::span<const float> depth) {
    const auto place = [&](int column, int row) {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    };
    for (int column = 0; column < columns_; ++column) {
        int last = -1;  // row that was drawn
        for (int row = 0; row < rows_; ++row) {
            if (depth[place(column, row)] < 0) continue;
            for (int gap = last + 1; last >= 0 && gap < row; ++gap)
                texels_[place(column, gap)] = texels_[place(column, gap - last <= row - gap ? last : row)];
            last = row;
        }
    }
}

double PartTexture::column_of(const Point& p) const {
    return (std::atan2(p.x(), p.z() - axis_z_mm_) / half_turn + 1) / 2 * columns_;
}
double PartTexture::row_of(const Point& p) const { return (p.y() - bottom_mm_) / (top_mm_ - bottom_mm_) * rows_; }

void PartTexture::draw(const std::array<Point, 3>& corners, const std::array<PartShares, 3>& shares,
                       std::vector<float>& depth) {
    std::array<Eigen::Vector2d, 3> at;
    std::array<double, 3> out{};
    for (std::size_t c = 0; c < 3; ++c) {
        at[c] = {column_of(corners[c]), row_of(corners[c])};
        out[c] = std::hypot(corners[c].x(), corners[c].z() - axis_z_mm_);
    }
    const Eigen::Vector2d u = at[1] - at[0], v = at[2] - at[0];
    const double area = u.x() * v.y() - u.y() * v.x();
    if (std::abs(area) < 1e-12) return;
    const auto range = [&](int axis, int most) {
        const auto [low, high] = std::minmax({at[0][axis], at[1][axis], at[2][axis]});
        return std::pair(std::clamp(static_cast<int>(std::floor(low)), 0, most - 1),
                         std::clamp(static_cast<int>(std::ceil(high)), 0, most - 1));
    };
    const auto columns = range(0, columns_), rows = range(1, rows_);
    constexpr double slack = -1e-9;  // texels on an edge are drawn by both triangles; the outer one stays
    for (int row = rows.first; row <= rows.second; ++row)
        for (int column = columns.first; column <= columns.second; ++column) {
            const Eigen::Vector2d from = Eigen::Vector2d(column + 0.5, row + 0.5) - at[0];
            const double b = (from.x() * v.y() - from.y() * v.x()) / area;
            const double c = (u.x() * from.y() - u.y() * from.x()) / area, a = 1 - b - c;
            if (a < slack || b < slack || c < slack) continue;
            const auto k =
                static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
            const auto radius = static_cast<float>(a * out[0] + b * out[1] + c * out[2]);
            if (radius <= depth[k]) continue;
            depth[k] = radius;
            const auto mix = [&](float PartShares::*of) {
                return static_cast<float>(a * shares[0].*of + b * shares[1].*of + c * shares[2].*of);
            };
            texels_[k] = {mix(&PartShares::mouth), mix(&PartShares::eye_left), mix(&PartShares::eye_right)};
        }
}

PartShares PartTexture::at(const Point& position_mm) const {
    const double column = std::floor(column_of(position_mm)), row = std::floor(row_of(position_mm));
    if (!(column >= 0 && column < columns_ && row >= 0 && row < rows_)) return {};
    return texel(static_cast<int>(column), static_cast<int>(row));
}

std::vector<std::uint32_t> vertex_parts(const PreparedTarget& target,
                                        const std::shared_ptr<const preprocessing::KeptRegistrations>& registrations,
                                        const capture::MarkerSet& set, const PartMaskOptions& options) {
    const auto& face_template = registrations->face_template();
    const PartTexture texture(face_template, template_part_shares(face_template), template_on(target, registrations),
                              options);
    const auto& surface = target.surface();
    const auto& vertices = target.normalised(modeling::Normalisation::similarity).vertices_mm;
    std::vector<PartShares> shares(surface.size());
    std::vector<double> of_mouth(surface.size(), 0.0);
    for (std::size_t v = 0; v < surface.size(); ++v) {
        if (!surface.present[v]) continue;
        shares[v] = texture.at(vertices[v]);
        of_mouth[v] = shares[v].mouth;
    }
    // Lips that touch are a texel apart, along the mesh they are not.
    const auto lips = lip_sides_along(vertices, surface.triangles, of_mouth);
    const auto lids = lid_sheets(target);
    std::uint32_t all = 0;
    for (std::size_t k = 0; k < set.openings.size(); ++k)
        all |= capture::part_bit(k, true) | capture::part_bit(k, false);
    if (set.openings.empty()) all = 1;
    std::vector<std::uint32_t> parts(surface.size(), all);
    for (std::size_t v = 0; v < surface.size(); ++v) {
        if (v < lids.size() && lids[v] == LidSheet::eyeball) {
            parts[v] = 0;
            continue;
        }
        for (std::size_t k = 0; k < set.openings.size(); ++k) {
            const auto& name = set.openings[k].name;
            const float share = share_of(shares[v], name);
            if (share == 0) continue;
            bool above = share > 0;
            if (name == "mouth" && lips[v] != LipSide::neither) above = lips[v] == LipSide::upper;
            if (name != "mouth" && v < lids.size() && lids[v] != LidSheet::neither) above = lids[v] == LidSheet::upper;
            parts[v] = capture::part_bit(k, above);
        }
    }
    return parts;
}

}  // namespace mimik::animation
