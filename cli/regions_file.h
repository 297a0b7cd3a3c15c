#pragma once

#include <filesystem>

#include "preprocessing/workspace.h"

namespace mimik::cli {

/// Where 'mimik regions' writes and 'mimik animate --hold' looks.
[[nodiscard]] inline std::filesystem::path default_regions_file(const preprocessing::Workspace& workspace) {
    return workspace.root() / "average" / "regions.csv";
}

}  // namespace mimik::cli
