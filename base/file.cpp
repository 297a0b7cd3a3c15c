#include "base/file.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <locale>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "base/errors.h"

namespace mimik::base {
namespace {

/// @throws InputError unless it is a regular file.
std::uintmax_t size_of(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status))
        throw InputError(fmt::format("{}: there is no such file; check the path", file.string()));
    if (std::filesystem::is_directory(status))
        throw InputError(fmt::format("{}: is a folder; name a file in it", file.string()));
    if (!std::filesystem::is_regular_file(status))
        throw InputError(fmt::format("{}: is not a regular file (a device or a pipe); copy its content to a file first",
                                     file.string()));
    const auto size = std::filesystem::file_size(file, error);
    if (error) throw InputError(fmt::format("{}: its size cannot be read ({})", file.string(), error.message()));
    return size;
}

template <class Container>
Container read_first(const std::filesystem::path& file, std::uintmax_t size) {
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError(fmt::format("{}: cannot be opened ({})", file.string(), std::strerror(errno)));
    Container content(static_cast<std::size_t>(size), typename Container::value_type{});
    stream.read(reinterpret_cast<char*>(content.data()), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(stream.gcount()) != size)
        throw InputError(fmt::format("{}: only {} of its {} bytes could be read; is another program writing it?",
                                     file.string(), stream.gcount(), size));
    return content;
}

template <class Container>
Container read_whole(const std::filesystem::path& file, std::uintmax_t max_bytes) {
    const auto size = size_of(file);
    if (size > max_bytes)
        throw InputError(
            fmt::format("{}: has {} bytes, more than the {} that such a file may have; is it the right file?",
                        file.string(), size, max_bytes));
    return read_first<Container>(file, size);
}

/// Removes the temporary unless it was renamed away.
class TemporaryFile {
public:
    explicit TemporaryFile(std::filesystem::path path) : path_(std::move(path)) {}
    ~TemporaryFile() {
        std::error_code ignored;
        if (!path_.empty()) std::filesystem::remove(path_, ignored);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    void keep() { path_.clear(); }

private:
    std::filesystem::path path_;
};

}  // namespace

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file, std::uintmax_t max_bytes) {
    return read_whole<std::vector<std::uint8_t>>(file, max_bytes);
}

std::string read_text(const std::filesystem::path& file, std::uintmax_t max_bytes) {
    return read_whole<std::string>(file, max_bytes);
}

std::string read_text_head(const std::filesystem::path& file, std::size_t max_bytes) {
    return read_first<std::string>(file, std::min<std::uintmax_t>(size_of(file), max_bytes));
}

bool is_there(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::exists(path, ignored);
}

void write_atomically(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write) {
    std::error_code error;
    if (file.filename().empty() || std::filesystem::is_directory(file, error))
        throw InputError(fmt::format("{}: is a folder; name the file to write", file.string()));
    if (const auto folder = file.parent_path(); !folder.empty()) {
        std::filesystem::create_directories(folder, error);
        if (error)
            throw InputError(
                fmt::format("{}: its folder cannot be made ({}); write elsewhere", file.string(), error.message()));
    }
    // Process and counter keep two writers of one file apart; the last to finish wins, each with a whole file.
    static std::atomic<unsigned> counter{0};
    auto path = file;
    path += fmt::format(".{}-{}.part", ::getpid(), counter.fetch_add(1));
    TemporaryFile temporary(std::move(path));

    errno = 0;
    std::ofstream stream(temporary.path(), std::ios::binary | std::ios::trunc);
    if (!stream)
        throw InputError(fmt::format("{}: cannot be written ({}); check the folder's permissions", file.string(),
                                     std::strerror(errno)));
    stream.imbue(std::locale::classic());
    write(stream);
    errno = 0;
    stream.close();
    if (!stream)
        throw InputError(fmt::format("{}: could not be written to its end{}; is the disk full?", file.string(),
                                     errno == 0 ? std::string() : fmt::format(" ({})", std::strerror(errno))));
    std::filesystem::rename(temporary.path(), file, error);
    if (error)
        throw InputError(
            fmt::format("{}: cannot be replaced ({}); check the folder's permissions", file.string(), error.message()));
    temporary.keep();
}

void write_atomically(const std::filesystem::path& file, std::string_view content) {
    write_atomically(
        file, [&](std::ostream& out) { out.write(content.data(), static_cast<std::streamsize>(content.size())); });
}

}  // namespace mimik::base
