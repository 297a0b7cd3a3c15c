#include "synthesis/builtin_measurements.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/random_stream.h"
#include "base/text.h"

namespace mimik::synthesis {
namespace {

constexpr std::array<PopulationMeasurement, measurement_count> population = {{
    {"outer_canthal_width", 88.9, 3.9, 85.5, 3.9},
    {"inner_canthal_width", 32.8, 2.9, 31.3, 2.7},
    {"nose_width", 36.1, 2.6, 32.6, 2.3},
    {"nose_height", 56.6, 3.9, 54.7, 3.8},
    {"nose_bridge_length", 49.8, 3.9, 47.3, 3.6},
    {"nasal_protrusion", 21.0, 2.0, 20.2, 2.0},
    {"mouth_width", 50.8, 3.8, 48.0, 3.5},
    {"philtrum_width", 13.3, 1.8, 11.8, 1.7},
    {"upper_vermilion", 7.6, 1.7, 7.4, 1.4},
    {"lower_vermilion", 8.8, 2.3, 8.6, 2.0},
    {"lower_lip_height", 19.2, 2.8, 17.6, 2.3},
    {"upper_face_height", 78.1, 4.5, 74.2, 4.4},
    {"face_height", 127.0, 6.6, 118.5, 6.0},
    {"face_width", 137.6, 6.3, 129.9, 5.4},
    {"jaw_width", 104.2, 7.4, 96.9, 6.9},
    {"forehead_width", 111.2, 8.9, 105.4, 7.9},
    {"ear_width", 147.9, 5.5, 139.0, 5.0},
    {"upper_face_depth", 126.6, 5.0, 118.9, 4.5},
}};

/// What a score shares with the body's size, with its region, and which region that is. Loadings of the nose and face
/// heights are chosen so that the heights between their ends (subnasale to gnathion, to stomion) keep their own SDs.
struct Loading {
    double size, region;
    int group;
};
constexpr std::array<Loading, measurement_count> loadings = {{
    {.50, .40, 0},
    {.50, .40, 0},  // eyes
    {.45, .30, 1},  // nose width
    {.45, .78, 2},
    {.45, .78, 2},  // nose height, bridge length
    {.40, .30, 1},  // protrusion
    {.45, .35, 3},
    {.30, .40, 3},  // mouth, philtrum width
    {.10, .60, 4},
    {.10, .60, 4},
    {.20, .50, 4},  // lips
    {.45, .78, 2},
    {.45, .50, 2},  // face heights
    {.55, .60, 5},
    {.50, .50, 5},
    {.45, .40, 5},  // widths
    {.55, .60, 5},
    {.50, .30, 5},  // ears
}};

/// Mean score of each form: half the difference of the sexes (male +, female -).
constexpr std::array<double, form_count> male_lean = [] {
    std::array<double, form_count> lean{};
    lean[static_cast<std::size_t>(Form::dorsum_hump)] = 0.35;
    lean[static_cast<std::size_t>(Form::brow_ridge)] = 0.9;
    lean[static_cast<std::size_t>(Form::forehead_slope)] = 0.6;
    lean[static_cast<std::size_t>(Form::chin_width)] = 0.7;
    lean[static_cast<std::size_t>(Form::chin_projection)] = 0.3;
    lean[static_cast<std::size_t>(Form::brow_height)] = -0.7;
    lean[static_cast<std::size_t>(Form::brow_arch)] = -0.5;
    lean[static_cast<std::size_t>(Form::lid_opening)] = -0.4;
    lean[static_cast<std::size_t>(Form::cheek_fullness)] = -0.4;
    lean[static_cast<std::size_t>(Form::lip_projection)] = -0.3;
    lean[static_cast<std::size_t>(Form::eye_depth)] = 0.4;
    lean[static_cast<std::size_t>(Form::jaw_angle_height)] = -0.6;
    lean[static_cast<std::size_t>(Form::temple_hollow)] = 0.3;
    return lean;
}();

constexpr double clip_sd = 2.5;

}  // namespace

std::span<const PopulationMeasurement> population_measurements() { return population; }

std::vector<double> draw_scores(std::uint64_t seed, double spread) {
    base::RandomStream chance(seed, "built-in/identity");
    const double size = chance.normal();
    std::array<double, 6> region{};
    for (auto& r : region) r = chance.normal();
    std::vector<double> scores;
    for (const auto& [size_share, region_share, group] : loadings) {
        const double own = std::sqrt(1 - size_share * size_share - region_share * region_share);
        scores.push_back(size_share * size + region_share * region[static_cast<std::size_t>(group)] +
                         own * chance.normal());
    }
    for (std::size_t i = 0; i < form_count; ++i) scores.push_back(chance.normal());
    for (auto& s : scores) s = spread * std::clamp(s, -clip_sd, clip_sd);
    return scores;
}

FaceNumbers face_numbers(const Identity& identity) {
    constexpr std::size_t wanted = measurement_count + form_count;
    constexpr double furthest = 6;
    const auto& scores = identity.coefficients;
    if (scores.size() != wanted)
        throw InputError(
            fmt::format("identity of the built-in face has {}; it needs {}: draw it with this model's draw_identity",
                        base::counted(scores.size(), "coefficient"), wanted));
    for (std::size_t i = 0; i < wanted; ++i)
        if (!(std::abs(scores[i]) <= furthest))
            throw InputError(
                fmt::format("identity of the built-in face: coefficient {} is {} standard deviations; keep "
                            "it within {}",
                            i, scores[i], furthest));
    FaceNumbers numbers;
    const bool male = identity.sex == Sex::male;
    for (std::size_t i = 0; i < measurement_count; ++i) {
        const auto& row = population[i];
        numbers.mm[i] =
            male ? row.male_mean_mm + scores[i] * row.male_sd_mm : row.female_mean_mm + scores[i] * row.female_sd_mm;
    }
    for (std::size_t i = 0; i < form_count; ++i)
        numbers.form[i] = scores[measurement_count + i] + (male ? 1 : -1) * male_lean[i];
    return numbers;
}

}  // namespace mimik::synthesis
