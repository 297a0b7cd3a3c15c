#include "cli/shard_files.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <random>
#include <set>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "base/content_hash.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/file_digest.h"

namespace mimik::cli {
namespace {

namespace fs = std::filesystem;
using evaluation::Shard;

fs::path shards_in(const fs::path& root) { return root / "shards"; }

/// A name that no other attempt has, on whatever host. No result depends on it.
std::string random_digits() {
    std::random_device device;
    return fmt::format("{:08x}{:08x}", device() & 0xFFFFFFFFU, device() & 0xFFFFFFFFU);
}

/// "3-of-20.rows" and the like.
std::optional<Shard> shard_of(const fs::path& file) {
    const auto name = file.filename().string();
    const auto stem = name.substr(0, name.find('.'));
    const auto of = stem.find("-of-");
    if (of == std::string::npos) return std::nullopt;
    try {
        return evaluation::parse_shard(stem.substr(0, of) + "/" + stem.substr(of + 4));
    } catch (const InputError&) {
        return std::nullopt;
    }
}

/// What lies on the disk must be whole before its name says so.
void flush_to_disk(const fs::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    const bool done = descriptor >= 0 && ::fsync(descriptor) == 0;
    const int fault = errno;
    if (descriptor >= 0) ::close(descriptor);
    if (!done) throw InputError(fmt::format("{}: cannot be written ({})", file.string(), std::strerror(fault)));
}

/// How much of an attempt is whole, and of how many units; nothing where it is of another experiment.
struct Whole {
    std::uintmax_t bytes = 0;
    std::size_t units = 0, targets = 0;
};
Whole whole_part(const fs::path& file, const std::string& first_unit) {
    Whole whole;
    bool ours = false;
    try {
        whole.bytes = evaluation::read_case_units(file, [&](const evaluation::StoredUnit& unit) {
            if (whole.units == 0)
                ours = unit.name == first_unit;
            else if (!unit.name.ends_with(" cast"))
                ++whole.targets;
            ++whole.units;
        });
    } catch (const InputError&) {  // cut off in its first line
        return {};
    }
    return ours ? whole : Whole();
}

void copy_head(const fs::path& from, const fs::path& to, std::uintmax_t bytes) {
    std::ifstream in(from, std::ios::binary);
    std::ofstream out(to, std::ios::binary | std::ios::trunc);
    std::vector<char> block(std::size_t{1} << 20);
    while (bytes > 0 && in && out) {
        in.read(block.data(), static_cast<std::streamsize>(std::min<std::uintmax_t>(bytes, block.size())));
        out.write(block.data(), in.gcount());
        bytes -= static_cast<std::uintmax_t>(in.gcount());
    }
    if (!out.flush() || bytes > 0) throw InputError(fmt::format("{}: takes no more (disk full?)", to.string()));
}

}  // namespace

ShardFiles::ShardFiles(fs::path root, Shard shard, const std::string& identity)
    : folder_(shards_in(root)),
      stem_(folder_ / fmt::format("{}-of-{}", shard.index, shard.count)),
      shard_(shard),
      identity_(base::digest_of(identity).text()) {
    own_ = fmt::format("{}.{}.part", stem_.string(), random_digits());
}

bool ShardFiles::whole() const { return base::is_there(rows()); }

std::vector<fs::path> ShardFiles::parts() const {
    std::vector<fs::path> found;
    std::error_code none;
    const auto begin = stem_.filename().string() + ".";
    for (const auto& entry : fs::directory_iterator(folder_, none)) {
        const auto name = entry.path().filename().string();
        if (name.starts_with(begin) && name.ends_with(".part")) found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    return found;
}

evaluation::CaseStore ShardFiles::begin(std::size_t& found) {
    std::error_code fault;
    fs::create_directories(folder_, fault);
    if (fault)
        throw InputError(fmt::format("{}: cannot be made ({}); check the folder", folder_.string(), fault.message()));
    Whole longest;
    fs::path from;
    for (const auto& part : parts())
        if (const auto whole = whole_part(part, identity_unit()); whole.units > longest.units) {
            longest = whole;
            from = part;
        }
    if (longest.units > 0) copy_head(from, own_, longest.bytes);
    auto store = evaluation::CaseStore::gone_on_with(own_);
    if (longest.units == 0) store.append(identity_unit(), {});
    found = longest.targets;
    return store;
}

void ShardFiles::finish() {
    // Another attempt may have been quicker, and have taken this file for a leftover: the bytes are the same.
    std::error_code fault;
    if (base::is_there(own_)) {
        flush_to_disk(own_);
        fs::rename(own_, rows(), fault);
    }
    if (!whole())
        throw InputError(fmt::format("{}: cannot be written ({}); check the folder, and run the shard again",
                                     rows().string(), fault ? fault.message() : own_.string() + " is gone"));
    for (const auto& part : parts()) fs::remove(part, fault);
}

void ShardFiles::check() const {
    std::ifstream in(rows(), std::ios::binary);
    std::string header, line;
    std::getline(in, header);
    std::getline(in, line);
    if (!line.starts_with("# unit " + identity_unit() + ":"))
        throw InputError(
            fmt::format("{}: holds rows of another experiment; remove it, and make it again", rows().string()));
}

std::size_t shard_count(const fs::path& root, std::size_t asked) {
    std::set<std::size_t> counts;
    for (const auto& file : files_of_shards(root))
        if (file.extension() == ".rows") counts.insert(shard_of(file)->count);
    if (asked > 0) return asked;
    if (counts.empty())
        throw InputError(
            fmt::format("{}: holds no shard of an experiment that is whole; make them with 'mimik run EXPERIMENT -o {} "
                        "--shard 1/20' "
                        "and so on, or say with --shards how many there are to be",
                        root.string(), root.string()));
    if (counts.size() > 1)
        throw InputError(fmt::format("{}: holds shards of experiments cut into {} parts; say which with --shards",
                                     root.string(), fmt::join(counts, " and ")));
    return *counts.begin();
}

std::vector<fs::path> files_of_shards(const fs::path& root) {
    std::vector<fs::path> files;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(shards_in(root), none)) {
        const auto ending = entry.path().extension();
        if (shard_of(entry.path()) && (ending == ".rows" || ending == ".json" || ending == ".part"))
            files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

std::string number_list(const std::vector<std::size_t>& numbers, const std::string& between) {
    std::string text;
    for (std::size_t k = 0; k < numbers.size();) {
        std::size_t last = k;
        while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
        if (!text.empty()) text += between;
        text += last == k ? fmt::format("{}", numbers[k]) : fmt::format("{}-{}", numbers[k], numbers[last]);
        k = last + 1;
    }
    return text;
}

}  // namespace mimik::cli
