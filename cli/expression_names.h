#pragma once

#include <string>
#include <vector>

#include "facs/facs_catalogue.h"
#include "preprocessing/workspace.h"

namespace mimik::cli {

/// As FacsCatalogue::expression, or a word of the database's own that a scan of the workspace has. @throws InputError
/// listing what there is.
[[nodiscard]] facs::Expression expression_named(const preprocessing::Workspace& workspace,
                                                const facs::FacsCatalogue& catalogue, const std::string& typed);
/// Expressions as they were typed, each once. @throws InputError naming the option and the first that stands twice, or
/// as expression_named.
[[nodiscard]] std::vector<facs::Expression> expressions_named(const preprocessing::Workspace& workspace,
                                                              const facs::FacsCatalogue& catalogue,
                                                              const std::string& option,
                                                              const std::vector<std::string>& typed);

}  // namespace mimik::cli
