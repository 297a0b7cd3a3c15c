#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "database/truth.h"
#include "facs/facs_catalogue.h"
#include "geometry/types.h"
#include "geometry/vertex_mask.h"
#include "preprocessing/average_face.h"
#include "preprocessing/face.h"

namespace mimik::evaluation {

/// From what zones are made: where a truth says that skin moved, where the scans show it, or where the built-in
/// catalogue draws (never another: shipped_active_zone).
/// `automatic` is the truth where there is one, else the data.
enum class ZoneSource : std::uint8_t { automatic, truth, data, catalogue };
[[nodiscard]] constexpr const char* to_string(ZoneSource source) {
    switch (source) {
        case ZoneSource::truth:
            return "truth";
        case ZoneSource::data:
            return "data";
        case ZoneSource::catalogue:
            return "catalogue";
        case ZoneSource::automatic:
            break;
    }
    return "automatic";
}

/// Where an expression moves the skin, on the average face: the part of a face on which methods are compared.
struct ActiveZone {
    facs::Expression expression;
    geometry::VertexMask active;          ///< per vertex of the average face's grid
    std::vector<double> displacement_mm;  ///< mean over subjects, from a truth or the data; else empty
};

/// Where an expression really moved one subject's skin: one vector per vertex of the average face's grid, its frame.
/// @param true_field_mm  of the true surface's vertices, head frame, from the neutral scan.
[[nodiscard]] std::vector<geometry::Vector> true_motion_on_average(const preprocessing::AverageFace& average,
                                                                   const preprocessing::Face& neutral,
                                                                   const database::TrueScan& true_neutral,
                                                                   std::span<const geometry::Vector> true_field_mm);

/// The zone from motions, subject after subject: active where the length of their mean motion exceeds a share of its
/// maximum on the average face. Holds the sum alone.
class MotionZone {
public:
    /// Keeps a reference.
    explicit MotionZone(const preprocessing::AverageFace& average);
    void add(std::span<const geometry::Vector> motion_mm);  ///< true_motion_on_average(), or MotionOnAverage::of()
    [[nodiscard]] std::size_t subjects() const { return subjects_; }
    [[nodiscard]] double largest_mm() const;  ///< length of the mean motion where it is largest; 0 of no subject
    /// @throws InputError if no subject was added.
    [[nodiscard]] ActiveZone zone(const facs::Expression& expression, double share = 0.2) const;

private:
    const preprocessing::AverageFace& average_;
    std::vector<geometry::Vector> sum_;
    std::size_t subjects_ = 0;
};

/// The same region as it ships with Mimik: the zones of the built-in catalogue, whatever the data show and whatever
/// other catalogue methods are learned by. Whoever draws the points must not draw where they are judged. The whole
/// face, of an expression with a unit that has no shipped zone.
[[nodiscard]] ActiveZone shipped_active_zone(const facs::Expression& expression,
                                             const preprocessing::AverageFace& average);

/// Adds what is active in the other zone. The displacement stays the first one's own.
void unite(ActiveZone& zone, const ActiveZone& other);

/// The zone on a face's own grid: every vertex goes to the average face by the landmark spline and takes what the
/// nearest average vertex has. Vertices outside the face, or farther than 5 mm off the average face's rim, are not
/// active.
[[nodiscard]] geometry::VertexMask carry_zone(const ActiveZone& zone, const preprocessing::AverageFace& average,
                                              const preprocessing::Face& face);

/// Landmark spline (kernel r) from the average face to a face, both in their own frames.
[[nodiscard]] std::vector<geometry::Point> average_vertices_on(const preprocessing::AverageFace& average,
                                                               const preprocessing::Face& face);

}  // namespace mimik::evaluation
