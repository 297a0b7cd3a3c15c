#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace mimik::database {

/// Whose face a file of ours shows, and of which database, by what it says itself: comments of PLY and OBJ, field data
/// of VTP, asset.extras of GLB, the sources of a model. The keys are "subjects" (with blanks between), "source" and
/// "target" (the names of scans in them), and "database".
struct FileOrigin {
    std::vector<std::string> subjects;  ///< sorted, each once
    std::string database;               ///< its mark (database/known_databases.h); empty: not said
    std::filesystem::path place;        ///< of the database on this machine; empty: not known
};

/// Reads the head of the file alone. Empty where the file says nothing, is not there, or is of another kind: who opens
/// it says what is wrong with it.
[[nodiscard]] FileOrigin origin_of(const std::filesystem::path& file);

/// The keys and values that say so in a file, for what is made of the faces of both.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> said_in_files(const FileOrigin& origin);
[[nodiscard]] FileOrigin united(const FileOrigin& one, const FileOrigin& other);

}  // namespace mimik::database
