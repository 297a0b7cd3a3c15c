#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/fields.h"
#include "capture/marker_sequence.h"
#include "capture/marker_set.h"
#include "geometry/landmarks.h"
#include "geometry/surface_index.h"
#include "synthesis/face_model.h"
#include "synthesis/posed_expression.h"
#include "synthesis/subject.h"

namespace mimik::synthesis {

struct PerformanceOptions {
    double rate_hz = 120;              ///< of the usual systems
    double seconds_a_unit = 0.5;       ///< recording A: every AU goes 0-1-0 within it
    double seconds = 8;                ///< recording B
    double noise_mm = 0.1;             ///< recording B: standard deviation of every coordinate of a marker
    double drop_outs_a_minute = 6;     ///< recording B: of each marker of the face
    double longest_drop_out_s = 0.25;  ///< they last up to this
    double head_turn_deg = 8;          ///< recording B: largest turn about each axis
    double head_shift_mm = 15;         ///< and shift along each
    std::uint64_t seed = 1;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("rate_hz", self.rate_hz);
        visit("seconds_a_unit", self.seconds_a_unit);
        visit("seconds", self.seconds);
        visit("noise_mm", self.noise_mm);
        visit("drop_outs_a_minute", self.drop_outs_a_minute);
        visit("longest_drop_out_s", self.longest_drop_out_s);
        visit("head_turn_deg", self.head_turn_deg);
        visit("head_shift_mm", self.head_shift_mm);
        visit("seed", self.seed);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<PerformanceOptions>());

/// What is performed: how strong every AU is in every frame. Any face of a model can play it.
struct Score {
    std::vector<PosedExpression> units;
    double rate_hz = 120;
    std::vector<std::vector<double>> strength;  ///< [frame][unit], 0 to 1
    [[nodiscard]] std::size_t frames() const { return strength.size(); }
};

/// The AUs that show on a face model, alone and of both sides, in ascending order.
[[nodiscard]] std::vector<PosedExpression> units_that_show(const FaceModel& model);
/// Recording A: every AU ramped 0-1-0 alone, one after another.
[[nodiscard]] Score ramped_score(std::vector<PosedExpression> units, const PerformanceOptions& options = {});
/// Recording B: a mouth that opens and closes, rounds and stretches as in speech, four syllables a second; brows,
/// smiles and blinks come and go above it. The first quarter of a second is at rest.
[[nodiscard]] Score spoken_score(std::vector<PosedExpression> units, const PerformanceOptions& options = {});

/// A face of a model that plays scores, and the markers stuck to it.
class Performer {
public:
    /// @param spread  of identity, see FaceModel::draw_identity; the person of a name and seed is always the same
    Performer(const FaceModel& model, const std::string& name, std::uint64_t seed, double spread = 1,
              const capture::MarkerSet& set = capture::builtin_marker_set());

    [[nodiscard]] const std::string& name() const { return subject_.name; }
    [[nodiscard]] const std::vector<geometry::Point>& resting_mm() const { return subject_.resting_mm; }
    [[nodiscard]] std::span<const geometry::Triangle> triangles() const { return skin_.triangles(); }
    [[nodiscard]] const geometry::Landmarks& landmarks() const { return landmarks_; }
    /// Where markers and derived points are at rest, on the skin.
    [[nodiscard]] geometry::Landmarks labels() const;
    /// The seven markers of a jig about the head; they move with the skull.
    [[nodiscard]] const std::vector<std::pair<std::string, geometry::Point>>& jig() const { return jig_; }

    /// How far the skin moves, head frame, per vertex: the main motions of every AU times its strength, added, and
    /// what a sum may not do mended (FaceModel::settle).
    [[nodiscard]] std::vector<geometry::Vector> motion_mm(std::span<const PosedExpression> units,
                                                          std::span<const double> strengths) const;
    /// The markers of a frame, those of the set first, then the jig's; head frame.
    [[nodiscard]] std::vector<geometry::Point> markers_mm(std::span<const geometry::Vector> motion_mm) const;
    /// Names in that order.
    [[nodiscard]] std::vector<std::string> marker_names() const;

private:
    const FaceModel* model_;
    Subject subject_;
    geometry::Landmarks landmarks_;
    geometry::SurfaceIndex skin_;
    std::vector<std::string> names_, derived_;
    std::vector<geometry::SurfacePoint> bound_;  ///< of markers, then derived points
    std::vector<std::pair<std::string, geometry::Point>> jig_;
};

/// The recording of a score, exact and with the head at rest.
[[nodiscard]] capture::MarkerSequence exact_recording(const Performer& performer, const Score& score);
/// With head motion, noise and drop-outs; the jig is never lost.
[[nodiscard]] capture::MarkerSequence laboratory_recording(const Performer& performer, const Score& score,
                                                           const PerformanceOptions& options = {});

}  // namespace mimik::synthesis
