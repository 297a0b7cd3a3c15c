#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mimik::evaluation {

/// How the target's expressive scan is brought to its neutral one before anything is measured.
enum class Alignment : std::uint8_t {
    given,         ///< by the true pose where the database has a truth, else as `stable_region`
    none,          ///< not at all: both scans stay in the scanner's frame
    landmarks,     ///< rotation and shift through all landmarks, those that the expression moves among them
    stable_region  ///< by the trimmed ICP of preprocessing, on skin that the expression leaves alone
};
[[nodiscard]] const char* to_string(Alignment alignment);
/// "given", "none", "landmarks", "stable-region". @throws InputError listing them.
[[nodiscard]] Alignment alignment_by_name(const std::string& name);
[[nodiscard]] std::vector<std::string> known_alignments();

/// Which point of the real face belongs to a vertex of the synthetic one.
enum class Correspondence : std::uint8_t {
    closest_point,  ///< the nearest point of the surface
    along_normal,   ///< where the vertex's own normal meets the surface, up to 10 mm before or behind it
    registered,     ///< where the template that was bent on to both scans carries the neutral vertex
    truth           ///< where the same skin point truly went
};
/// What is measured between the two points.
enum class Distance : std::uint8_t {
    point_to_surface,  ///< their distance; the point lies anywhere on the surface
    point_to_point,    ///< their distance; a closest point is a vertex of the real scan
    along_normal,      ///< the part of it along the real surface's normal; positive: the synthetic face lies outside
    normal_angle,      ///< the angle between the two surfaces' normals
    curvature          ///< how much their mean curvatures differ
};
/// Whose vertices ask.
enum class Direction : std::uint8_t {
    to_real,        ///< the synthetic face's
    to_synthetic,   ///< the real scan's
    larger_of_both  ///< both, and the larger answer counts (Hausdorff)
};

/// One estimator of the pipeline alignment x correspondence x distance, as a value.
struct EstimatorChoice {
    Alignment alignment = Alignment::given;
    Correspondence correspondence = Correspondence::closest_point;
    Distance distance = Distance::point_to_surface;
    Direction direction = Direction::to_real;
    bool operator==(const EstimatorChoice&) const = default;
};

/// What one estimator is, for documents, tables and programs.
struct EstimatorDefinition {
    std::string name;        ///< "point-to-surface"
    std::string spelled;     ///< "closest-point/point-to-surface": the same estimator, word for word
    std::string unit;        ///< "mm", "deg", "1/m"
    std::string metric;      ///< the one that stands for it where one number is wanted: "mean"
    std::string definition;  ///< one sentence
    std::string blind_to;    ///< what it cannot see
    EstimatorChoice choice;
};
/// All that there are, at the alignment that is given.
[[nodiscard]] std::span<const EstimatorDefinition> estimator_definitions();
/// The definition of a choice, whatever its alignment.
[[nodiscard]] const EstimatorDefinition& definition_of(const EstimatorChoice& choice);

/// The name that rows carry: the short one, after the alignment where that is not the given one:
/// "landmarks/point-to-surface".
[[nodiscard]] std::string to_string(const EstimatorChoice& choice);
/// Reads both spellings, each with or without an alignment before it. @throws InputError listing the names there are.
[[nodiscard]] EstimatorChoice estimator_by_name(const std::string& name);
/// The short names.
[[nodiscard]] std::vector<std::string> known_estimator_names();

}  // namespace mimik::evaluation
