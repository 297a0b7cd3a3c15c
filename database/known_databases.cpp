#include "database/known_databases.h"

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include <fmt/format.h>

#include "base/content_hash.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"

namespace mimik::database {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t digest_letters = 16;
constexpr std::uintmax_t longest_path = 1 << 16;

fs::path whole(const fs::path& root) {
    std::error_code error;
    auto path = fs::absolute(root, error).lexically_normal();
    return path.has_filename() ? path : path.parent_path();  // "db/" is "db"
}

std::string digest_of_path(const fs::path& path) {
    base::ContentHash hash;
    hash.add(path.string());
    return hash.text();
}

/// Empty without a cache.
fs::path memory_of(std::string_view digest) {
    const auto cache = user_cache_folder();
    return cache.empty() ? fs::path() : cache / "databases" / std::string(digest);
}

}  // namespace

fs::path user_cache_folder() {
    const char* cache = std::getenv("XDG_CACHE_HOME");
    const char* home = std::getenv("HOME");
    if (cache && fs::path(cache).is_absolute()) return fs::path(cache) / "mimik";
    return home && fs::path(home).is_absolute() ? fs::path(home) / ".cache" / "mimik" : fs::path();
}

std::string database_mark(const fs::path& root) {
    const auto path = whole(root);
    return fmt::format("{} ({})", path.filename().string(), digest_of_path(path));
}

std::string remember_database(const fs::path& root) {
    const auto path = whole(root);
    const auto mark = database_mark(path);
    const auto memory = memory_of(digest_of_path(path));
    try {
        if (!memory.empty() && database_of_mark(mark) != path) base::write_atomically(memory, path.string());
    } catch (const InputError&) {
        // A full disk, a home that takes no files: then the lists are looked for beside the file alone.
    }
    return mark;
}

fs::path database_of_mark(std::string_view mark) {
    if (const fs::path path = mark; path.is_absolute()) return path;
    constexpr std::size_t tail = digest_letters + 2;
    if (mark.size() < tail || mark[mark.size() - tail] != '(' || mark.back() != ')') return {};
    const auto digest = mark.substr(mark.size() - tail + 1, digest_letters);
    if (digest.find_first_not_of("0123456789abcdef") != std::string_view::npos) return {};
    try {
        const auto memory = memory_of(digest);
        if (memory.empty() || !base::is_there(memory)) return {};
        const fs::path path = base::read_text(memory, longest_path);
        return digest_of_path(path) == digest ? path : fs::path();
    } catch (const InputError&) {
        return {};
    }
}

}  // namespace mimik::database
