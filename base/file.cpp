#include "base/file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <locale>
#include <new>
#include <optional>
#include <streambuf>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "base/errors.h"
#include "base/temporary.h"
#include "base/text.h"

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
    Container content;
    try {
        content.resize(static_cast<std::size_t>(size));
    } catch (const std::bad_alloc&) {
        throw InputError(fmt::format("{}: there is not enough memory for its {} bytes", file.string(), size));
    }
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

/// Writes to an open file.
class DescriptorBuffer : public std::streambuf {
public:
    explicit DescriptorBuffer(int descriptor) : descriptor_(descriptor), buffer_(1 << 16) { reset(); }

protected:
    int overflow(int c) override {
        if (!flush()) return traits_type::eof();
        if (c != traits_type::eof()) sputc(static_cast<char>(c));
        return traits_type::not_eof(c);
    }
    std::streamsize xsputn(const char* text, std::streamsize size) override {
        if (size <= epptr() - pptr()) {
            std::memcpy(pptr(), text, static_cast<std::size_t>(size));
            pbump(static_cast<int>(size));
            return size;
        }
        return flush() && write(text, static_cast<std::size_t>(size)) ? size : 0;
    }
    int sync() override { return flush() ? 0 : -1; }

private:
    void reset() { setp(buffer_.data(), buffer_.data() + buffer_.size()); }
    bool flush() {
        const bool done = write(pbase(), static_cast<std::size_t>(pptr() - pbase()));
        reset();
        return done;
    }
    bool write(const char* text, std::size_t size) const {
        while (size > 0) {
            const auto written = ::write(descriptor_, text, size);
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) return false;
            text += written;
            size -= static_cast<std::size_t>(written);
        }
        return true;
    }

    int descriptor_;
    std::vector<char> buffer_;
};

/// A name that a terminal, a table or another file's header cannot hold is somebody's slip.
void check_name(const std::filesystem::path& file) {
    const auto name = file.filename().string();
    if (std::any_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }))
        throw InputError(fmt::format("{}: the file's name has a line break or another control character; give another",
                                     in_quotes(name)));
}

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

std::string file_stamp(const std::filesystem::path& file) {
    std::error_code error;
    const auto size = std::filesystem::file_size(file, error);
    if (error) return "absent";
    const auto time = std::filesystem::last_write_time(file, error);
    return error ? "absent" : fmt::format("{} {}", size, time.time_since_epoch().count());
}

bool is_there(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::exists(path, ignored);
}

void write_atomically(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write) {
    std::error_code error;
    check_name(file);
    if (file.filename().empty() || std::filesystem::is_directory(file, error))
        throw InputError(fmt::format("{}: is a folder; name the file to write", file.string()));
    if (const auto folder = file.parent_path(); !folder.empty()) {
        std::filesystem::create_directories(folder, error);
        if (error)
            throw InputError(
                fmt::format("{}: its folder cannot be made ({}); write elsewhere", file.string(), error.message()));
    }
    const auto refuse = [&](const char* what, int number, const char* mend) {
        const auto reason = number == 0 ? std::string() : fmt::format(" ({})", std::strerror(number));
        throw InputError(fmt::format("{}: {}{}; {}", file.string(), what, reason, mend));
    };
    // Two writers of one file have temporaries of their own; the last to finish wins, each with a whole file.
    std::optional<TemporaryFile> temporary;
    try {
        temporary.emplace(file.parent_path());
    } catch (const std::system_error& e) {
        refuse("cannot be written", e.code().value(), "check the folder's permissions");
    }
    DescriptorBuffer buffer(temporary->descriptor());
    std::ostream stream(&buffer);
    stream.imbue(std::locale::classic());
    write(stream);
    errno = 0;
    stream.flush();
    // Some file systems say only at a close that they have no room; the file itself stays open and locked.
    if (stream)
        if (const int copy = ::dup(temporary->descriptor()); copy < 0 || ::close(copy) != 0)
            stream.setstate(std::ios::failbit);
    if (!stream) refuse("could not be written to its end", errno, "is the disk full?");
    try {
        temporary->become(file);
    } catch (const std::system_error& e) {
        refuse("cannot be replaced", e.code().value(), "check the folder's permissions");
    }
}

void write_atomically(const std::filesystem::path& file, std::string_view content) {
    write_atomically(
        file, [&](std::ostream& out) { out.write(content.data(), static_cast<std::streamsize>(content.size())); });
}

}  // namespace mimik::base
