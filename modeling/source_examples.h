#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/types.h"

namespace mimik::modeling {

/// What features of a performer's face do in each of the example expressions: the source side of expression mapping.
struct SourceExamples {
    std::vector<std::string> features;        ///< names, as capture::face_features() has them; each once
    std::vector<geometry::Point> neutral_mm;  ///< per feature, at rest, in the head's frame
    std::vector<std::string> examples;        ///< names; each once, none is "neutral"
    /// Per example and feature: Eq. 5, v_i = s_i - s_B.
    std::vector<std::vector<geometry::Vector>> displacement_mm;

    [[nodiscard]] std::optional<std::size_t> find_feature(std::string_view name) const;
    [[nodiscard]] std::optional<std::size_t> find_example(std::string_view name) const;
    /// @throws InputError naming example, feature and value of what breaks a rule above.
    void check() const;
};

/// The displacements times a factor, for a performer of another size; positions too.
[[nodiscard]] SourceExamples scaled(SourceExamples source, double factor);

/// These features and these examples alone, in this order. @throws InputError naming one that there is not.
[[nodiscard]] SourceExamples with_features(const SourceExamples& source, std::span<const std::string> features);
[[nodiscard]] SourceExamples with_examples(const SourceExamples& source, std::span<const std::string> examples);

/// Distance between the outer eye corners at rest, mm; none without them.
[[nodiscard]] std::optional<double> outer_eye_distance_mm(const SourceExamples& source);

/// What ships with Mimik: the standard examples (animation/make_examples.h) as features of the built-in face show them.
[[nodiscard]] const SourceExamples& standard_source_examples();

/// CSV, positions in mm in the head's frame, the first row at rest:
///
///     example,NAME_x,NAME_y,NAME_z,...
///     neutral,...
///     smile,...
///
/// @param name  stands for the file in errors. @throws InputError naming file, line, column, value and mend.
[[nodiscard]] SourceExamples decode_source_examples(std::string_view text, const std::string& name);
[[nodiscard]] std::string encode_source_examples(const SourceExamples& source);
[[nodiscard]] SourceExamples read_source_examples(const std::filesystem::path& file);
void write_source_examples(const std::filesystem::path& file, const SourceExamples& source);

}  // namespace mimik::modeling
