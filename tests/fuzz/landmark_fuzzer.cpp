#include "io/landmark_io.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {
namespace {

using namespace geometry;
using namespace io;

constexpr auto format = LandmarkFormat::MIMIK_FUZZED;

}  // namespace

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto marks = decode_landmarks(format, text_of(bytes), "input");
    for (const auto& mark : marks.all())
        require(mark.position_mm.allFinite() && !mark.name.empty(), "marks are named and finite");
    if (format == LandmarkFormat::csv) {
        const auto again = decode_landmarks(format, encode_landmarks(format, marks), "again");
        require(again.size() == marks.size(), "what was written reads back");
        for (const auto& mark : marks.all())
            // A carriage return inside a name becomes a blank: a CSV field here has one line.
            require(mark.name.find('\r') != std::string::npos ||
                        (again.find(mark.name) && again.position_mm(mark.name) == mark.position_mm),
                    "names and numbers read back");
    } else {
        (void)encode_landmarks(format, marks);
    }
    const std::vector<Point> plate = {{0, 0, 0}, {100, 0, 0}, {100, 200, 10}};
    (void)decode_landmarks(format, text_of(bytes), "input", plate, LengthUnit::centimetre);
}

std::vector<std::string> seeds() {
    const Landmarks marks({{"nose_tip", {1.5, -2, 1e-9}, ""}, {"a \"b\", <c>", {0.1, 0.2, 0.3}, ""}});
    return {encode_landmarks(format, marks), encode_landmarks(format, Landmarks())};
}

}  // namespace mimik::fuzzing
