#include <sstream>
#include <vector>

#include "base/content_hash.h"
#include "evaluation/case_store.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {

/// A table of cases; behind an 'r' one of its rows, since chance does not find the checksum of a table.
void fuzz_one(std::span<const std::uint8_t> bytes) {
    const std::string text(text_of(bytes));
    if (text.starts_with('r')) {
        const auto row = evaluation::decode_case_row(text.substr(1));
        if (!row) return;
        const auto again = evaluation::decode_case_row(evaluation::encode_case_row(*row));
        require(again.has_value(), "what was written reads back");
        require(evaluation::encode_case_row(*again) == evaluation::encode_case_row(*row), "and as it was");
        return;
    }
    std::istringstream in(text);
    std::size_t rows = 0;
    const auto units = evaluation::read_case_rows(in, "input", [&](const auto&) { ++rows; });
    require(rows == 0 || !units.empty(), "rows belong to a unit");
}

std::vector<std::string> seeds() {
    const evaluation::CaseRow plain{
        {"bs003", "bs007", "12L", "default", 1}, "surface_distance", "zone", "mean", 0.75, "mm", ""};
    const evaluation::CaseRow odd{{"", "a, \"b\"", "SNEER", "nothing", 0.5}, "field", "face", "left_out", {}, "",
                                  "scored as doing nothing: no model"};
    std::string table = std::string(evaluation::case_row_header()) + '\n';
    const auto whole = table + "# unit 12L bs003: 0 rows, " + base::ContentHash().text() + '\n';
    for (const auto& row : {plain, odd}) table += evaluation::encode_case_row(row) + '\n';
    return {whole, table + "# unit 12L bs003: 2 rows, 0123456789abcdef\n", 'r' + evaluation::encode_case_row(plain),
            'r' + evaluation::encode_case_row(odd)};
}

}  // namespace mimik::fuzzing
