#pragma once

#include <filesystem>
#include <memory>

namespace mimik::base {

/// A folder has one writer or any number of readers. The lock belongs to the process and ends with it however it ends,
/// so none is ever left over, and no file is made for it (flock on the folder itself). Within a process readers stand
/// beside a writer, since they know of each other; a second writer is refused there, too. Where the file system knows
/// no locks (some network drives) nobody is kept out.
class FolderLock {
public:
    enum class Use { read, write };

    /// Does not wait. @throws InputError saying who is in the way, or that the folder cannot be opened.
    FolderLock(const std::filesystem::path& folder, Use use);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    struct Held;
    std::shared_ptr<Held> held_;
    Use use_;
};

}  // namespace mimik::base
