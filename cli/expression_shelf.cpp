#include "cli/expression_shelf.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "cli/expression_names.h"

namespace mimik::cli {

ExpressionShelf::ExpressionShelf(const std::string& workspace) {
    if (!workspace.empty()) workspace_.emplace(workspace);
}

const builtin::BuiltinExpressions& ExpressionShelf::builtin() const {
    if (!builtin_) builtin_ = std::make_unique<const builtin::BuiltinExpressions>();
    return *builtin_;
}

const preprocessing::AverageFace& ExpressionShelf::average() const {
    return workspace_ ? workspace_->average() : builtin().average();
}

facs::Expression ExpressionShelf::expression(const facs::FacsCatalogue& catalogue, const std::string& typed) const {
    return workspace_ ? expression_named(*workspace_, catalogue, typed) : catalogue.expression(typed);
}

void ExpressionShelf::check_source(const modeling::ExpressionSource& source,
                                   const modeling::ModelOptions& options) const {
    if (workspace_) return modeling::check_source(*workspace_, source, options);
    if (source.subject != "mean")
        throw InputError(fmt::format(
            "--source: '{}' is a subject of a workspace, and none is given; give WORK, or leave --source out",
            source.subject));
    if (!options.place_on_average)
        throw InputError("--method thesis: takes one source, and none is given; give WORK and --source");
}

bool ExpressionShelf::shows(const facs::Expression& expression, const modeling::ExpressionSource& source) const {
    if (!workspace_) return builtin().shows(expression);
    try {
        return !modeling::source_scans(*workspace_, expression, source).empty();
    } catch (const InputError&) {
        return false;
    }
}

modeling::ExpressionModel ExpressionShelf::model(const facs::FacsCatalogue& catalogue,
                                                 const facs::Expression& expression,
                                                 const modeling::ExpressionSource& source,
                                                 const modeling::ModelOptions& options) const {
    return workspace_ ? modeling::model_from_workspace(*workspace_, catalogue, expression, source, options)
                      : builtin().model(catalogue, expression, options);
}

void ExpressionShelf::share_registrations(modeling::ExpressionModel& model) const {
    if (!workspace_ || !model.dense) return;
    try {
        modeling::share_registrations(*model.dense, workspace_->registrations());
    } catch (const InputError&) {
        // The workspace's average face has no template: the model has its own.
    }
}

void ExpressionShelf::refuse_hidden(const std::string& subject) const {
    if (workspace_) workspace_->refuse_hidden(subject);
}

}  // namespace mimik::cli
