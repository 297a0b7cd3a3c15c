#include "evaluation/score.h"

#include <cmath>

#include "geometry/statistics.h"

namespace mimik::evaluation {
namespace {

/// The numbers of one case that scores are made of.
struct CaseNumbers {
    std::optional<double> zone_mm, face_mm, true_mm, step_mm;
    std::optional<double> lip_error_mm, still_skin_mm, peak_mm, true_peak_mm, lips_over_hole, face_over_hole;
    double left_out = 0;

    void take(const CaseRow& row) {
        if (row.estimator == "surface_distance" && row.metric == "mean")
            (row.region == "zone" ? zone_mm : face_mm) = row.value;
        else if (row.estimator == "true_distance" && row.metric == "mean")
            true_mm = row.value;
        else if (row.metric == "largest_step")
            step_mm = row.value;
        else if (row.metric == "left_out")
            left_out = row.value.value_or(0);
        else if (row.estimator == "lip_aperture" && row.metric == "error")
            lip_error_mm = row.value;
        else if (row.estimator == "still_skin" && row.metric == "mean")
            still_skin_mm = row.value;
        else if (row.estimator == "peak")
            (row.metric == "true" ? true_peak_mm : peak_mm) = row.value;
        else if (row.estimator == "over_hole" && row.metric == "vertices")
            (row.region == "mouth" ? lips_over_hole : face_over_hole) = row.value;
    }
};

/// A mean of numbers that are not known of every case.
struct Sum {
    double total = 0;
    std::size_t count = 0;

    void add(const std::optional<double>& value) {
        if (!value) return;
        total += *value;
        ++count;
    }
    [[nodiscard]] std::optional<double> mean() const {
        return count > 0 ? std::optional(total / static_cast<double>(count)) : std::nullopt;
    }
};

/// An error of rounding is no motion, and a share of it no number.
std::optional<double> explained(double error, double nothing) {
    return nothing > least_motion_mm ? std::optional(1 - error / nothing) : std::nullopt;
}

/// The cases of one method on one expression.
class Sums {
public:
    void add(const CaseNumbers& own, const CaseNumbers& nothing) {
        if (!own.zone_mm || !nothing.zone_mm) return;
        ++counts_.cases;
        error_.add(own.zone_mm);
        nothing_.add(nothing.zone_mm);
        whole_.add(own.face_mm);
        whole_nothing_.add(nothing.face_mm);
        true_error_.add(own.true_mm);
        true_nothing_.add(nothing.true_mm);
        step_.add(own.step_mm);
        counts_.left_out_vertices += static_cast<std::size_t>(own.left_out);
        still_skin_.add(own.still_skin_mm);
        lips_over_hole_.add(own.lips_over_hole);
        face_over_hole_.add(own.face_over_hole);
        if (own.lip_error_mm) lip_errors_mm_.push_back(std::abs(*own.lip_error_mm));
        if (own.peak_mm && own.true_peak_mm) {
            peak_.add(own.peak_mm);
            true_peak_.add(own.true_peak_mm);
        }
        if (const auto share = explained(*own.zone_mm, *nothing.zone_mm)) explained_.push_back(*share);
        if (*own.zone_mm > *nothing.zone_mm) ++counts_.worse_than_nothing;
    }

    [[nodiscard]] Score score() const {
        Score score = counts_;
        score.explained = explained(error_.total, nothing_.total);
        if (!explained_.empty()) score.explained_median = geometry::median(explained_);
        score.explained_whole = explained(whole_.total, whole_nothing_.total);
        score.error_mm = error_.mean();
        score.nothing_mm = nothing_.mean();
        score.true_error_mm = true_error_.mean();
        score.nothing_true_mm = true_nothing_.mean();
        score.largest_step_mm = step_.mean();
        if (!lip_errors_mm_.empty()) score.faults.lip_aperture_error_mm = geometry::median(lip_errors_mm_);
        score.faults.still_skin_mm = still_skin_.mean();
        if (true_peak_.total > least_motion_mm) score.faults.peak_ratio = peak_.total / true_peak_.total;
        score.faults.lips_over_hole = lips_over_hole_.mean();
        score.faults.face_over_hole = face_over_hole_.mean();
        return score;
    }

private:
    Score counts_;
    Sum error_, nothing_, whole_, whole_nothing_, true_error_, true_nothing_, step_;
    Sum still_skin_, peak_, true_peak_, lips_over_hole_, face_over_hole_;
    std::vector<double> explained_, lip_errors_mm_;
};

}  // namespace

ScoreTable scores_of(const std::function<void(const std::function<void(const CaseRow&)>&)>& read, Pairs pairs) {
    std::map<std::string, std::map<std::string, Sums>> sums;
    CaseKey key;
    CaseNumbers numbers, nothing;
    std::pair<std::string, std::string> nothing_of;  // target and expression
    bool any = false;
    const auto close_case = [&] {
        if (!any) return;
        if (key.method == baseline_method) {
            nothing = numbers;
            nothing_of = {key.target, key.expression};
        }
        // Rows that somebody sorted or filtered: another face's baseline is none.
        const bool own = nothing_of == std::pair(key.target, key.expression);
        sums[variant_of(key)][key.expression].add(numbers, own ? nothing : CaseNumbers());
    };
    read([&](const CaseRow& row) {
        if (row.estimator == run_estimator) return;
        const bool itself = row.key.source == row.key.target;
        if (row.key.method != baseline_method && itself != (pairs == Pairs::source_on_itself)) return;
        if (any && row.key == key) return numbers.take(row);
        close_case();
        key = row.key;
        numbers = {};
        any = true;
        numbers.take(row);
    });
    close_case();
    ScoreTable table;
    for (const auto& [method, expressions] : sums)
        for (const auto& [expression, sum] : expressions) table[method][expression] = sum.score();
    return table;
}

}  // namespace mimik::evaluation
