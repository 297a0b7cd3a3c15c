#include "animation/prepared_target.h"

#include <limits>

#include <fmt/format.h>

#include "base/errors.h"
#include "preprocessing/normalisation.h"

namespace mimik::animation {

using geometry::Landmarks;
using geometry::Point;
using modeling::Normalisation;

namespace {

/// Every landmark at the nearest present vertex.
Landmarks snapped(const geometry::FaceSurface& surface) {
    std::vector<geometry::Landmark> marks(surface.landmarks.all().begin(), surface.landmarks.all().end());
    for (auto& mark : marks) {
        double best = std::numeric_limits<double>::infinity();
        Point nearest = mark.position_mm;
        for (std::size_t v = 0; v < surface.size(); ++v)
            if (const double d = (surface.vertices_mm[v] - mark.position_mm).squaredNorm();
                surface.present[v] && d < best) {
                best = d;
                nearest = surface.vertices_mm[v];
            }
        mark.position_mm = nearest;
    }
    return Landmarks(std::move(marks));
}

}  // namespace

geometry::Vector MaterialPoints::at(const std::vector<geometry::Vector>& field_mm, std::size_t v) const {
    geometry::Vector value = geometry::Vector::Zero();
    for (std::size_t c = 0; c < 3; ++c)
        value += barycentric[v][static_cast<Eigen::Index>(c)] * field_mm[triangles[v][c]];
    return target_from_head * value;
}

struct PreparedTarget::Parts {
    std::string name;
    geometry::FaceSurface surface;
    Landmarks snapped_landmarks;
    std::array<std::optional<geometry::Transform>, 2> average_from_target;  // by Normalisation
    std::string no_affine;                                                  // why there is none
    const database::TrueScan* truth = nullptr;

    std::array<std::once_flag, 2> normalising;
    std::array<std::optional<NormalisedTarget>, 2> normalised;
    std::once_flag locating;
    std::optional<MaterialPoints> material;

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
        const geometry::SurfaceIndex true_surface(truth->vertices_mm, geometry::triangulate(truth->faces));
        const auto triangles = true_surface.triangles();
        std::vector<Point> queries;
        for (std::size_t v = 0; v < surface.size(); ++v)
            if (surface.present[v]) queries.push_back(surface.vertices_mm[v]);
        const auto hits = true_surface.closest(queries);
        MaterialPoints points{{}, {}, truth->scanner_from_head.linear()};
        std::size_t k = 0;
        for (std::size_t v = 0; v < surface.size(); ++v) {
            const bool present = surface.present[v] != 0;
            points.triangles.push_back(present ? triangles[hits[k].triangle] : geometry::Triangle{0, 0, 0});
            points.barycentric.push_back(present ? hits[k].barycentric : Eigen::Vector3d(Eigen::Vector3d::Zero()));
            k += present ? 1 : 0;
        }
        return points;
    }
};

PreparedTarget::PreparedTarget(const preprocessing::Face& neutral, const database::TrueScan* truth)
    : parts_(std::make_unique<Parts>()) {
    parts_->name = neutral.id.subject.empty() ? "the average face" : neutral.id.name();
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
const geometry::FaceSurface& PreparedTarget::surface() const { return parts_->surface; }
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

Point nearest_vertex(const PreparedTarget& target, const NormalisedTarget& normalised, const Point& query_mm) {
    // One answer is asked for per control point: looking at every vertex costs less than building a tree.
    double best = std::numeric_limits<double>::infinity();
    std::size_t nearest = 0;
    for (std::size_t v = 0; v < normalised.vertices_mm.size(); ++v) {
        if (!target.surface().present[v]) continue;
        const double d = (normalised.vertices_mm[v] - query_mm).squaredNorm();
        if (d < best) {
            best = d;
            nearest = v;
        }
    }
    return normalised.vertices_mm[nearest];
}

}  // namespace mimik::animation
