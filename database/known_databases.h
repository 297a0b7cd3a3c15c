#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mimik::database {

// A file that is passed on says of which database it is, so that whom its lists hide stays hidden, and publishes no
// folder of anybody's machine: it has the folder's last name and a digest of its path, "bosphorus (0123456789abcdef)".
// Where that is on this machine is kept in the user's cache.

/// $XDG_CACHE_HOME/mimik, else $HOME/.cache/mimik; empty if neither variable is set.
[[nodiscard]] std::filesystem::path user_cache_folder();

/// What files say of the database in this folder.
[[nodiscard]] std::string database_mark(const std::filesystem::path& root);
/// The same, and keeps where it lies. A cache that cannot be written is done without.
std::string remember_database(const std::filesystem::path& root);
/// Where the database of a mark lies; empty if nobody remembers. Files of earlier versions say the path itself.
[[nodiscard]] std::filesystem::path database_of_mark(std::string_view mark);

}  // namespace mimik::database
