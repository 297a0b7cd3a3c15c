#include "evaluation/case_row.h"

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/text.h"

namespace mimik::evaluation {

std::string variant_of(const std::string& method, double magnitude) {
    return magnitude == 1.0 ? method : fmt::format("{}@{}", method, magnitude);
}

std::string variant_of(const CaseKey& key) { return variant_of(key.method, key.magnitude); }

std::string_view case_row_header() {
    return "source,target,expression,method,magnitude,estimator,region,metric,value,unit,reason";
}

std::string encode_case_row(const CaseRow& row) {
    const auto& key = row.key;
    return fmt::format("{},{},{},{},{},{},{},{},{},{},{}", base::csv_field(key.source), base::csv_field(key.target),
                       base::csv_field(key.expression), base::csv_field(key.method), key.magnitude,
                       base::csv_field(row.estimator), base::csv_field(row.region), base::csv_field(row.metric),
                       row.value ? fmt::format("{}", *row.value) : "", base::csv_field(row.unit),
                       base::csv_field(row.reason));
}

std::optional<CaseRow> decode_case_row(const std::string& line) {
    constexpr std::size_t columns = 11;
    const auto number = [](std::string_view text) { return text.empty() ? std::nullopt : base::parse_double(text); };
    std::vector<std::string> fields;
    try {
        base::LineReader one_line(line, "a row");
        if (!one_line.next()) return std::nullopt;
        base::split_csv_line(one_line, fields);
    } catch (const InputError&) {
        return std::nullopt;  // quotes that do not close
    }
    if (fields.size() != columns) return std::nullopt;
    const auto magnitude = number(fields[4]);
    if (!magnitude) return std::nullopt;
    return CaseRow{{fields[0], fields[1], fields[2], fields[3], *magnitude},
                   fields[5],
                   fields[6],
                   fields[7],
                   number(fields[8]),
                   fields[9],
                   fields[10]};
}

}  // namespace mimik::evaluation
