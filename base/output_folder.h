#pragma once

#include <filesystem>

namespace mimik::base {

/// Finds out before the work that a folder (made where it is missing) takes files. Touches no file that is there.
/// @throws InputError as write_atomically.
void check_takes_files(const std::filesystem::path& folder);

/// The file that a name means in the end, there or not: writing it keeps the links and changes what they lead to.
/// @throws InputError if links lead in a circle.
[[nodiscard]] std::filesystem::path where_links_lead(const std::filesystem::path& file);

}  // namespace mimik::base
