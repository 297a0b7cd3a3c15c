#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "preprocessing/workspace.h"

namespace mimik::report {

/// Draws a figure description (docs/figures.md) to a PNG. Empty: done; else what went wrong. The layers that can draw
/// supply it; called from several threads.
using DrawFigure =
    std::function<std::string(const std::filesystem::path& description, const std::filesystem::path& picture)>;

struct QualitySheetReport {
    std::size_t drawn = 0;
    std::size_t up_to_date = 0;
    std::vector<std::string> failures;  ///< by subject
};

/// sheets/bs000.png for every subject that may be shown: a panel per scan, brought to the subject's first neutral, with
/// its landmarks and with bridged surface in another colour. A sheet is drawn again when one of its faces was made
/// anew, came or went; the sheet of a subject who must not be shown any more is deleted.
/// @param progress  called once per subject, from any thread; may be empty.
[[nodiscard]] QualitySheetReport draw_quality_sheets(
    const preprocessing::Workspace& workspace, const DrawFigure& draw,
    const std::function<void(const std::string& subject)>& progress = {});

}  // namespace mimik::report
