#include "base/folder_lock.h"

#include <cerrno>
#include <cstring>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/errors.h"

namespace mimik::base {

/// The one descriptor that a process has for a folder's lock.
struct FolderLock::Held {
    int descriptor = -1;
    bool writer = false;

    explicit Held(int folder) : descriptor(folder) {}
    ~Held() { ::close(descriptor); }
    Held(const Held&) = delete;
    Held& operator=(const Held&) = delete;
};

namespace {

using Key = std::tuple<pid_t, dev_t, ino_t>;  // a process that was forked off is another one

std::mutex& registry_mutex() {
    static std::mutex mutex;
    return mutex;
}

/// @return false: another process is in the way.
bool lock(int descriptor, int operation) {
    while (::flock(descriptor, operation | LOCK_NB) != 0) {
        if (errno == EINTR) continue;
        return errno != EWOULDBLOCK;  // anything else: this file system has no locks
    }
    return true;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder, Use use) : use_(use) {
    static std::map<Key, std::weak_ptr<Held>> registry;
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0)
        throw InputError(fmt::format("{}: the folder cannot be opened ({}); check its permissions", folder.string(),
                                     std::strerror(errno)));
    auto opened = std::make_shared<Held>(descriptor);
    struct stat status {};
    if (::fstat(descriptor, &status) != 0)
        throw InputError(fmt::format("{}: the folder cannot be looked at ({}); check its permissions", folder.string(),
                                     std::strerror(errno)));
    const std::scoped_lock guard(registry_mutex());
    std::erase_if(registry, [](const auto& entry) { return entry.second.expired(); });
    auto& known = registry[{::getpid(), status.st_dev, status.st_ino}];
    held_ = known.lock();
    const bool first = !held_;
    if (first) held_ = std::move(opened);
    if (use == Use::read) {
        if (first && !lock(held_->descriptor, LOCK_SH))
            throw InputError(fmt::format("{}: another mimik process is writing this folder; wait until it has ended",
                                         folder.string()));
    } else {
        if (held_->writer)
            throw InputError(
                fmt::format("{}: another thread of this program is writing this folder; wait until it "
                            "has ended",
                            folder.string()));
        if (!lock(held_->descriptor, LOCK_EX)) {
            // A refused change of a lock may have given up the one that there was.
            const bool only_readers = lock(held_->descriptor, LOCK_SH);
            throw InputError(fmt::format("{}: another mimik process is {} this folder; wait until it has ended",
                                         folder.string(), only_readers ? "reading" : "writing"));
        }
        held_->writer = true;
    }
    known = held_;
}

FolderLock::~FolderLock() {
    if (!held_ || use_ == Use::read) return;
    const std::scoped_lock guard(registry_mutex());
    held_->writer = false;
    if (held_.use_count() > 1) (void)lock(held_->descriptor, LOCK_SH);  // readers of this process remain
}

}  // namespace mimik::base
