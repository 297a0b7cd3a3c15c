#pragma once

#include <filesystem>

// Files and folders that are not finished. Their names are chance (`.mimik-<16 hexadecimal digits>.part`), nothing that
// is there is opened or replaced, and links are not followed. Each is locked while its writer lives. What a writer left
// that was killed is known by its name and its missing lock; the next that makes a temporary in that folder removes it.

namespace mimik::base {

/// An empty file of its own; removed with the object unless it became another.
class TemporaryFile {
public:
    /// @param folder  that must be there; empty: the current one. @throws std::system_error if it takes no file.
    explicit TemporaryFile(const std::filesystem::path& folder);
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] int descriptor() const { return descriptor_; }
    /// Takes another name, and replaces what has it. @throws std::system_error.
    void become(const std::filesystem::path& file);
    /// Takes its name away, so that it is gone whatever ends the program; path() leads to it while the object lives.
    /// Where the system has no such paths it keeps its name.
    void lose_name();

private:
    std::filesystem::path path_;
    int descriptor_ = -1;
};

/// An empty folder of its own; removed with all that is in it unless it became another.
class TemporaryFolder {
public:
    /// As TemporaryFile. @throws std::system_error.
    explicit TemporaryFolder(const std::filesystem::path& folder);
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Takes another name; an empty folder of that name is replaced. @throws std::system_error.
    void become(const std::filesystem::path& folder);

private:
    std::filesystem::path path_;
    int descriptor_ = -1;
};

/// Removes what killed writers left in a folder. Temporaries do it by themselves, once a folder and process.
void remove_leftovers(const std::filesystem::path& folder);

}  // namespace mimik::base
