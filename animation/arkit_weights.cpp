#include "animation/arkit_weights.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::animation {

namespace {

/// What of a shape a unit is: a whole one has a share of 1/2 by each half.
struct Part {
    std::size_t unit = 0;
    int number = 0;  ///< of the AU: its halves add up, and other AUs do not
    double share = 1;
};

/// The shapes that an expression of one AU stands for: one, or a left and a right one.
std::vector<std::pair<std::string, double>> shapes_of(const facs::FacsCatalogue& catalogue,
                                                      const facs::Expression& expression, int& number) {
    const auto sided = catalogue.units(expression);
    if (sided.size() != 1) return {};
    const auto& unit = *sided.front().unit;
    number = unit.number;
    const auto side = sided.front().side;
    if (const auto shape = facs::arkit_shape(catalogue, expression); !shape.empty()) return {{shape, 1.0}};
    if (side == facs::Side::both && !unit.arkit.empty())
        return {{unit.arkit + "Left", 1.0}, {unit.arkit + "Right", 1.0}};
    if (side != facs::Side::both && !unit.arkit_whole.empty()) return {{unit.arkit_whole, 0.5}};
    return {};
}

}  // namespace

capture::ShapeMotion arkit_weights(const facs::FacsCatalogue& catalogue, std::span<const std::string> units,
                                   std::span<const std::vector<double>> strengths, double rate_hz) {
    std::map<std::string, std::vector<Part>> parts;
    std::vector<std::string> without;
    for (std::size_t u = 0; u < units.size(); ++u) {
        int number = 0;
        const auto shapes = shapes_of(catalogue, catalogue.expression(units[u]), number);
        if (shapes.empty()) without.push_back(units[u]);
        for (const auto& [shape, share] : shapes) parts[shape].push_back({u, number, share});
    }
    capture::ShapeMotion motion;
    motion.rate_hz = rate_hz;
    for (const auto& [shape, list] : parts) motion.shapes.push_back(shape);
    motion.values.resize(static_cast<Eigen::Index>(strengths.size()), static_cast<Eigen::Index>(motion.shapes.size()));
    std::size_t above = 0;
    for (std::size_t f = 0; f < strengths.size(); ++f) {
        if (strengths[f].size() != units.size())
            throw InputError(
                fmt::format("frame {} has {} strengths; there are {} units", f + 1, strengths[f].size(), units.size()));
        motion.times_s.push_back(static_cast<double>(f) / rate_hz);
        motion.tracked.push_back(1);
        Eigen::Index column = 0;
        for (const auto& [shape, list] : parts) {
            std::map<int, double> by_unit;
            for (const auto& part : list) by_unit[part.number] += part.share * strengths[f][part.unit];
            double weight = 0;
            for (const auto& [number, strength] : by_unit) weight = std::max(weight, strength);
            above += weight > 1 ? 1 : 0;
            motion.values(static_cast<Eigen::Index>(f), column++) = std::min(weight, 1.0);
        }
    }
    if (!without.empty())
        motion.remarks.push_back(fmt::format("ARKit has no shape of {}; left out", fmt::join(without, ", ")));
    if (above > 0)
        motion.remarks.push_back(
            fmt::format("{} above 1 and written as 1", base::counted(above, "weight is", "weights are")));
    return motion;
}

}  // namespace mimik::animation
