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
                                  options, nullptr, workspace.registrations());

    const ExpressionGauge gauge(catalogue, expression, workspace.average(), options, workspace.registrations());
    ExpressionMean sum;
    std::vector<std::string> faults;
    bool any = false;
    struct Measured {
        std::optional<ExpressionModel> model;
        std::string fault;  // why there is none
    };
    base::in_batches(
        ids.size(),
        [&](std::size_t k) -> Measured {
            try {
                return {gauge.measure(workspace.face(workspace.neutral(ids[k].subject)), workspace.face(ids[k])), {}};
            } catch (const std::exception& e) {
                return {std::nullopt, fmt::format("{}: {}", ids[k].name(), e.what())};
            }
        },
        [&](Measured& measured) {
            if (!measured.model) return faults.push_back(std::move(measured.fault));
            sum.add(*measured.model);
            any = true;
        });
    if (!any) throw InputError(fmt::format("expression '{}': {}", expression.code(), fmt::join(faults, "; ")));
    auto mean = sum.mean();
    mean.unusable_scans = std::move(faults);
    return mean;
}

}  // namespace mimik::modeling
