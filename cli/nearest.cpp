#include "cli/nearest.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"

namespace mimik::cli {

std::size_t edits_between(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t k = 0; k < row.size(); ++k) row[k] = k;
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t k = 0; k < b.size(); ++k) {
            const auto changed = diagonal + (a[i] == b[k] ? 0 : 1);
            diagonal = row[k + 1];
            row[k + 1] = std::min({changed, diagonal + 1, row[k] + 1});
        }
    }
    return row.back();
}

std::string nearest_word(std::string_view typed, const std::vector<std::string>& words) {
    constexpr std::size_t longest = 64;  // nobody means a word by a page of text
    if (typed.empty() || typed.size() > longest) return {};
    const auto lowered = base::lower_case(typed);
    std::string nearest;
    std::size_t fewest = SIZE_MAX;
    for (const auto& word : words) {
        const auto known = base::lower_case(word);
        // Of options the two dashes are always right.
        const auto shorter = std::min(lowered.size(), known.size()),
                   dashes = std::size_t{known.starts_with("--") ? 2U : 0U};
        const auto letters = shorter - std::min(shorter, dashes);
        const bool begun = letters >= 2 && known.starts_with(lowered);
        const auto edits = begun ? 1 : edits_between(lowered, known);
        if (edits >= fewest || edits > std::max<std::size_t>(1, (letters + 1) / 3)) continue;
        fewest = edits;
        nearest = word;
    }
    return nearest;
}

std::string did_you_mean(std::string_view typed, const std::vector<std::string>& words) {
    const auto nearest = nearest_word(typed, words);
    return nearest.empty() ? std::string() : fmt::format("; did you mean {}?", nearest);
}

}  // namespace mimik::cli
