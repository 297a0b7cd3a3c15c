#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/scored_target.h"
#include "geometry/face_surface.h"

namespace mimik::evaluation {

/// What is judged: a motion of a target's neutral face.
struct JudgedFace {
    const ScoredTarget& target;
    const geometry::FaceSurface& neutral;
    const geometry::DisplacementField& field;  ///< scanner frame; where it has no answer, it is scored as doing nothing
    bool made_by_method = true;                ///< it is neither the truth's nor that of doing nothing

    /// Where the field takes vertex v, from where it is; zero where it has no answer.
    [[nodiscard]] geometry::Vector way_mm(std::uint32_t v) const;
};

/// One number that an estimator found.
struct Measure {
    std::string region;           ///< "zone", "face", "mouth"
    std::string metric;           ///< "mean", ...
    std::optional<double> value;  ///< empty: not known
    std::string unit;
};

/// One way to say how true a face is. What is not known of a face has no measure.
class Estimator {
public:
    virtual ~Estimator() = default;
    [[nodiscard]] virtual std::string name() const = 0;
    /// From any thread. @throws NumericalError if no scored vertex is in the zone: 0 mm against 0 mm is no score.
    [[nodiscard]] virtual std::vector<Measure> measure(const JudgedFace& face) const = 0;
};

/// "surface_distance": mean distance of the vertices to the real expressive scan, in the zone and on the whole face.
/// "true_distance": mean 3D distance to the true position of the same skin point, in the zone; nothing without a truth.
/// "field": vertices without an answer; of what a method made, the largest crack between neighbouring vertices.
/// "lip_aperture", "still_skin", "peak", "over_hole": what those distances hardly see; each has a header of its own.
[[nodiscard]] const std::vector<std::unique_ptr<const Estimator>>& known_estimators();

/// What "surface_distance" measures, as plain numbers.
struct SurfaceDistances {
    double zone_mm = 0.0;
    std::optional<double> face_mm;  ///< if the target is scored as a whole
};
[[nodiscard]] SurfaceDistances distances_to_real_scan(const JudgedFace& face);

}  // namespace mimik::evaluation
