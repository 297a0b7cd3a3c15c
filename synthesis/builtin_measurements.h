#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "synthesis/face_model.h"

namespace mimik::synthesis {

/// Distances of the adult face that the built-in model draws; every one is met by the neutral surface.
enum class Measurement : std::size_t {
    outer_canthal_width,
    inner_canthal_width,
    nose_width,
    nose_height,
    nose_bridge_length,
    nasal_protrusion,
    mouth_width,
    philtrum_width,
    upper_vermilion,
    lower_vermilion,
    lower_lip_height,
    upper_face_height,
    face_height,
    face_width,
    jaw_width,
    forehead_width,
    ear_width,
    upper_face_depth,
    count
};
inline constexpr std::size_t measurement_count = static_cast<std::size_t>(Measurement::count);

/// Forms that no table of distances fixes; standard scores, mean by sex in the .cpp.
enum class Form : std::size_t {
    dorsum_hump,
    nose_root_depth,
    nose_tip_width,
    wing_height,
    brow_ridge,
    forehead_slope,
    forehead_height,
    eye_tilt,
    lid_opening,
    eye_depth,
    lid_hooding,
    cheekbone,
    cheek_fullness,
    chin_width,
    chin_projection,
    maxilla_projection,
    lip_projection,
    mouth_corner_tilt,
    brow_height,
    brow_arch,
    nasolabial_fold,
    philtrum_depth,
    jaw_angle_height,
    temple_hollow,
    under_eye,
    count
};
inline constexpr std::size_t form_count = static_cast<std::size_t>(Form::count);

/// One row of the population table: mean and SD in mm, adults 18-40, 3D Facial Norms (FaceBase).
struct PopulationMeasurement {
    std::string_view name;
    double male_mean_mm, male_sd_mm, female_mean_mm, female_sd_mm;
};
[[nodiscard]] std::span<const PopulationMeasurement> population_measurements();

/// A person in the numbers that the surface is built from.
struct FaceNumbers {
    std::array<double, measurement_count> mm{};
    std::array<double, form_count> form{};

    [[nodiscard]] double operator[](Measurement m) const { return mm[static_cast<std::size_t>(m)]; }
    [[nodiscard]] double operator[](Form f) const { return form[static_cast<std::size_t>(f)]; }
};

/// Scores (measurements, then forms), correlated by a common size factor and one factor per region, clipped at 2.5.
[[nodiscard]] std::vector<double> draw_scores(std::uint64_t seed, double spread);

/// @throws InputError if the number of coefficients is wrong, one is not finite or beyond 6 standard deviations.
[[nodiscard]] FaceNumbers face_numbers(const Identity& identity);

}  // namespace mimik::synthesis
