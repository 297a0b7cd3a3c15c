#include "base/temporary.h"

#include <algorithm>
#include <cerrno>
#include <mutex>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace mimik::base {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view name_begin = ".mimik-", name_end = ".part";
constexpr std::size_t digits = 16;

/// No result depends on it, so it may differ from run to run.
std::string random_name() {
    static std::mutex mutex;
    static std::random_device device;
    const std::scoped_lock lock(mutex);
    return fmt::format("{}{:08x}{:08x}{}", name_begin, device() & 0xFFFFFFFFU, device() & 0xFFFFFFFFU, name_end);
}

bool is_temporary_name(std::string_view name) {
    if (name.size() != name_begin.size() + digits + name_end.size()) return false;
    if (!name.starts_with(name_begin) || !name.ends_with(name_end)) return false;
    return name.substr(name_begin.size(), digits).find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

[[noreturn]] void fail(const fs::path& path) { throw std::system_error(errno, std::generic_category(), path.string()); }

/// Whether the lock is ours, and what we locked still has its name: somebody may have taken it for a leftover.
bool locked(int descriptor, const fs::path& path) {
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return false;  // where there are no locks: ours
    struct stat open {
    }, named{};
    return ::fstat(descriptor, &open) == 0 && ::lstat(path.c_str(), &named) == 0 && open.st_ino == named.st_ino &&
           open.st_dev == named.st_dev;
}

void remove_leftovers_once(const fs::path& folder) {
    static std::mutex mutex;
    static std::set<fs::path> done;
    {
        const std::scoped_lock lock(mutex);
        if (!done.insert(folder).second) return;
    }
    remove_leftovers(folder);
}

/// `make(path)` gives a descriptor, or -1 and errno.
template <class Make>
int make_temporary(const fs::path& folder, fs::path& path, Make make) {
    remove_leftovers_once(folder);
    constexpr int most_tries = 100;
    for (int k = 0; k < most_tries; ++k) {
        path = folder / random_name();
        const int descriptor = make(path);
        if (descriptor < 0 && errno == EEXIST) continue;
        if (descriptor < 0) fail(path);
        if (locked(descriptor, path)) return descriptor;
        ::close(descriptor);
    }
    errno = EEXIST;
    fail(path);
}

void rename_to(const fs::path& from, const fs::path& to) {
    if (::rename(from.c_str(), to.c_str()) != 0) fail(to);
}

}  // namespace

TemporaryFile::TemporaryFile(const fs::path& folder) {
    descriptor_ = make_temporary(folder, path_, [](const fs::path& path) {
        return ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    });
}

TemporaryFile::~TemporaryFile() {
    if (!path_.empty()) ::unlink(path_.c_str());  // of a lost name: fails, as it should
    ::close(descriptor_);
}

void TemporaryFile::become(const fs::path& file) {
    rename_to(path_, file);
    path_.clear();
}

void TemporaryFile::lose_name() {
    const fs::path by_descriptor = fmt::format("/proc/self/fd/{}", descriptor_);
    if (::access(by_descriptor.c_str(), R_OK | W_OK) != 0) return;
    ::unlink(path_.c_str());
    path_ = by_descriptor;
}

TemporaryFolder::TemporaryFolder(const fs::path& folder) {
    descriptor_ = make_temporary(folder, path_, [](const fs::path& path) {
        if (::mkdir(path.c_str(), 0777) != 0) return -1;
        return ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    });
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
    ::close(descriptor_);
}

void TemporaryFolder::become(const fs::path& folder) {
    rename_to(path_, folder);
    path_.clear();
}

void remove_leftovers(const fs::path& folder) {
    std::error_code error;
    std::vector<fs::path> found;
    for (fs::directory_iterator it(folder.empty() ? fs::path(".") : folder, error), end; !error && it != end;
         it.increment(error))
        if (is_temporary_name(it->path().filename().string())) found.push_back(it->path());
    for (const auto& path : found) {
        const int descriptor = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
        if (descriptor < 0) continue;
        struct stat status {};
        const bool ours = ::fstat(descriptor, &status) == 0 && status.st_uid == ::geteuid() &&
                          (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode));
        if (ours && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) fs::remove_all(path, error);
        ::close(descriptor);
    }
}

}  // namespace mimik::base
