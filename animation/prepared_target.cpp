#include "animation/prepared_target.h"

#include <map>

#include <fmt/format.h>

#include "base/errors.h"
#include "geometry/point_index.h"
#include "preprocessing/normalisation.h"

namespace mimik::animation {

using geometry::Landmarks;
using geometry::Point;
using modeling::Normalisation;

namespace {

/// @param vertices_mm  of the surface, in the frame of the query
std::optional<std::size_t> nearest_present(const geometry::FaceSurface& surface, std::span<const Point> vertices_mm,
                                           const Point& query_mm) {
    return geometry::nearest_point(vertices_mm, query_mm, [&](std::size_t v) { return surface.present[v] != 0; });
}

/// Every landmark at the nearest present vertex.
Landmarks snapped(const geometry::FaceSurface& surface) {
    std::vector<geometry::Landmark> marks(surface.landmarks.all().begin(), surface.landmarks.all().end());
    for (auto& mark : marks)
        if (const auto v = nearest_present(surface, surface.vertices_mm, mark.position_mm))
            mark.position_mm = surface.vertices_mm[*v];
    return Landmarks(std::move(marks));
}

}  // namespace

geometry::Vector MaterialPoints::at(const std::vector<geometry::Vector>& field_mm, std::size_t v) const {
    if (!place[v]) return geometry::Vector::Zero();
    return target_from_head * on_truth.at(field_mm, *place[v]);
}

struct PreparedTarget::Parts {
    std::string name;
    std::optional<preprocessing::Face> face;
    geometry::FaceSurface surface;
    Landmarks snapped_landmarks;
    std::array<std::optional<geometry::Transform>, 2> average_from_target;  // by Normalisation
    std::string no_affine;                                                  // why there is none
    const database::TrueScan* truth = nullptr;

    std::array<std::once_flag, 2> normalising;
    std::array<std::optional<NormalisedTarget>, 2> normalised;
    std::once_flag locating;
    std::optional<MaterialPoints> material;
    std::mutex keeping;
    std::map<std::shared_ptr<const void>, std::shared_ptr<const void>> kept;  // by owner

    [[nodiscard]] const geometry::Transform& to_average_by(Normalisation normalisation) const {
        const auto& to_average = average_from_target[static_cast<std::size_t>(normalisation)];
        if (!to_average) throw InputError(fmt::format("{}: Eqs 5.1-5.4: {}", name, no_affine));
        return *to_average;
    }

    [[nodiscard]] NormalisedTarget normalise(Normalisation normalisation) const {
        const auto& to_average = to_average_by(normalisation);
        std::vector<Point> vertices;
        vertices.reserve(surface.size());
        for (const auto& vertex : surface.vertices_mm) vertices.emplace_back(to_average * vertex);
        geometry::SurfaceIndex index(vertices, surface.triangles);
        return {to_average, geometry::transformed(surface.landmarks, to_average),
                geometry::transformed(snapped_landmarks, to_average), std::move(vertices), std::move(index)};
    }

    [[nodiscard]] MaterialPoints locate() const {
        MaterialPoints points{{}, {}, truth->scanner_from_head.linear()};
        std::vector<Point> queries;
        for (std::size_t v = 0; v < surface.size(); ++v) {
            points.place.push_back(surface.present[v] ? std::optional(queries.size()) : std::nullopt);
            if (surface.present[v]) queries.push_back(surface.vertices_mm[v]);
        }
        points.on_truth = database::material_points(*truth, queries);
        return points;
    }
};

PreparedTarget::PreparedTarget(const preprocessing::Face& neutral, const database::TrueScan* truth)
    : parts_(std::make_unique<Parts>()) {
    parts_->name = neutral.id.subject.empty() ? "the average face" : neutral.id.name();
    parts_->face = neutral;
    parts_->surface = geometry::face_surface(neutral.grid, neutral.landmarks);
    parts_->snapped_landmarks = neutral.snapped_landmarks;
    parts_->average_from_target = {modeling::average_from_scan(neutral, Normalisation::similarity),
                                   modeling::average_from_scan(neutral, Normalisation::affine)};
    parts_->truth = truth;
}

PreparedTarget::PreparedTarget(geometry::FaceSurface neutral, const preprocessing::AverageFace& average,
                               std::string name)
    : parts_(std::make_unique<Parts>()) {
    parts_->name = std::move(name);
    parts_->surface = std::move(neutral);
    parts_->snapped_landmarks = snapped(parts_->surface);
    parts_->average_from_target[0] =
        preprocessing::similarity_normalisation(parts_->surface.landmarks, average.landmarks);
    try {
        parts_->average_from_target[1] =
            preprocessing::affine_normalisation(parts_->snapped_landmarks, average.landmarks);
    } catch (const std::exception& e) {  // a reason against the thesis's frame alone
        parts_->no_affine = e.what();
    }
}

PreparedTarget::~PreparedTarget() = default;
PreparedTarget::PreparedTarget(PreparedTarget&&) noexcept = default;

const std::string& PreparedTarget::name() const { return parts_->name; }
const preprocessing::Face* PreparedTarget::face() const { return parts_->face ? &*parts_->face : nullptr; }
const geometry::FaceSurface& PreparedTarget::surface() const { return parts_->surface; }
const database::TrueScan* PreparedTarget::truth() const { return parts_->truth; }
bool PreparedTarget::has_truth() const { return parts_->truth != nullptr; }

const geometry::Transform& PreparedTarget::average_from_target(Normalisation normalisation) const {
    return parts_->to_average_by(normalisation);
}

const NormalisedTarget& PreparedTarget::normalised(Normalisation normalisation) const {
    const auto k = static_cast<std::size_t>(normalisation);
    std::call_once(parts_->normalising[k], [&] { parts_->normalised[k].emplace(parts_->normalise(normalisation)); });
    return *parts_->normalised[k];
}

const MaterialPoints& PreparedTarget::material_points() const {
    if (!parts_->truth)
        throw InputError(
            fmt::format("{}: its true surface is not known; take a database of 'mimik synthesize'", name()));
    std::call_once(parts_->locating, [&] { parts_->material.emplace(parts_->locate()); });
    return *parts_->material;
}

std::shared_ptr<const void> PreparedTarget::kept(const std::shared_ptr<const void>& owner,
                                                 const std::function<std::shared_ptr<const void>()>& make) const {
    const std::scoped_lock lock(parts_->keeping);
    auto& kept = parts_->kept[owner];
    if (!kept) kept = make();
    return kept;
}

Point nearest_vertex(const PreparedTarget& target, const NormalisedTarget& normalised, const Point& query_mm) {
    const auto& vertices_mm = normalised.vertices_mm;
    return vertices_mm[nearest_present(target.surface(), vertices_mm, query_mm).value_or(0)];
}

}  // namespace mimik::animation
