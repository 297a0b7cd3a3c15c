#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "base/fields.h"
#include "capture/feature_motion.h"
#include "modeling/cardinal_basis.h"
#include "modeling/example_parameters.h"
#include "modeling/source_examples.h"

namespace mimik::animation {

struct ExpressionMappingOptions {
    modeling::ExampleParameterOptions parameters;
    modeling::CardinalBasisOptions basis = {.with_rest = true, .ridge_share = 1e-3};
    double gain = 1.0;   ///< of all weights: below 1 attenuates, above exaggerates
    bool clamp = false;  ///< weights are brought into [0, 1] before the gain; blending does not overshoot then
    /// Of a frame in which the face was lost, the last weights are held so long, and then fall with this time constant.
    double hold_s = 0.25, relax_s = 0.3;
    /// Fewer of the features than this share, and the frame counts as lost.
    double least_features = 0.5;

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("parameters", self.parameters);
        visit("basis", self.basis);
        visit("gain", self.gain);
        visit("clamp", self.clamp);
        visit("hold_s", self.hold_s);
        visit("relax_s", self.relax_s);
        visit("least_features", self.least_features);
    }
    void check() const;  ///< throws InputError
};
static_assert(base::lists_every_field<ExpressionMappingOptions>());

/// Where one frame lies among the examples.
struct MappedExpression {
    Eigen::VectorXd weights;          ///< per example, neither clamped nor with the gain
    double unexplained_rms_mm = 0.0;  ///< of the displacement that no example shows, over the coordinates seen
};

/// Displacements of a performer's features to weights of examples, frame by frame: Eqs 5 to 13 of "Online expression
/// mapping for performance-driven facial animation" (ICEC 2007).
class ExpressionMapping {
public:
    /// @param source  in the performer's own size. @throws as example_parameters and CardinalBasis, examples by name.
    explicit ExpressionMapping(modeling::SourceExamples source, const ExpressionMappingOptions& options = {});

    [[nodiscard]] const modeling::SourceExamples& source() const { return source_; }
    [[nodiscard]] const modeling::ExampleParameters& parameters() const { return parameters_; }
    [[nodiscard]] const modeling::CardinalBasis& basis() const { return basis_; }
    [[nodiscard]] const ExpressionMappingOptions& options() const { return options_; }

    /// @param displacement_mm  per feature of the source, in its order, from the performer's face at rest
    /// @param valid            per feature; parameters follow from those that are by least squares
    [[nodiscard]] MappedExpression map(std::span<const geometry::Vector> displacement_mm,
                                       std::span<const std::uint8_t> valid) const;

private:
    ExpressionMappingOptions options_;
    modeling::SourceExamples source_;
    modeling::ExampleParameters parameters_;
    modeling::CardinalBasis basis_;
};

/// A performer's face at rest: per feature of the motion the median position over the frames first to last (both among
/// them) in which it was seen, and whether that is in at least half of those that are tracked.
struct PerformerRest {
    std::vector<geometry::Point> position_mm;
    std::vector<std::uint8_t> known;
    std::size_t frames = 0;  ///< tracked ones
};
/// @throws InputError if there are no such frames, or none of them is tracked.
[[nodiscard]] PerformerRest performer_rest(const capture::FeatureMotion& motion, std::size_t first, std::size_t last);

/// A frame of the motion in which the performer shows an example.
struct KeyFrame {
    std::string example;
    std::size_t frame = 0;
};
/// Source examples of the performer's own: of all features that are known at rest and seen in every key frame.
/// @throws InputError naming a key frame that is lost or that there is not.
[[nodiscard]] modeling::SourceExamples performer_examples(const capture::FeatureMotion& motion,
                                                          const PerformerRest& rest, std::span<const KeyFrame> keys);

/// A table of examples made to fit a performer: the features that both have, in the performer's size by the distance of
/// the outer eye corners; flat where the motion has no depth (z stays at rest). @param factor  what the table was
/// scaled by
/// @throws InputError if they share fewer than 4 features.
[[nodiscard]] modeling::SourceExamples fitted_examples(const modeling::SourceExamples& table,
                                                       const capture::FeatureMotion& motion, const PerformerRest& rest,
                                                       double* factor = nullptr);

/// Weights frame by frame, as they go to the face: of a performer who is seen while it goes on.
class PerformanceMapper {
public:
    /// @param motion   names its features; its frames are not read
    /// @param rest     of that motion
    /// @param mapping  is kept by reference
    /// @throws InputError if a feature of the mapping is not in the motion.
    PerformanceMapper(const capture::FeatureMotion& motion, PerformerRest rest, const ExpressionMapping& mapping);

    struct Frame {
        Eigen::VectorXd weights;  ///< clamped if asked for, with the gain; held, or falling to 0, if not tracked
        bool tracked = false;
        double least = 0.0, largest = 0.0;  ///< weights as they were mapped; of a tracked frame
        double unexplained_rms_mm = 0.0;    ///< likewise
    };
    /// Frame after frame; a time is never before the last one.
    [[nodiscard]] Frame next(const capture::FeatureFrame& seen);

private:
    const ExpressionMapping& mapping_;
    PerformerRest rest_;
    std::vector<std::size_t> place_;  ///< of the mapping's features in the motion
    std::vector<geometry::Vector> displacement_mm_;
    std::vector<std::uint8_t> valid_;
    Eigen::VectorXd last_;
    double last_time_s_ = 0.0;
};

/// Weights over time, and what is to be said of them.
struct MappedPerformance {
    std::vector<std::string> examples;
    double rate_hz = 30.0;
    std::vector<double> times_s;
    std::vector<std::uint8_t> tracked;  ///< per frame; else the weights are held, or fall to 0
    Eigen::MatrixXd weights;            ///< a row per frame, a column per example; clamped if asked for, with the gain
    /// Of the weights as they were mapped:
    double least_weight = 0.0, largest_weight = 0.0;
    std::size_t overshoots = 0, negatives = 0;  ///< frames with a weight above 1.05; below -0.05
    std::size_t lost = 0;                       ///< frames
    double median_unexplained_mm = 0.0;
};

/// @param rest  of this motion. @throws InputError if a feature of the mapping is not in the motion.
[[nodiscard]] MappedPerformance map_performance(const capture::FeatureMotion& motion, const PerformerRest& rest,
                                                const ExpressionMapping& mapping);

/// "frame,time,state,NAME,...": the first line of a table of weights, and a line of it, each with its end.
[[nodiscard]] std::string weights_header(std::span<const std::string> examples);
[[nodiscard]] std::string weights_row(std::size_t frame, double time_s, bool tracked, std::span<const double> weights);
/// That table: weights as they go to the face.
[[nodiscard]] std::string encode_weights(const MappedPerformance& performance);

}  // namespace mimik::animation
