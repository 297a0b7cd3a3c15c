#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace mimik::base {

/// The whole file. @throws InputError if it is missing, unreadable, a folder, or larger than `max_bytes` (the message
/// gives both sizes).
[[nodiscard]] std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file,
                                                   std::uintmax_t max_bytes = std::uintmax_t{1} << 31);
[[nodiscard]] std::string read_text(const std::filesystem::path& file,
                                    std::uintmax_t max_bytes = std::uintmax_t{1} << 28);

/// The first `max_bytes` bytes of a file that may be longer. @throws InputError if it is missing, unreadable or no
/// regular file.
[[nodiscard]] std::string read_text_head(const std::filesystem::path& file, std::size_t max_bytes);

/// Whether there is such a file or folder; no, too, where the system will not look for it (links in a circle, a name
/// too long, a folder that may not be entered).
[[nodiscard]] bool is_there(const std::filesystem::path& path);

/// A file that did not change has the same size and time: cheap to ask of thousands. "absent": there is none.
[[nodiscard]] std::string file_stamp(const std::filesystem::path& file);

/// Writes to a temporary beside `file`, then renames: nobody ever sees half a file. Folders are made. The stream has
/// the classic locale. @throws InputError naming the file if it cannot be written.
void write_atomically(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write);
void write_atomically(const std::filesystem::path& file, std::string_view content);

}  // namespace mimik::base
