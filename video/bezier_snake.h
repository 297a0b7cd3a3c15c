#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/fields.h"
#include "video/face_patch.h"

namespace mimik::video {

/// Weights of the energy of a snake (Eqs. 2-4) and how it is minimised. Lengths are pixels of the image; intensities
/// are 0 on skin to 1 in a feature.
struct SnakeOptions {
    double edge = 3.0;       ///< w1 of Eq. 3, on the squared gradient
    double inside = 1.0;     ///< w_in of Eq. 4
    double outside = 0.7;    ///< w_out of Eq. 4; smaller than w_in, so that a wrong edge costs energy
    double offset_px = 3.5;  ///< by which the offset curves lie beside the curve in its middle
    /// Times the square of the way from the start, in units of offset_px: not in the paper. It holds a curve where the
    /// image shows nothing.
    double stay = 0.15;
    /// On what the ends of a closed outline see along the curve, I beyond less I within: not in the paper. Without it
    /// curves shrink to where the contrast is best.
    double cap = 0.35;
    /// Control points move up and down alone, and the group moves sideways and widens as a whole; false: each goes
    /// where its gradient points.
    bool upright = true;
    bool widen = true;  ///< with `upright`: the group may become wider; false: it keeps its width
    int samples = 10;   ///< along a curve
    int steps = 16;     ///< downhill, on each level
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("edge", self.edge);
        visit("inside", self.inside);
        visit("outside", self.outside);
        visit("offset_px", self.offset_px);
        visit("stay", self.stay);
        visit("cap", self.cap);
        visit("upright", self.upright);
        visit("widen", self.widen);
        visit("samples", self.samples);
        visit("steps", self.steps);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<SnakeOptions>());

/// One level of a pyramid of blurred images: the intensity and the square of its gradient.
struct SnakeLevel {
    FloatImage intensity, edge;
};
/// From the most blurred level on. @param blurs_px  standard deviations, the widest first; 0: as it is
[[nodiscard]] std::vector<SnakeLevel> snake_levels(const FloatImage& image, std::span<const double> blurs_px);

/// Curves that move together: some share control points, such as the corners of a mouth.
struct SnakeGroup {
    std::vector<Pixel> points;
    struct Member {
        std::array<std::size_t, 4> point{};  ///< its control points, places in `points`
        /// Which way the feature lies: +1 below the curve (down the image), -1 above it.
        double inside = 1;
    };
    std::vector<Member> curves;
    [[nodiscard]] BezierCurve curve(std::size_t member) const;
};

/// Energy of Eq. 2 per curve, averaged over the curves; the lower the better.
[[nodiscard]] double snake_energy(const SnakeGroup& group, const SnakeLevel& level, const SnakeOptions& options = {});
/// I(v_in) - I(v_out) of one curve, averaged along it: how well an edge is seen.
[[nodiscard]] double snake_contrast(const BezierCurve& curve, double inside, const FloatImage& intensity,
                                    double offset_px);
/// Minimises the energy downhill, on one level after the other. @returns the energy at the end, on the last level
double minimise_snake(SnakeGroup& group, std::span<const SnakeLevel> levels, const SnakeOptions& options = {});

}  // namespace mimik::video
