#include "cli/terminal.h"

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <streambuf>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/text.h"

namespace mimik::cli {
namespace {

/// Bytes of the UTF-8 character that begins with `lead`; 1 for what begins none.
std::size_t bytes_of_character(unsigned char lead) {
    return lead < 0xC2 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : lead < 0xF5 ? 4 : 1;
}

std::uint32_t code_point(std::string_view character) {
    const auto first = static_cast<unsigned char>(character[0]);
    std::uint32_t code = first & (0x7FU >> character.size());
    for (const char c : character.substr(1)) code = code << 6U | (static_cast<unsigned char>(c) & 0x3FU);
    return code;
}

/// Controls beyond ASCII: C1, and those that turn the direction of a line or break it.
bool is_control(std::uint32_t code) {
    return (code >= 0x80 && code < 0xA0) || code == 0x61C || code == 0x200E || code == 0x200F ||
           (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

/// Appends what may be shown of `text`; without `ended` a character that is not whole yet is left.
/// @return how many bytes were taken.
std::size_t append_shown(std::string_view text, bool ended, std::string& shown) {
    std::size_t at = 0;
    while (at < text.size()) {
        const auto byte = static_cast<unsigned char>(text[at]);
        if (byte < 0x80) {
            ++at;
            // As JSON writes it: in a JSON document the others of these are written out already.
            if (byte == 0x7F)
                shown += "\\u007f";
            else if (byte < 0x20 && byte != '\n' && byte != '\t')
                shown += fmt::format("\\x{:02x}", byte);
            else
                shown += static_cast<char>(byte);
            continue;
        }
        const auto size = bytes_of_character(byte);
        if (at + size > text.size() && !ended) return at;
        const auto character = text.substr(at, size);
        if (size == 1 || character.size() < size || !base::is_utf8(character)) {
            shown += fmt::format("\\x{:02x}", byte);
            ++at;
            continue;
        }
        const auto code = code_point(character);
        shown += is_control(code) ? fmt::format("\\u{:04x}", code) : std::string(character);
        at += size;
    }
    return at;
}

/// Hands on what may be shown.
class ShownBuffer : public std::streambuf {
public:
    explicit ShownBuffer(std::streambuf* sink) : sink_(sink) {}
    [[nodiscard]] std::streambuf* sink() const { return sink_; }
    [[nodiscard]] int error() const { return error_; }

protected:
    int_type overflow(int_type c) override {
        if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
        const char byte = traits_type::to_char_type(c);
        return xsputn(&byte, 1) == 1 ? c : traits_type::eof();
    }
    std::streamsize xsputn(const char* text, std::streamsize count) override {
        waiting_.append(text, static_cast<std::size_t>(count));
        return hand_on(false) ? count : 0;
    }
    int sync() override {
        if (!hand_on(true)) return -1;
        errno = 0;
        const int result = sink_->pubsync();
        if (result != 0) error_ = errno;
        return result;
    }

private:
    bool hand_on(bool ended) {
        std::string shown;
        waiting_.erase(0, append_shown(waiting_, ended, shown));
        errno = 0;
        const auto size = static_cast<std::streamsize>(shown.size());
        if (sink_->sputn(shown.data(), size) == size) return true;
        error_ = errno;
        return false;
    }

    std::streambuf* sink_;
    std::string waiting_;
    int error_ = 0;
};

// Never destroyed: the streams are flushed after everything else.
ShownBuffer* output_guard = nullptr;
ShownBuffer* error_guard = nullptr;

ShownBuffer* guard(std::ostream& stream) {
    auto* buffer = new ShownBuffer(stream.rdbuf());  // NOLINT(cppcoreguidelines-owning-memory)
    stream.rdbuf(buffer);
    return buffer;
}

void say(int descriptor_colour, std::string_view begin, std::string_view text) {
    if (shows_colours(STDERR_FILENO))
        raw_error() << fmt::format("\033[1;{}m{}\033[0m ", descriptor_colour, begin) << std::flush;
    else
        std::cerr << begin << ' ';
    std::cerr << one_line(text) << '\n';
}

}  // namespace

void prepare_standard_streams() {
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(descriptor, F_GETFD) < 0 && errno == EBADF)
            // The lowest that is free: those below are open by now.
            if (::open("/dev/null", O_RDWR) != descriptor) std::abort();
    std::signal(SIGPIPE, SIG_IGN);  // NOLINT(cert-err33-c): it cannot fail
    if (output_guard) return;
    output_guard = guard(std::cout);
    error_guard = guard(std::cerr);
}

std::string one_line(std::string_view text) {
    std::string shown, line;
    append_shown(text, true, shown);
    for (const char c : shown)
        if (c == '\n')
            line += "\\n";
        else if (c == '\t')
            line += "\\t";
        else
            line += c;
    return line;
}

std::ostream& raw_output() {
    static std::ostream stream(output_guard ? output_guard->sink() : std::cout.rdbuf());
    return stream;
}

std::ostream& raw_error() {
    static std::ostream stream(error_guard ? error_guard->sink() : std::cerr.rdbuf());
    return stream;
}

bool output_reader_has_ended() { return output_guard && output_guard->error() == EPIPE; }

bool shows_colours(int descriptor) {
    if (::isatty(descriptor) == 0) return false;
    // NOLINTNEXTLINE(concurrency-mt-unsafe): nothing here sets variables
    const char *no_colour = std::getenv("NO_COLOR"), *terminal = std::getenv("TERM");
    return (!no_colour || *no_colour == '\0') && terminal && std::string_view(terminal) != "dumb";
}

void say_error(std::string_view program, std::string_view message) {
    constexpr int red = 31;
    say(red, fmt::format("{}:", program), message);
}

void say_note(std::string_view text) {
    constexpr int cyan = 36;
    say(cyan, "note:", text);
}

}  // namespace mimik::cli
