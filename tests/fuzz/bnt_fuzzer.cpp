#include <cmath>
#include <cstring>

#include "database/bnt.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {
namespace {

std::string bnt_file(std::uint16_t rows, std::uint16_t cols, const std::string& texture) {
    std::string bytes;
    const auto put = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
    put(rows);
    put(cols);
    put(-1e9);
    put(static_cast<std::uint16_t>(texture.size()));
    bytes += texture;
    put(std::uint32_t{5} * rows * cols);
    for (int i = 0; i < 5 * rows * cols; ++i) put(i % 7 == 0 ? -1e9 : 0.25 * i);
    return bytes;
}

}  // namespace

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto bnt = database::decode_bnt(bytes, "input");
    const auto cells = std::size_t{bnt.rows} * bnt.cols;
    require(40 * cells < bytes.size(), "memory is bounded by the length of the file");
    require(bnt.x.size() == cells && bnt.v.size() == cells, "every column has a value per cell");
    const auto scan = database::to_range_scan(bnt, "input");
    for (const auto& p : scan.points_mm)
        require(p.allFinite() || p.array().isNaN().all(), "a point is measured or NaN");
    require(scan.texture_file.find('/') == std::string::npos, "a texture name has no folder");
    const auto again = database::to_range_scan(database::to_bnt(scan, bnt.background), "again");
    for (std::size_t i = 0; i < cells; ++i)
        require(again.valid(i) == scan.valid(i), "what was measured stays measured");
}

std::vector<std::string> seeds() {
    return {bnt_file(3, 4, "bs000_N_N_0.png"), bnt_file(1, 1, ""), bnt_file(2, 2, "../../x.png")};
}

}  // namespace mimik::fuzzing
