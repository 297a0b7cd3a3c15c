#pragma once

#include <compare>
#include <optional>
#include <string>
#include <string_view>

namespace mimik::evaluation {

/// One case: an expression of a source, put on a target by a method.
struct CaseKey {
    std::string source;  ///< a subject; "mean" of all but the target; empty: none is needed
    std::string target;
    std::string expression;  ///< its code: "12L"
    std::string method;
    double magnitude = 1.0;

    bool operator==(const CaseKey&) const = default;
};

/// One number of one case. Everything that is reported is a pure function of rows.
struct CaseRow {
    CaseKey key;
    std::string estimator;        ///< who measured: "surface_distance", "true_distance", "field"
    std::string region;           ///< where: "zone", "face"
    std::string metric;           ///< what: "mean", "largest_step", "left_out"
    std::optional<double> value;  ///< empty: not known
    std::string unit;             ///< "mm", "vertices"
    std::string reason;           ///< why the value is not known, or what is odd about it; else empty

    bool operator==(const CaseRow&) const = default;
};

/// The method and, where it is not 1, the magnitude: "mean", "mean@0.8". Scores of different magnitudes are never
/// mixed.
[[nodiscard]] std::string variant_of(const CaseKey& key);
[[nodiscard]] std::string variant_of(const std::string& method, double magnitude);

/// The estimator's name in rows that say how an experiment went, not how true a face is: what failed, what is worth
/// knowing, how many take part. No score is made of them.
inline constexpr std::string_view run_estimator = "run";

/// "source,target,expression,method,magnitude,estimator,region,metric,value,unit,reason"
[[nodiscard]] std::string_view case_row_header();
/// One line of CSV without its end; numbers with all their digits.
[[nodiscard]] std::string encode_case_row(const CaseRow& row);
/// Empty where the line is none: other columns, quotes that do not close, a magnitude that is no number.
[[nodiscard]] std::optional<CaseRow> decode_case_row(const std::string& line);

}  // namespace mimik::evaluation
