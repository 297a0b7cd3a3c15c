#pragma once

#include "database/scan_database.h"

namespace mimik::database {

/// Names that later steps could not tell apart or keep: a subject called "mean" (the word for the mean of all
/// subjects), two subjects whose names differ by case alone (ids ignore it, folders do not), and paths with bytes that
/// are no UTF-8 (JSON files, where hidden lists, textures and the truth are found by their paths, cannot hold them).
/// @throws InputError naming file and mend.
void check_names(const ScanDatabase& database);

/// @throws InputError if JSON cannot hold the path; `what` stands before it: "the folder", "the scan".
void check_path_is_utf8(const std::filesystem::path& path, const char* what);

}  // namespace mimik::database
