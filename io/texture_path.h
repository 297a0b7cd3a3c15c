#pragma once

#include <string>

namespace mimik::io {

/// The texture's path from the folder of `file`, parts joined by '/', if it is in that folder or below it (a "./" is
/// dropped). @throws InputError naming `file` and the value where it leads elsewhere.
[[nodiscard]] std::string checked_texture_path(const std::string& texture, const std::string& file);

}  // namespace mimik::io
