#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mimik::cli {

/// Letters to put in, leave out or change between two words (Levenshtein 1966).
[[nodiscard]] std::size_t edits_between(std::string_view a, std::string_view b);

/// The word that was meant, if one is near enough to be meant: a third of its letters may be wrong, or it was not
/// typed to its end. Empty: none is.
[[nodiscard]] std::string nearest_word(std::string_view typed, const std::vector<std::string>& words);

/// "; did you mean X?", or empty.
[[nodiscard]] std::string did_you_mean(std::string_view typed, const std::vector<std::string>& words);

}  // namespace mimik::cli
