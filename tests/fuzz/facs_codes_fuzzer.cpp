#include "database/facs_codes.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto codes = database::parse_facs_codes(text_of(bytes), "input");
    for (const auto& [id, scores] : codes.scores)
        for (const auto& score : scores) {
            require(score.action_unit > 0 && score.action_unit < 1000, "an action unit is a small number");
            require(score.intensity == 0 || (score.intensity >= 'A' && score.intensity <= 'E'),
                    "an intensity is A to E");
        }
    require(codes.remarks.size() <= 21, "remarks do not grow with the file");
}

std::vector<std::string> seeds() {
    return {"facs\r\n\r\nbs000_LFAU_12_0 -> 6B+L12C+R12D+25\r\nbs000_N_N_0 -> 0\r\n",
            "a\nb\nbs000_E_FEAR_0.png -> 1+2+4\nodd line\n"};
}

}  // namespace mimik::fuzzing
