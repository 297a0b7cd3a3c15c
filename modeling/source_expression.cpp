#include "modeling/source_expression.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/errors.h"
#include "geometry/parallel.h"

namespace mimik::modeling {

using database::ScanId;
using preprocessing::Workspace;

namespace {

std::optional<ScanId> scan_that_shows(const Workspace& workspace, const std::string& subject,
                                      const std::string& expression) {
    if (auto id = workspace.expression(subject, expression)) return id;
    if (!expression.empty() && (expression.back() == 'L' || expression.back() == 'R'))
        return workspace.expression(subject, expression.substr(0, expression.size() - 1));
    return std::nullopt;
}

}  // namespace

ScanId source_scan(const Workspace& workspace, const std::string& subject, const std::string& expression) {
    (void)workspace.neutral(subject);  // names the subjects there are if this one is none of them
    if (auto id = scan_that_shows(workspace, subject, expression)) return *id;
    std::vector<std::string> codes;
    for (const auto& scan : workspace.scans())
        if (scan.subject == subject && !scan.neutral()) codes.push_back(scan.code);
    throw InputError(fmt::format("{}: subject '{}' has no scan of expression '{}'; there are: {}",
                                 workspace.root().string(), subject, expression, fmt::join(codes, ", ")));
}

ExpressionModel model_from_workspace(const Workspace& workspace, const FacsCatalogue& catalogue,
                                     const std::string& expression, const ExpressionSource& source,
                                     const ModelOptions& options) {
    workspace.refuse_hidden(source.subject);
    if (source.subject != "mean") {
        const auto scan = source_scan(workspace, source.subject, expression);
        return measure_expression(catalogue, expression, workspace.average(),
                                  workspace.face(workspace.neutral(source.subject)), workspace.face(scan), options);
    }

    std::vector<std::string> subjects;
    std::vector<ScanId> ids;
    for (const auto& subject : workspace.subjects()) {
        if (workspace.hidden(subject) ||
            std::find(source.excluded.begin(), source.excluded.end(), subject) != source.excluded.end())
            continue;
        if (const auto id = scan_that_shows(workspace, subject, expression)) {
            subjects.push_back(subject);
            ids.push_back(*id);
        }
    }
    if (subjects.empty())
        throw InputError(fmt::format("{}: no other subject shows expression '{}', so there is no mean",
                                     workspace.root().string(), expression));
    const ExpressionGauge gauge(catalogue, expression, workspace.average(), options);
    std::vector<std::optional<ExpressionModel>> measured(subjects.size());
    std::vector<std::string> faults(subjects.size());
    geometry::parallel_for(subjects.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) try {
                measured[k] = gauge.measure(workspace.face(workspace.neutral(subjects[k])), workspace.face(ids[k]));
            } catch (const std::exception& e) {
                faults[k] = fmt::format("{}: {}", ids[k].name(), e.what());
            }
    });
    std::vector<ExpressionModel> models;
    for (auto& model : measured)
        if (model) models.push_back(std::move(*model));
    if (models.empty()) throw InputError(fmt::format("expression '{}': {}", expression, fmt::join(faults, "; ")));
    auto mean = mean_expression(models);
    for (const auto& fault : faults)
        if (!fault.empty()) mean.left_out.push_back(fault);
    return mean;
}

}  // namespace mimik::modeling
