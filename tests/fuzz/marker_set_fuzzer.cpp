#include "capture/marker_set.h"
#include "facs/reference_face.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto findings = capture::lint_marker_set(text_of(bytes));
    require(findings.size() <= 1001, "a file of another kind does not fill the memory with complaints");
    const auto set = capture::decode_marker_set(text_of(bytes), "input");
    for (const auto& marker : set.markers)
        require(set.find(marker.name) != nullptr && marker.group.size() >= 3, "a marker is carried by three or more");
    (void)capture::place_markers(set, facs::reference_landmarks());
}

std::vector<std::string> seeds() {
    return {std::string(capture::builtin_marker_set_text()),
            "schema = 1\n[[marker]]\nname = \"a\"\nsides = \"middle\"\nat = { chin = 1.0 }\ngroup = [\"a\"]\n"};
}

}  // namespace mimik::fuzzing
