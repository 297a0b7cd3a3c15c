#include "cli/expression_names.h"

#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "cli/command.h"

namespace mimik::cli {

facs::Expression expression_named(const preprocessing::Workspace& workspace, const facs::FacsCatalogue& catalogue,
                                  const std::string& typed) {
    const auto word = facs::parse_expression(typed);
    if (!word || !word->own_word() || catalogue.find_expression(typed)) return catalogue.expression(typed);
    std::set<std::string> own;
    for (const auto& scan : workspace.scans())
        if (!workspace.hidden(scan.subject) && scan.expression().own_word()) own.insert(scan.expression().code());
    if (own.contains(word->code())) return *word;
    try {
        return catalogue.expression(typed);
    } catch (const InputError& e) {
        if (own.empty()) throw;
        throw InputError(fmt::format("{}, nor a word of this workspace ({})", e.what(), fmt::join(own, ", ")));
    }
}

std::vector<facs::Expression> expressions_named(const preprocessing::Workspace& workspace,
                                                const facs::FacsCatalogue& catalogue, const std::string& option,
                                                const std::vector<std::string>& typed) {
    std::vector<facs::Expression> expressions;
    std::vector<std::string> codes;
    for (const auto& text : typed) {
        expressions.push_back(expression_named(workspace, catalogue, text));
        codes.push_back(expressions.back().code());
    }
    refuse_doubles(option, codes);
    return expressions;
}

}  // namespace mimik::cli
