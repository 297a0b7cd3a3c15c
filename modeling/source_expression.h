#pragma once

#include <string>
#include <vector>

#include "modeling/expression_model.h"
#include "modeling/facs_catalogue.h"
#include "preprocessing/workspace.h"

namespace mimik::modeling {

/// Where an expression comes from: one subject, or the mean of all subjects that show it.
struct ExpressionSource {
    std::string subject;                ///< "bs003"; or "mean"
    std::vector<std::string> excluded;  ///< subjects that a mean leaves out: the target
};

/// The scan of `subject` that an expression is taken from: of it, or for one side ("12L") of both sides, if the subject
/// was not asked for one. @param expression  a code as scans bear it (FacsCatalogue::code). @throws InputError if the
/// subject or the expression is missing, listing what there is.
[[nodiscard]] database::ScanId source_scan(const preprocessing::Workspace& workspace, const std::string& subject,
                                           const std::string& expression);

/// The model of an expression ("12", "AU12_L", "happy": as FacsCatalogue::code reads it) from the scans of a workspace.
/// A one-sided AU is taken from the subject's one-sided scan if there is one, else from that side of the two-sided scan
/// (thesis 6, asymmetric AUs). Subjects who must not be shown (unallowed_subjects.txt) are never a source, nor part of
/// a mean.
/// @throws InputError if a subject, its neutral or its expression is missing; the message lists what there is.
[[nodiscard]] ExpressionModel model_from_workspace(const preprocessing::Workspace& workspace,
                                                   const FacsCatalogue& catalogue, const std::string& expression,
                                                   const ExpressionSource& source, const ModelOptions& options = {});

}  // namespace mimik::modeling
