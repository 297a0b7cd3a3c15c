#include "evaluation/performance.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "base/errors.h"
#include "geometry/landmark_spline.h"
#include "preprocessing/nearest_on_average.h"

namespace mimik::evaluation {

using database::ScanId;

PerformanceReader::PerformanceReader(const preprocessing::Workspace& workspace) : workspace_(workspace) {
    const auto file = workspace.database_root() / "truth" / "truth.json";
    if (std::filesystem::exists(file))
        truth_ = database::open_truth(workspace.database_root());
    else if (workspace.made_with_truth())
        throw InputError(
            fmt::format("{}: is not there, though workspace {} was made from a database with a truth; put the database "
                        "back, or run 'mimik preprocess DB -o {}' with the place where it is now",
                        file.string(), workspace.root().string(), workspace.root().string()));
}

std::optional<TruthOrigin> PerformanceReader::truth_origin() const {
    if (!truth_) return std::nullopt;
    TruthOrigin origin{truth_->seed, truth_->face_model, truth_->expressions, truth_->subjects.size(), 0,
                       false,        truth_->variances,  truth_->scanner};
    for (const auto& scan : truth_->scans)
        if (scan.neutral())
            origin.neutrals = std::max(origin.neutrals, scan.repetition + 1);
        else
            origin.repeat = origin.repeat || scan.repetition > 0;
    return origin;
}

std::string PerformanceReader::check_neutral(const std::string& subject) const {
    const auto neutral = workspace_.face(workspace_.neutral(subject));
    const geometry::LandmarkPairs pairs(workspace_.average().landmarks, neutral.landmarks);
    (void)pairs.fit();
    if (truth_) (void)database::load_true_scan(*truth_, neutral.id);
    return preprocessing::without_partner(neutral, workspace_.average());
}

modeling::Performance PerformanceReader::read(const ScanId& expressive) const {
    modeling::Performance own;
    own.neutral = workspace_.face(workspace_.neutral(expressive.subject));
    own.expressive = workspace_.face(expressive);
    own.neutral_from_expressive = own.expressive.neutral_from_scan;
    if (!truth_) return own;
    own.true_neutral = database::load_true_scan(*truth_, own.neutral.id);
    own.true_expression = true_expression(expressive, *own.true_neutral);
    own.neutral_from_expressive =
        own.true_neutral->scanner_from_head * own.true_expression->scanner_from_head.inverse(Eigen::Isometry);
    return own;
}

database::TrueScan PerformanceReader::true_expression(const ScanId& expressive,
                                                      const database::TrueScan& neutral) const {
    auto scan = database::load_true_scan(*truth_, expressive);
    for (std::size_t v = 0; v < scan.displacement_mm.size(); ++v) scan.displacement_mm[v] -= neutral.displacement_mm[v];
    return scan;
}

std::optional<ScanTwice> PerformanceReader::second_scan(const ScanId& first) const {
    const auto& scans = workspace_.scans();
    const auto next = std::find_if(scans.begin(), scans.end(), [&](const ScanId& id) {
        return id.subject == first.subject && id.group == first.group && id.code == first.code &&
               id.repetition > first.repetition;
    });
    if (next == scans.end()) return std::nullopt;
    ScanTwice pair{workspace_.face(first), workspace_.face(*next)};
    if (truth_)
        pair.first_from_second = database::load_true_scan(*truth_, first).scanner_from_head *
                                 database::load_true_scan(*truth_, *next).scanner_from_head.inverse(Eigen::Isometry);
    else
        pair.first_from_second = pair.first.neutral_from_scan.inverse() * pair.second.neutral_from_scan;
    return pair;
}

void FailureList::add(std::string what) {
    const std::scoped_lock lock(mutex_);
    failures_.push_back(std::move(what));
}

std::vector<std::string> FailureList::sorted() const {
    const std::scoped_lock lock(mutex_);
    auto all = failures_;
    std::sort(all.begin(), all.end());
    return all;
}

}  // namespace mimik::evaluation
