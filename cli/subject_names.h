#pragma once

#include <string>

#include "base/text.h"
#include "preprocessing/workspace.h"

namespace mimik::cli {

/// A subject as the workspace spells it: case does not matter where one is typed. What is no subject stays as typed,
/// for the message that says so.
[[nodiscard]] inline std::string subject_named(const preprocessing::Workspace& workspace, const std::string& typed) {
    for (auto& subject : workspace.subjects())
        if (base::equal_ignoring_case(subject, typed)) return subject;
    return typed;
}

}  // namespace mimik::cli
