#include "facs/side.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::facs {

std::string to_string(Side side) { return side == Side::left ? "left" : side == Side::right ? "right" : "both"; }

Side parse_side(std::string_view text) {
    const std::string word = base::lower_case(text);
    if (word == "left" || word == "l") return Side::left;
    if (word == "right" || word == "r") return Side::right;
    if (word == "both") return Side::both;
    throw InputError(fmt::format("side '{}' is unknown; give left, right (the subject's own) or both", text));
}

Side opposite(Side side) { return side == Side::left ? Side::right : side == Side::right ? Side::left : Side::both; }

}  // namespace mimik::facs
