#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "animation/facial_examples.h"
#include "base/fields.h"
#include "geometry/types.h"

namespace mimik::animation {

/// A curve through points of a face, one after another: a Catmull-Rom spline as a chain of short lines. A single point
/// is a curve, too.
class WireCurve {
public:
    WireCurve() = default;
    explicit WireCurve(std::span<const geometry::Point> points_mm);

    struct Foot {
        std::size_t piece = 0;  ///< of the chain
        double share = 0.0;     ///< along it, 0 to 1
        double distance_mm = 0.0;
    };
    [[nodiscard]] Foot nearest(const geometry::Point& position_mm) const;
    [[nodiscard]] geometry::Point at(const Foot& foot) const;
    [[nodiscard]] geometry::Vector tangent(const Foot& foot) const;  ///< unit length; 0 of a single point

private:
    std::vector<geometry::Point> chain_mm_;
};

/// f of Singh and Fiume: (1 - x^2)^2 up to 1, then 0.
[[nodiscard]] double wire_falloff(double x);

/// Where a wire takes a point of the surface: what scale, rotation and translation from the reference curve R to the
/// wire W give at the nearest point of R, each times f(distance / radius).
/// @param falloff  f of this point
[[nodiscard]] geometry::Vector wire_displacement(const geometry::Point& position_mm, const WireCurve& reference,
                                                 const WireCurve& wire, const WireCurve::Foot& foot, double scale,
                                                 double falloff);

/// A wire of a character.
struct Wire {
    std::string name;                     ///< "brow_left"
    std::vector<std::uint32_t> vertices;  ///< of the neutral face that it goes through
    double radius_mm = 20.0;              ///< how far it reaches
    std::vector<double> scale;            ///< per example, what it does to the surface about it; 1: nothing
    std::vector<std::vector<geometry::Vector>> displacement_mm;  ///< per example and vertex
};

struct WireOptions {
    double least_radius_mm = 8.0, largest_radius_mm = 70.0;
    int radii = 7;             ///< that are tried between the two, each a constant factor above the last
    double scale_range = 0.4;  ///< scales from 1 less this to 1 and this are tried; 0: all are 1
    int sweeps = 2;            ///< over all wires
    int samples = 1500;        ///< vertices that the radii and scales are fitted on
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("least_radius_mm", self.least_radius_mm);
        visit("largest_radius_mm", self.largest_radius_mm);
        visit("radii", self.radii);
        visit("scale_range", self.scale_range);
        visit("sweeps", self.sweeps);
        visit("samples", self.samples);
    }
    void check() const;  ///< throws InputError
};
static_assert(base::lists_every_field<WireOptions>());

/// How far wires are off the examples that they stand for, over all vertices that some example moves and all examples.
struct WireError {
    double rms_mm = 0.0, largest_mm = 0.0;
    double motion_rms_mm = 0.0;  ///< of the examples themselves: what doing nothing is off
};

/// Examples as wires along the feature lines of a face, and their deformation parameters: some hundred numbers in the
/// place of every vertex. Singh and Fiume, "Wires: a geometric deformation technique", SIGGRAPH 1998.
class WireExamples {
public:
    /// @param wires  with radii and scales. @throws InputError for vertices or examples that there are not.
    WireExamples(std::vector<geometry::Point> neutral_mm, std::vector<Wire> wires, std::size_t examples);

    [[nodiscard]] const std::vector<Wire>& wires() const { return wires_; }
    [[nodiscard]] std::size_t vertices() const { return neutral_mm_.size(); }
    [[nodiscard]] const WireError& error() const { return error_; }

    /// The face with the wires blended by these weights: curves add up as vertices do, then they move the surface.
    /// Several wires at one vertex count f / (1 - f) each, so that every wire has its own points.
    [[nodiscard]] std::vector<geometry::Point> blended(std::span<const double> weights) const;

private:
    friend WireExamples extract_wires(const FacialExamples&, const WireOptions&);

    /// A wire within whose radius a vertex lies.
    struct Reach {
        std::uint32_t wire = 0;
        WireCurve::Foot foot;
        double falloff = 0.0;
    };
    void bind();

    std::vector<geometry::Point> neutral_mm_;
    std::vector<Wire> wires_;
    std::vector<WireCurve> references_;
    std::vector<std::vector<std::uint8_t>> not_of_;  ///< per wire: vertices that the opposite lip or lid has; or empty
    std::vector<Reach> reaches_;                     ///< vertex after vertex
    std::vector<std::size_t> first_reach_;           ///< per vertex, and one past the last
    WireError error_;
};

/// Lays wires along brows, lids, nostrils, lips and chin, and finds each wire's radius and its scale in every example
/// by trying: what comes nearest to the examples. Where two wires lie together at rest and part (lips, lids), a vertex
/// follows the one whose motion its own is like.
/// @param examples  with `feature_vertices`. @throws InputError without them.
[[nodiscard]] WireExamples extract_wires(const FacialExamples& examples, const WireOptions& options = {});

}  // namespace mimik::animation
