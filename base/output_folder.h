#pragma once

#include <filesystem>

namespace mimik::base {

/// Finds out before the work that a folder (made where it is missing) takes files. @throws InputError as
/// write_atomically.
void check_takes_files(const std::filesystem::path& folder);

}  // namespace mimik::base
