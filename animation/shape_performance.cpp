#include "animation/shape_performance.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"

namespace mimik::animation {

MappedPerformance map_shapes(const capture::ShapeMotion& motion, const FacialExamples& character,
                             const ExpressionMappingOptions& options) {
    options.check();
    MappedPerformance mapped;
    std::vector<Eigen::VectorXd> columns;
    for (const auto& example : character.examples) {
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(motion.values.rows());
        int found = 0;
        for (const auto& shape : example.arkit)
            if (const auto column = motion.find(shape)) {
                sum += motion.values.col(static_cast<Eigen::Index>(*column));
                ++found;
            }
        if (found == 0) continue;
        mapped.examples.push_back(example.name);
        columns.emplace_back(sum / found);
    }
    if (columns.empty())
        throw InputError(
            "no example stands for a shape of the motion; give examples ARKit names (arkit = [...] in "
            "examples.toml)");
    mapped.rate_hz = motion.rate_hz;
    mapped.times_s = motion.times_s;
    mapped.tracked = motion.tracked;
    mapped.weights = Eigen::MatrixXd::Zero(motion.values.rows(), static_cast<Eigen::Index>(columns.size()));
    Eigen::RowVectorXd last = Eigen::RowVectorXd::Zero(mapped.weights.cols());
    double last_time_s = 0;
    for (Eigen::Index frame = 0; frame < mapped.weights.rows(); ++frame) {
        const double time_s = motion.times_s[static_cast<std::size_t>(frame)];
        if (!motion.tracked[static_cast<std::size_t>(frame)]) {
            ++mapped.lost;
            const double since_s = time_s - last_time_s - options.hold_s;
            mapped.weights.row(frame) = last * (since_s <= 0 ? 1.0 : std::exp(-since_s / options.relax_s));
            continue;
        }
        for (std::size_t k = 0; k < columns.size(); ++k) last[static_cast<Eigen::Index>(k)] = columns[k][frame];
        constexpr double much = 0.05;
        mapped.least_weight = std::min(mapped.least_weight, last.minCoeff());
        mapped.largest_weight = std::max(mapped.largest_weight, last.maxCoeff());
        mapped.negatives += last.minCoeff() < -much ? 1 : 0;
        mapped.overshoots += last.maxCoeff() > 1 + much ? 1 : 0;
        if (options.clamp) last = last.cwiseMax(0.0).cwiseMin(1.0);
        last *= options.gain;
        last_time_s = time_s;
        mapped.weights.row(frame) = last;
    }
    return mapped;
}

}  // namespace mimik::animation
