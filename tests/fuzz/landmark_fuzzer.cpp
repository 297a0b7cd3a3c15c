#include "io/landmark_io.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {
namespace {

using namespace geometry;
using namespace io;

constexpr auto format = LandmarkFormat::MIMIK_FUZZED;
constexpr bool is_written = format != LandmarkFormat::ljson && format != LandmarkFormat::lan;

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
    } else if (is_written) {
        (void)encode_landmarks(format, marks);
    }
    const std::vector<Point> plate = {{0, 0, 0}, {100, 0, 0}, {100, 200, 10}};
    (void)decode_landmarks(format, text_of(bytes), "input", plate, LengthUnit::centimetre);
}

std::vector<std::string> seeds() {
    if (format == LandmarkFormat::lan) return {std::string(12, '\0') + std::string(24, '@')};
    if (format == LandmarkFormat::ljson)
        return {
            R"({"groups": [{"label": "a", "landmarks": [{"point": [1, 2, 3]}, {"point": [null, null, null]}]}]})",
            R"({"labels": [{"label": "a", "mask": [true, false]}], "landmarks": {"points": [[1, 2, 3], [4, 5, 6]]}})",
            R"({"groups": {"b": {"landmarks": {"points": [[1, 2, 3]]}}}, "version": 3})"};
    const Landmarks marks({{"nose_tip", {1.5, -2, 1e-9}, ""}, {"a \"b\", <c>", {0.1, 0.2, 0.3}, ""}});
    std::vector<std::string> files = {encode_landmarks(format, marks), encode_landmarks(format, Landmarks())};
    if (format == LandmarkFormat::csv) {
        files.emplace_back("sep=;\nlabel;r;a;s;defined\na;1,5;2;3;1\n;;;;\nb;;;;0\n");
        files.emplace_back(std::string("\xFF\xFEn\0a\0m\0e\0\t\0x\0\t\0y\0\t\0z\0\n\0", 24));
    }
    if (format == LandmarkFormat::fcsv) files.emplace_back("# columns = label,x,y,z,sel,vis\na,1,2,3,1,1\n");
    return files;
}

}  // namespace mimik::fuzzing
