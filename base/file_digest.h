#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace mimik::base {

/// Length and hash of some bytes: what tells a damaged file from the one that was written. Quick (64 bits at a time),
/// the same on every machine, no defence against people who want two contents to look alike.
struct FileDigest {
    std::uint64_t bytes = 0;
    std::uint64_t hash = 0;

    [[nodiscard]] std::string text() const;  ///< "1234 00ff..." : length, and 16 hexadecimal digits
    bool operator==(const FileDigest&) const = default;
};

[[nodiscard]] FileDigest digest_of(std::string_view bytes);
/// @throws InputError if the file cannot be read.
[[nodiscard]] FileDigest digest_of_file(const std::filesystem::path& file);

}  // namespace mimik::base
