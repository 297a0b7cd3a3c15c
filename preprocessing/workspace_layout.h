#pragma once

#include <algorithm>
#include <filesystem>
#include <string>

#include "database/scan_id.h"

// Where the files of a workspace lie.

namespace mimik::preprocessing {

/// Of a face's files, without .ply, .json, .done.
[[nodiscard]] inline std::filesystem::path face_stem(const std::filesystem::path& root, const database::ScanId& id) {
    return root / "faces" / id.subject / id.name();
}
/// Of the average face's files, without .ply and .json.
[[nodiscard]] inline std::filesystem::path average_stem(const std::filesystem::path& root) {
    return root / "average" / "average_face";
}
[[nodiscard]] inline std::filesystem::path sheets_folder(const std::filesystem::path& root) { return root / "sheets"; }
/// A picture, the mark of what it was drawn from, and the folder of its parts while it is drawn.
inline constexpr const char* sheet_suffixes[] = {".png", ".done", ".parts"};

/// By the names as they are written: links and ".." are not followed.
[[nodiscard]] inline bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace mimik::preprocessing
