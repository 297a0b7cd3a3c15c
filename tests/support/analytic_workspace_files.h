#pragma once

#include <filesystem>

#include "facs/facs_catalogue.h"
#include "preprocessing/preprocess_run.h"
#include "preprocessing/workspace.h"
#include "tests/support/analytic_database.h"

namespace mimik::test {

/// A preprocessed analytic database under `root`: three subjects with a neutral and a smile each.
inline preprocessing::Workspace analytic_workspace(const std::filesystem::path& root) {
    write_analytic_database(root / "db");
    preprocessing::PreprocessOptions options;
    options.steps.gridding.rows = options.steps.gridding.cols = 80;
    options.average.rows = options.average.cols = 60;
    (void)preprocessing::preprocess_database(database::open_database(root / "db"), root / "work",
                                             facs::builtin_catalogue(), options);
    return preprocessing::Workspace(root / "work");
}

}  // namespace mimik::test
