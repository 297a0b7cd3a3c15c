#include "database/bosphorus_landmarks.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {

/// .lm3 files through the renaming of labels, there and back.
void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto raw = database::parse_lm3(text_of(bytes), "input");
    database::SideReport report;
    const auto named = database::from_any_labels(raw, &report);
    require(named.size() == raw.size(), "no landmark is lost by naming");
    require(report.pairs_disagreeing <= report.pairs_agreeing, "sides follow the majority");
    const auto ours = database::from_bosphorus_labels(raw);
    const auto back = database::from_bosphorus_labels(database::to_bosphorus_labels(ours));
    require(back.size() == ours.size(), "no landmark is lost on the way back");
}

std::vector<std::string> seeds() {
    return {
        "# 3D\r\n\r\n4 landmarks:\r\nOuter left eye corner\r\n-45 30 1e1\r\nOuter right eye corner\r\n45 30 10\r\nNose "
        "tip\r\n0 0 50\r\n"
        "my own\r\n1 2 3\r\n",
        "# 3D\n\n3 landmarks:\nex_l\n1 2 3\nexocanthion right\n4 5 6\nprn\n7 8 9\n"};
}

}  // namespace mimik::fuzzing
