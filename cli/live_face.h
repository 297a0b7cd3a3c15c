#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "animation/blend_examples.h"
#include "animation/expression_mapping.h"
#include "animation/facial_examples.h"
#include "cli/capture_options.h"
#include "modeling/source_examples.h"
#include "report/shaded_face.h"
#include "video/feature_rows.h"

namespace mimik::cli {

/// The character of 'mimik live', and what it does as the performer's rows come.
class LiveFace {
public:
    /// @param arguments  are kept by reference
    /// @param neutral_from  the first frame in which the performer is at rest
    /// @throws InputError for options, examples or a table that do not fit
    LiveFace(const LiveArguments& arguments, double rate_hz, int neutral_from);

    /// Rows before the performer's rest is known wait for it.
    void take(const video::FeatureRows::Row& row);
    /// Once the neutral frames have been seen. The rest is that of the rows from `neutral_from` on; if none of them
    /// shows the face, that of the first row that does.
    void begin();
    [[nodiscard]] bool has_begun() const { return mapper_.has_value(); }
    void blend();
    [[nodiscard]] io::Image picture(int size_px);

    [[nodiscard]] std::vector<std::string> examples() const;  ///< names, in the order of the weights
    [[nodiscard]] std::span<const double> weights() const {
        return {weights_.data(), static_cast<std::size_t>(weights_.size())};
    }
    [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }

private:
    const LiveArguments& arguments_;
    long neutral_from_;
    animation::ExpressionMappingOptions options_;
    animation::FacialExamples character_;
    std::optional<animation::ExampleBlender> blender_;
    std::optional<report::FacePainter> painter_;
    modeling::SourceExamples table_;
    capture::FeatureMotion motion_;  ///< its names and rate; of the neutral frames when the mapping begins
    std::vector<std::pair<long, capture::FeatureFrame>> waiting_;  ///< rows that show the face, by their frames
    std::optional<animation::ExpressionMapping> mapping_;
    std::optional<animation::PerformanceMapper> mapper_;
    Eigen::MatrixXd columns_;  ///< from the mapping's examples to the character's
    Eigen::VectorXd weights_;
    std::vector<geometry::Point> vertices_mm_;
    std::vector<std::string> remarks_;
};

}  // namespace mimik::cli
