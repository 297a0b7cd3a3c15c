#pragma once

#include <algorithm>
#include <filesystem>
#include <string>

#include "database/scan_id.h"

// Where the files of a workspace lie.

namespace mimik::preprocessing {

/// What a finished workspace holds; and the same as it was before the run that is writing it, or was stopped in it.
[[nodiscard]] inline std::filesystem::path list_file(const std::filesystem::path& root) {
    return root / "workspace.json";
}
[[nodiscard]] inline std::filesystem::path list_file_before(const std::filesystem::path& root) {
    return root / "workspace.before.json";
}
/// What the files of a workspace end with.
inline constexpr const char* written_suffixes[] = {".ply", ".json", ".done", ".txt", ".png"};
[[nodiscard]] inline std::filesystem::path faces_folder(const std::filesystem::path& root) { return root / "faces"; }
/// Of a face's files, without .ply, .json, .done.
[[nodiscard]] inline std::filesystem::path face_stem(const std::filesystem::path& root, const database::ScanId& id) {
    return faces_folder(root) / id.subject / id.name();
}
/// Of the average face's files, without .ply and .json.
[[nodiscard]] inline std::filesystem::path average_stem(const std::filesystem::path& root) {
    return root / "average" / "average_face";
}
/// Of what KeptRegistrations keeps.
[[nodiscard]] inline std::filesystem::path registered_folder(const std::filesystem::path& root) {
    return root / "registered";
}
[[nodiscard]] inline std::filesystem::path sheets_folder(const std::filesystem::path& root) { return root / "sheets"; }
/// A picture, the mark of what it was drawn from, and the folder of its parts while it is drawn.
inline constexpr const char* sheet_suffixes[] = {".png", ".done", ".parts"};

/// By the names as they are written: links and ".." are not followed.
[[nodiscard]] inline bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace mimik::preprocessing
