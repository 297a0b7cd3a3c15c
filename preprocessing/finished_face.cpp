#include "preprocessing/finished_face.h"

#include <algorithm>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/file.h"

namespace mimik::preprocessing {

namespace fs = std::filesystem;

namespace {

fs::path with_suffix(fs::path stem, const char* suffix) { return stem += suffix; }

constexpr std::string_view looked_for_mark = "looked for ";

/// What `.done` says of a face: what it was made from, how long its two files are, so that a file that was deleted or
/// cut short is noticed, and the state of the files that the scan's own file names: an image may come or change later.
std::string done_text(const fs::path& stem, const std::string& fingerprint, const std::vector<fs::path>& looked_for) {
    const auto size = [&](const char* suffix) {
        std::error_code error;
        const auto bytes = fs::file_size(with_suffix(stem, suffix), error);
        return error ? std::string("absent") : fmt::format("{}", bytes);
    };
    auto text = fmt::format("{}\nfiles {} {}\n", fingerprint, size(".ply"), size(".json"));
    for (const auto& file : looked_for)
        text += fmt::format("{}{}\n{}\n", looked_for_mark, file.string(), file_stamp(file));
    return text;
}

/// The files that the `.done` of a face names so. A name with a line break in it is not found again: that face is made
/// anew each time.
std::vector<fs::path> files_named_in(std::string_view done) {
    std::vector<fs::path> files;
    while (!done.empty()) {
        const auto line = done.substr(0, done.find('\n'));
        if (line.starts_with(looked_for_mark)) files.emplace_back(line.substr(looked_for_mark.size()));
        done.remove_prefix(std::min(line.size() + 1, done.size()));
    }
    return files;
}

std::string read_done(const fs::path& stem) { return base::read_text(with_suffix(stem, ".done"), 1 << 20); }

}  // namespace

std::string file_stamp(const fs::path& file) {
    std::error_code error;
    const auto size = fs::file_size(file, error);
    const auto time = fs::last_write_time(file, error);
    return error ? "absent" : fmt::format("{} {}", size, time.time_since_epoch().count());
}

bool finished(const fs::path& stem, const std::string& fingerprint) {
    const auto file = with_suffix(stem, ".done");
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return false;
    try {
        const auto done = read_done(stem);
        return done == done_text(stem, fingerprint, files_named_in(done));
    } catch (const InputError&) {
        return false;  // unreadable: made again
    }
}

void write_finished(const fs::path& stem, const Face& face, const std::string& fingerprint,
                    const std::vector<fs::path>& looked_for) {
    std::error_code ignored;
    fs::remove(with_suffix(stem, ".done"), ignored);
    write_face(stem, face);
    base::write_atomically(with_suffix(stem, ".done"), done_text(stem, fingerprint, looked_for));
}

std::optional<Face> read_finished(const fs::path& stem, const std::string& fingerprint) {
    if (!finished(stem, fingerprint)) return std::nullopt;
    try {
        return read_face(stem);
    } catch (const InputError&) {
        return std::nullopt;  // damaged: made again
    }
}

std::vector<fs::path> files_looked_for(const fs::path& stem) { return files_named_in(read_done(stem)); }

}  // namespace mimik::preprocessing
