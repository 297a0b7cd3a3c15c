#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "animation/facial_examples.h"
#include "modeling/source_examples.h"

// What 'mimik perform' and 'mimik live' know of a performer's examples and a character's.

namespace mimik::cli {

/// Those of the performer's examples that the character has, too. @param folder  of the character, for messages
/// @throws InputError if there is none
[[nodiscard]] modeling::SourceExamples examples_of_character(const modeling::SourceExamples& source,
                                                             const animation::FacialExamples& character,
                                                             const std::filesystem::path& folder,
                                                             std::vector<std::string>& remarks);

/// Columns of weights in the order of the character's examples; one without a column stays 0, with a remark.
/// @param examples  of the columns
[[nodiscard]] Eigen::MatrixXd columns_of(const animation::FacialExamples& character,
                                         const std::vector<std::string>& examples, const Eigen::MatrixXd& mapped,
                                         std::vector<std::string>& remarks);

}  // namespace mimik::cli
