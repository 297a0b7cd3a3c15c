#include "preprocessing/landmark_error.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/random_stream.h"

namespace mimik::preprocessing {

void LandmarkErrorOptions::check() const {
    constexpr double most_mm = 50;  // farther than that a face has no such place
    if (!(mean_mm >= 0 && mean_mm <= most_mm))
        throw InputError(fmt::format("mean_mm is {}; give 0 to {}, such as 2", mean_mm, most_mm));
}

geometry::Landmarks with_landmark_error(const geometry::Landmarks& landmarks, std::string_view scan,
                                        const LandmarkErrorOptions& options) {
    options.check();
    const double deviation_mm = options.mean_mm / (2 * std::sqrt(2 / std::numbers::pi));
    std::vector<geometry::Landmark> moved;
    moved.reserve(landmarks.size());
    for (auto mark : landmarks.all()) {
        base::RandomStream chance(options.seed, fmt::format("{}/landmark error/{}", scan, mark.name));
        for (int axis = 0; axis < 3; ++axis) mark.position_mm[axis] += deviation_mm * chance.normal();
        moved.push_back(std::move(mark));
    }
    return geometry::Landmarks(std::move(moved));
}

}  // namespace mimik::preprocessing
