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

/// What `.done` says of a face: what it was made from, length and hash of its two files as they were written (a file
/// that was deleted, cut short or damaged since is noticed), and the state of the files that the scan's own file names.
std::string done_text(const std::string& fingerprint, const FaceDigests& digests,
                      const std::vector<LookedFor>& looked_for) {
    auto text = fmt::format("{}\nfiles {} {}{}\n", fingerprint, digests.ply.text(), digests.json.text(),
                            digests.png ? " " + digests.png->text() : "");
    for (const auto& [file, stamp] : looked_for)
        text += fmt::format("{}{}\n{}\n", looked_for_mark, file.string(), stamp);
    return text;
}

/// The files that the `.done` of a face names so. A name with a line break in it is not found again: that face is made
/// anew each time.
std::vector<LookedFor> files_named_in(std::string_view done) {
    std::vector<LookedFor> files;
    bool stamp_follows = false;
    while (!done.empty()) {
        const auto line = done.substr(0, done.find('\n'));
        if (stamp_follows) files.back().stamp = line;
        stamp_follows = !stamp_follows && line.starts_with(looked_for_mark);
        if (stamp_follows) files.push_back({fs::path(line.substr(looked_for_mark.size())), {}});
        done.remove_prefix(std::min(line.size() + 1, done.size()));
    }
    return files;
}

std::string read_done(const fs::path& stem) { return base::read_text(with_suffix(stem, ".done"), 1 << 20); }

/// Reads the files to their ends. A picture that came from elsewhere counts, too: then it is not what was written.
FaceDigests digests_of(const fs::path& stem) {
    FaceDigests digests{base::digest_of_file(with_suffix(stem, ".ply")),
                        base::digest_of_file(with_suffix(stem, ".json"))};
    if (const auto own = with_suffix(stem, ".png"); base::is_there(own)) digests.png = base::digest_of_file(own);
    return digests;
}

}  // namespace

bool finished(const fs::path& stem, const std::string& fingerprint) {
    const auto file = with_suffix(stem, ".done");
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return false;
    try {
        const auto done = read_done(stem);
        if (!done.starts_with(fingerprint + "\n")) return false;  // no need to read the rest
        auto looked_for = files_named_in(done);
        for (auto& one : looked_for) one.stamp = base::file_stamp(one.file);
        return done == done_text(fingerprint, digests_of(stem), looked_for);
    } catch (const InputError&) {
        return false;  // unreadable or gone: made again
    }
}

void write_finished(const fs::path& stem, const Face& face, const std::string& fingerprint,
                    const std::vector<LookedFor>& looked_for) {
    std::error_code ignored;
    fs::remove(with_suffix(stem, ".done"), ignored);
    const auto digests = write_face(stem, face);
    base::write_atomically(with_suffix(stem, ".done"), done_text(fingerprint, digests, looked_for));
}

std::optional<Face> read_finished(const fs::path& stem, const std::string& fingerprint) {
    if (!finished(stem, fingerprint)) return std::nullopt;
    try {
        return read_face(stem);
    } catch (const InputError&) {
        return std::nullopt;  // damaged: made again
    }
}

std::vector<LookedFor> files_looked_for(const fs::path& stem) { return files_named_in(read_done(stem)); }

void remove_face(const fs::path& stem) {
    std::error_code ignored;
    for (const char* suffix : {".done", ".json", ".ply", ".png"}) fs::remove(with_suffix(stem, suffix), ignored);
}

}  // namespace mimik::preprocessing
