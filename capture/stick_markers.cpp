#include "capture/stick_markers.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "geometry/face_axes.h"
#include "geometry/topology.h"

namespace mimik::capture {

using geometry::Point;
using geometry::SurfacePoint;
using geometry::Triangle;
using geometry::Vector;

namespace {

/// How far before and behind its place the skin of a marker may be, in outer-eye distances: the bridge of a nose is
/// 0.1 before the middle of its saddles.
constexpr double reach = 0.15;

bool is_landmark(const facs::Placement& placement) {
    return placement.at.size() == 1 && placement.lateral == 0 && placement.up == 0;
}

bool on_lid(const MarkerSet& set, const std::string& name) {
    return std::any_of(set.openings.begin(), set.openings.end(), [&](const MarkerOpening& opening) {
        const auto has = [&](const std::vector<std::string>& all) {
            return std::find(all.begin(), all.end(), name) != all.end();
        };
        return opening.name.starts_with("eye") && (has(opening.upper) || has(opening.lower));
    });
}

/// What is seen of a place from the front; the nearest point where that is nothing.
SurfacePoint seen_from_front(const geometry::SurfaceIndex& skin, const Point& place, double reach_mm) {
    SurfacePoint hit;
    if (skin.first_hit(place + reach_mm * Vector::UnitZ(), -Vector::UnitZ(), hit) &&
        std::abs(hit.position_mm.z() - place.z()) <= reach_mm) {
        hit.distance_mm = (hit.position_mm - place).norm();
        return hit;
    }
    return skin.closest(place);
}

/// The skin of a mesh whose eyeballs, teeth and lashes are parts of their own: what hangs together with the nose.
class Skin {
public:
    Skin(const geometry::SurfaceIndex& surface, const geometry::Landmarks& face) : surface_(surface) {
        const auto part = geometry::connected_parts(surface.vertices_mm(), surface.triangles());
        const auto* tip = face.find("nose_tip");
        if (!tip) return;
        const auto all = surface.triangles();
        const auto own = part[all[surface.closest(tip->position_mm).triangle][0]];
        for (std::uint32_t t = 0; t < all.size(); ++t)
            if (part[all[t][0]] == own) triangles_.push_back(t);
    }

    /// The visible point of it that is nearest as seen from the front: above an eye the margin of the lid, where the
    /// place itself lies before the eyeball.
    [[nodiscard]] std::optional<SurfacePoint> nearest_seen(const Point& place, double reach_mm) const {
        const auto at = surface_.vertices_mm();
        std::vector<Point> flat(at.begin(), at.end());
        for (auto& p : flat) p.z() = 0;
        const Point from(place.x(), place.y(), 0);
        std::vector<Triangle> seen;
        std::vector<std::uint32_t> own;
        for (const auto t : triangles_) {
            const auto& corners = surface_.triangles()[t];
            const Point middle = (at[corners[0]] + at[corners[1]] + at[corners[2]]) / 3;
            if ((Point(middle.x(), middle.y(), 0) - from).norm() > 2 * reach_mm) continue;
            SurfacePoint hit;
            constexpr double hidden_mm = 0.2;  // a ray beside an edge may hit the neighbour
            if (std::abs(middle.z() - place.z()) > reach_mm ||
                (surface_.first_hit(middle + 2 * reach_mm * Vector::UnitZ(), -Vector::UnitZ(), hit) &&
                 hit.position_mm.z() > middle.z() + hidden_mm))
                continue;
            seen.push_back(corners);
            own.push_back(t);
        }
        if (seen.empty()) return std::nullopt;
        auto point = geometry::SurfaceIndex(flat, seen).closest(from);
        if (point.distance_mm > reach_mm) return std::nullopt;
        point.triangle = own[point.triangle];
        point.position_mm.setZero();
        for (std::size_t c = 0; c < 3; ++c)
            point.position_mm +=
                point.barycentric[static_cast<Eigen::Index>(c)] * at[surface_.triangles()[point.triangle][c]];
        point.distance_mm = (point.position_mm - place).norm();
        return point;
    }

private:
    const geometry::SurfaceIndex& surface_;
    std::vector<std::uint32_t> triangles_;
};

}  // namespace

geometry::Landmarks StuckMarkers::landmarks() const {
    std::vector<geometry::Landmark> list;
    for (std::size_t k = 0; k < names.size(); ++k) list.push_back({names[k], places[k].position_mm, ""});
    return geometry::Landmarks(std::move(list));
}

StuckMarkers stick_markers(const MarkerSet& set, const geometry::Landmarks& face, const geometry::SurfaceIndex& skin) {
    const auto near = place_markers(set, face);
    const double reach_mm = reach * geometry::outer_eye_distance_mm(face);
    const Skin own(skin, face);
    StuckMarkers stuck;
    for (const auto& mark : near.all()) {
        const auto* marker = set.find(mark.name);
        const bool between = marker && !is_landmark(marker->placement);
        const bool lid = between && on_lid(set, mark.name);
        const bool middle = between && marker->side == facs::Side::both;
        const auto seen = lid ? own.nearest_seen(mark.position_mm, reach_mm) : std::nullopt;
        stuck.names.push_back(mark.name);
        stuck.places.push_back(seen            ? *seen
                               : lid || middle ? seen_from_front(skin, mark.position_mm, reach_mm)
                                               : skin.closest(mark.position_mm));
    }
    return stuck;
}

}  // namespace mimik::capture
