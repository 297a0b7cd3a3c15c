#include "evaluation/case_row.h"

#include <fmt/format.h>

#include "base/csv.h"

namespace mimik::evaluation {

std::string_view case_row_header() {
    return "source,target,expression,method,magnitude,estimator,region,metric,value,unit,reason";
}

std::string encode_case_row(const CaseRow& row) {
    const auto& key = row.key;
    return fmt::format("{},{},{},{},{},{},{},{},{},{},{}", base::csv_field(key.source), base::csv_field(key.target),
                       base::csv_field(key.expression), base::csv_field(key.method), key.magnitude, row.estimator,
                       row.region, row.metric, row.value ? fmt::format("{}", *row.value) : "", row.unit,
                       base::csv_field(row.reason));
}

}  // namespace mimik::evaluation
