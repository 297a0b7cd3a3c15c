#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "base/random_stream.h"
#include "capture/feature_motion.h"
#include "modeling/source_examples.h"

// A performer whose weights are known.

namespace mimik::test {

/// Three examples of 8 features; no two alike.
inline modeling::SourceExamples three_examples() {
    modeling::SourceExamples source;
    source.features = {"eye_outer_left",  "eye_outer_right", "mouth_corner_left", "mouth_corner_right",
                       "lower_lip_outer", "upper_lip_outer", "brow_middle_left",  "brow_middle_right"};
    source.neutral_mm = {{44, 0, 0},  {-44, 0, 0}, {25, -75, 0}, {-25, -75, 0},
                         {0, -85, 4}, {0, -68, 5}, {30, 20, 5},  {-30, 20, 5}};
    source.examples = {"smile", "open", "brows_up"};
    source.displacement_mm.assign(3, std::vector<geometry::Vector>(8, geometry::Vector::Zero()));
    source.displacement_mm[0][2] = {6, 4, -3};
    source.displacement_mm[0][3] = {-6, 4, -3};
    source.displacement_mm[1][2] = source.displacement_mm[1][3] = {0, -3, 0};
    source.displacement_mm[1][4] = {0, -18, -4};
    source.displacement_mm[2][6] = source.displacement_mm[2][7] = {0, 7, 1};
    return source;
}

/// Weight of an example over time: rises and falls, each in its own time; 0 in the first half second.
inline double known_weight(std::size_t example, double time_s) {
    if (time_s < 0.5) return 0;
    const double turn = std::sin((1.7 + 0.9 * static_cast<double>(example)) * (time_s - 0.5));
    return turn > 0 ? turn : 0;
}

/// @param scale  of the performer's face beside that of the examples
inline capture::FeatureMotion performed(const modeling::SourceExamples& source, std::size_t frames, double noise_mm,
                                        double scale = 1.0) {
    capture::FeatureMotion motion{source.features, 30.0, {}};
    base::RandomStream chance(7);
    for (std::size_t f = 0; f < frames; ++f) {
        capture::FeatureFrame frame;
        frame.time_s = static_cast<double>(f) / motion.rate_hz;
        frame.state = capture::TrackState::tracked;
        frame.confidence = 1;
        for (std::size_t k = 0; k < source.features.size(); ++k) {
            geometry::Point p = source.neutral_mm[k];
            for (std::size_t i = 0; i < source.examples.size(); ++i)
                p += known_weight(i, frame.time_s) * source.displacement_mm[i][k];
            p *= scale;
            for (auto& c : p) c += noise_mm * chance.normal();
            frame.features.push_back({true, false, {0, 0}, p});
        }
        motion.frames.push_back(frame);
    }
    return motion;
}

}  // namespace mimik::test
