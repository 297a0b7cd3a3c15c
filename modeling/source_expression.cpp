#include "modeling/source_expression.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/parallel.h"

namespace mimik::modeling {

using database::ScanId;
using preprocessing::Workspace;

namespace {

std::optional<ScanId> scan_that_shows(const Workspace& workspace, const std::string& subject,
                                      const facs::Expression& expression) {
    if (auto id = workspace.scan_of(subject, expression)) return id;
    const auto both = expression.on_both_sides();
    return both ? workspace.scan_of(subject, *both) : std::nullopt;
}

}  // namespace

ScanId source_scan(const Workspace& workspace, const std::string& subject, const facs::Expression& expression) {
    (void)workspace.neutral(subject);  // names the subjects there are if this one is none of them
    if (auto id = scan_that_shows(workspace, subject, expression)) return *id;
    std::vector<std::string> codes;
    for (const auto& scan : workspace.scans())
        if (scan.subject == subject && !scan.neutral()) codes.push_back(scan.code);
    throw InputError(fmt::format("{}: subject '{}' has no scan of expression '{}'; there are: {}",
                                 workspace.root().string(), subject, expression.code(), fmt::join(codes, ", ")));
}

void check_source(const Workspace& workspace, const ExpressionSource& source, const ModelOptions& options) {
    workspace.refuse_hidden(source.subject);
    if (source.subject != "mean" || options.place_on_average) return;
    auto subjects = workspace.shown_subjects();
    std::erase_if(subjects, [&](const std::string& subject) {
        return std::find(source.excluded.begin(), source.excluded.end(), subject) != source.excluded.end();
    });
    throw InputError(
        fmt::format("source 'mean': the thesis method has no mean (the thesis wished for it as future work; the "
                    "default method has it); give --source, one of {}",
                    fmt::join(subjects, ", ")));
}

std::vector<ScanId> source_scans(const Workspace& workspace, const facs::Expression& expression,
                                 const ExpressionSource& source) {
    if (source.subject != "mean") return {source_scan(workspace, source.subject, expression)};
    std::vector<ScanId> ids;
    for (const auto& subject : workspace.shown_subjects()) {
        if (std::find(source.excluded.begin(), source.excluded.end(), subject) != source.excluded.end()) continue;
        if (const auto id = scan_that_shows(workspace, subject, expression)) ids.push_back(*id);
    }
    if (ids.empty())
        throw InputError(fmt::format("{}: no other subject shows expression '{}', so there is no mean",
                                     workspace.root().string(), expression.code()));
    return ids;
}

ExpressionModel model_from_workspace(const Workspace& workspace, const facs::FacsCatalogue& catalogue,
                                     const facs::Expression& expression, const ExpressionSource& source,
                                     const ModelOptions& options) {
    check_source(workspace, source, options);
    const auto ids = source_scans(workspace, expression, source);
    if (source.subject != "mean")
        return measure_expression(catalogue, expression, workspace.average(),
                                  workspace.face(workspace.neutral(source.subject)), workspace.face(ids.front()),
                                  options);

    const ExpressionGauge gauge(catalogue, expression, workspace.average(), options);
    ExpressionMean sum;
    std::vector<std::string> faults;
    bool any = false;
    // In batches: only the sum stays, added in the order of the subjects.
    constexpr std::size_t batch = 16;
    for (std::size_t begin = 0; begin < ids.size(); begin += batch) {
        std::vector<std::optional<ExpressionModel>> measured(std::min(batch, ids.size() - begin));
        std::vector<std::string> fault(measured.size());
        base::parallel_for(measured.size(), 1, [&](std::size_t first, std::size_t last) {
            for (std::size_t k = first; k < last; ++k) try {
                    measured[k] = gauge.measure(workspace.face(workspace.neutral(ids[begin + k].subject)),
                                                workspace.face(ids[begin + k]));
                } catch (const std::exception& e) {
                    fault[k] = fmt::format("{}: {}", ids[begin + k].name(), e.what());
                }
        });
        for (std::size_t k = 0; k < measured.size(); ++k)
            if (measured[k]) {
                sum.add(*measured[k]);
                any = true;
            } else {
                faults.push_back(fault[k]);
            }
    }
    if (!any) throw InputError(fmt::format("expression '{}': {}", expression.code(), fmt::join(faults, "; ")));
    auto mean = sum.mean();
    mean.unusable_scans = std::move(faults);
    return mean;
}

}  // namespace mimik::modeling
