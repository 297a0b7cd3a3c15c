#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mimik::io {

/// The texture's path from the folder of `file`, parts joined by '/', if it is in that folder or below it (a "./" is
/// dropped). @throws InputError naming `file` and the value where it leads elsewhere.
[[nodiscard]] std::string checked_texture_path(const std::string& texture, const std::string& file);

/// Where the file lies that a mesh or material file names: from `folder`, parts joined by '/', in that folder or below
/// it. Files come from other machines: backslashes count as '/', drives, roots and what stands before a ".." are left
/// out, then folders from the left until a file of that name is there; capitals may differ, and "%20" may be a blank.
/// Empty: there is none.
[[nodiscard]] std::string find_beside(const std::filesystem::path& folder, std::string_view written);

/// Whether a file is, also where links lead, in `folder` or below it.
[[nodiscard]] bool lies_below(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace mimik::io
