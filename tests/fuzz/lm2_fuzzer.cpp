#include <cmath>

#include "database/bosphorus_landmarks.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {

void fuzz_one(std::span<const std::uint8_t> bytes) {
    for (const auto& mark : database::parse_lm2(text_of(bytes), "input"))
        require(std::isfinite(mark.column) && std::isfinite(mark.row) && !mark.label.empty(),
                "marks are named and finite");
}

std::vector<std::string> seeds() {
    return {
        "# 2D\r\n\r\n2 landmarks:\r\n\r\nLabels:\r\nNose tip\r\nChin middle\r\n\r\n2D Image coordinates:\r\n10 "
        "20.5\r\n11 30\r\n",
        "# 2D\n* free\ntext\n\n0 landmarks:\n\nLabels:\n\n2D Image coordinates:\n"};
}

}  // namespace mimik::fuzzing
