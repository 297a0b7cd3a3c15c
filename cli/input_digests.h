#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace mimik::cli {

/// Digests of files that were read before, by name and stamp (size and time of the file): every shard has to say of
/// which faces it is, and would read the whole workspace for it.
class InputDigests {
public:
    /// Nothing is known where there is no such file, or it is damaged.
    [[nodiscard]] static InputDigests read(const std::filesystem::path& file);
    /// Of the files as they are now, in parallel.
    [[nodiscard]] static InputDigests of(const std::vector<std::filesystem::path>& files);
    /// @throws InputError if it cannot be written.
    void write(const std::filesystem::path& file) const;

    /// Of a file, read anew where it is not known or was changed. From any thread. @throws InputError if it cannot be
    /// read.
    [[nodiscard]] std::string digest(const std::filesystem::path& file) const;

private:
    struct Known {
        std::string stamp, digest;
    };
    std::map<std::string, Known> known_;  // by the file's name and its folder's: "bs000/bs000_N_N_0.ply"
};

}  // namespace mimik::cli
