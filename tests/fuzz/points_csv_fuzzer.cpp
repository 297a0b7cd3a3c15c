#include "io/points_csv.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto table = io::decode_points_csv(text_of(bytes), "input");
    const auto again = io::decode_points_csv(io::encode_points_csv(table), "again");
    require(again.points == table.points, "what was written reads back");
}

std::vector<std::string> seeds() { return {"name,x,y,z\na,1,2,3\n\"b, c\",4e-1,-5,+6\n", "z, y ,x\r\n1,2,3\r\n"}; }

}  // namespace mimik::fuzzing
