#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "builtin/builtin_expressions.h"
#include "facs/facs_catalogue.h"
#include "modeling/source_expression.h"
#include "preprocessing/workspace.h"

namespace mimik::cli {

/// Where a command takes expressions from: the scans of a workspace, or the faces that come with Mimik.
class ExpressionShelf {
public:
    /// @param workspace  empty: the faces that come with Mimik. @throws as preprocessing::Workspace
    explicit ExpressionShelf(const std::string& workspace);

    /// Null: the faces that come with Mimik.
    [[nodiscard]] const preprocessing::Workspace* workspace() const { return workspace_ ? &*workspace_ : nullptr; }
    [[nodiscard]] const preprocessing::AverageFace& average() const;
    /// @throws InputError listing what there is.
    [[nodiscard]] facs::Expression expression(const facs::FacsCatalogue& catalogue, const std::string& typed) const;
    /// What can be found out before any work. @throws InputError as modeling::check_source
    void check_source(const modeling::ExpressionSource& source, const modeling::ModelOptions& options) const;
    /// Whether somebody shows the expression.
    [[nodiscard]] bool shows(const facs::Expression& expression, const modeling::ExpressionSource& source) const;
    /// @throws as modeling::model_from_workspace and builtin::BuiltinExpressions::model.
    [[nodiscard]] modeling::ExpressionModel model(const facs::FacsCatalogue& catalogue,
                                                  const facs::Expression& expression,
                                                  const modeling::ExpressionSource& source,
                                                  const modeling::ModelOptions& options) const;
    /// A model that stands on the template of a workspace shares what is known of it.
    void share_registrations(modeling::ExpressionModel& model) const;
    /// @throws InputError if the subject must not be shown.
    void refuse_hidden(const std::string& subject) const;

private:
    [[nodiscard]] const builtin::BuiltinExpressions& builtin() const;

    std::optional<preprocessing::Workspace> workspace_;
    mutable std::unique_ptr<const builtin::BuiltinExpressions> builtin_;  ///< made when it is first needed
};

}  // namespace mimik::cli
