#pragma once

#include <string>
#include <vector>

#include "facs/facs_catalogue.h"
#include "modeling/expression_model.h"
#include "preprocessing/workspace.h"

namespace mimik::modeling {

/// Where an expression comes from: one subject, or the mean of all subjects that show it.
struct ExpressionSource {
    std::string subject;                ///< "bs003"; or "mean"
    std::vector<std::string> excluded;  ///< subjects that a mean leaves out: the target
};

/// The scan of `subject` that an expression is taken from: of it, or for one side ("12L") of both sides, if the subject
/// was not asked for one.
/// @throws InputError if the subject or the expression is missing, listing what there is.
[[nodiscard]] database::ScanId source_scan(const preprocessing::Workspace& workspace, const std::string& subject,
                                           const facs::Expression& expression);

/// What can be found out about a source before any work. @throws InputError if the subject must not be shown, or where
/// a mean is asked for and `options` place the points on each source's own face, as the thesis does.
void check_source(const preprocessing::Workspace& workspace, const ExpressionSource& source,
                  const ModelOptions& options);

/// The scans that an expression is taken from, found out without reading them: one, or all that go into a mean.
/// @throws InputError as model_from_workspace.
[[nodiscard]] std::vector<database::ScanId> source_scans(const preprocessing::Workspace& workspace,
                                                         const facs::Expression& expression,
                                                         const ExpressionSource& source);

/// The model of an expression from the scans of a workspace. A one-sided AU is taken from the subject's one-sided scan
/// if there is one, else from that side of the two-sided scan (thesis 6, asymmetric AUs). Subjects who must not be
/// shown (unallowed_subjects.txt) are never a source, nor part of a mean. Scans that a mean could not use are in
/// `unusable_scans`, with the reason; the mean is of the others.
/// @throws InputError if a subject, its neutral or its expression is missing (the message lists what there is), or no
/// scan of a mean can be used.
[[nodiscard]] ExpressionModel model_from_workspace(const preprocessing::Workspace& workspace,
                                                   const facs::FacsCatalogue& catalogue,
                                                   const facs::Expression& expression, const ExpressionSource& source,
                                                   const ModelOptions& options = {});

}  // namespace mimik::modeling
