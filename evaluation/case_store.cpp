#include "evaluation/case_store.h"

#include <map>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/content_hash.h"
#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"

namespace mimik::evaluation {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view unit_mark = "# unit ";

/// "# unit 12L bs003: 65 rows, 0123456789abcdef"
std::string unit_line(const std::string& unit, std::size_t rows, const base::ContentHash& hash) {
    return fmt::format("{}{}: {} rows, {}", unit_mark, unit, rows, hash.text());
}

/// @throws InputError if it is longer than any that a store writes.
bool next_line(std::istream& in, std::string& line, const std::string& file) {
    constexpr std::size_t longest = 64 * 1024;
    line.resize(longest);
    in.getline(line.data(), static_cast<std::streamsize>(longest));
    const auto read = static_cast<std::size_t>(in.gcount());
    if (in.fail() && read + 1 >= longest)
        throw InputError(
            fmt::format("{}: a line of more than {} bytes; it is no table of cases as mimik writes it", file, longest));
    if (in.fail()) return false;
    line.resize(in.eof() ? read : read - 1);  // without the end of the line
    return true;
}

std::unique_ptr<base::TemporaryFile> temporary_in(const fs::path& folder, const std::string& name) {
    try {
        if (!folder.empty()) fs::create_directories(folder);
        return std::make_unique<base::TemporaryFile>(folder);
    } catch (const std::system_error& e) {
        throw InputError(fmt::format("{}: cannot be written ({}); check the folder", name, e.code().message()));
    }
}

}  // namespace

CaseStore::CaseStore() : written_(temporary_in(fs::temp_directory_path(), name())) {
    written_->lose_name();
    out_.open(written_->path(), std::ios::binary | std::ios::trunc);
    out_ << case_row_header() << '\n';
}

CaseStore::CaseStore(fs::path file)
    : file_(std::move(file)), written_(temporary_in(file_.parent_path(), file_.string())) {
    out_.open(written_->path(), std::ios::binary | std::ios::trunc);
    out_ << case_row_header() << '\n';
    if (!out_.flush()) throw InputError(fmt::format("{}: cannot be written", name()));
}

CaseStore::CaseStore(fs::path file, Kept) : file_(std::move(file)) {
    std::error_code none;
    if (fs::exists(file_, none)) {
        std::uintmax_t whole_bytes = 0;
        units_ = read_case_rows(
            file_, [](const CaseRow&) {}, &whole_bytes);
        fs::resize_file(file_, whole_bytes, none);
        if (none) throw InputError(fmt::format("{}: cannot be cut ({}); check the file", name(), none.message()));
        out_.open(file_, std::ios::binary | std::ios::app);
    } else {
        // With its first line at once, or not at all: a run that is stopped here must be able to go on.
        base::write_atomically(file_, fmt::format("{}\n", case_row_header()));
        out_.open(file_, std::ios::binary | std::ios::app);
    }
    if (!out_) throw InputError(fmt::format("{}: cannot be written", name()));
}

CaseStore::CaseStore(Joined) {}

CaseStore CaseStore::of_files(std::vector<fs::path> files) {
    CaseStore store{Joined()};
    std::map<std::string, std::string> checksums;
    for (const auto& file : files) {
        const auto whole_bytes = read_case_units(file, [&](const StoredUnit& unit) {
            const auto [there, is_new] = checksums.try_emplace(unit.name, unit.checksum);
            if (!is_new && there->second != unit.checksum)
                throw InputError(
                    fmt::format("{}: has other rows of unit '{}' than a file before it; remove the file "
                                "that was made otherwise, and make it again",
                                file.string(), unit.name));
        });
        if (std::error_code none; fs::file_size(file, none) != whole_bytes)
            throw InputError(
                fmt::format("{}: is damaged after byte {}; remove it, and make it again", file.string(), whole_bytes));
    }
    for (const auto& [unit, checksum] : checksums) store.units_.insert(unit);
    store.joined_ = std::move(files);
    return store;
}

CaseStore CaseStore::gone_on_with(fs::path file) { return {std::move(file), Kept()}; }

CaseStore::CaseStore(CaseStore&&) noexcept = default;

std::string CaseStore::name() const {
    return file_.empty() ? "temporary file in " + fs::temp_directory_path().string() : file_.string();
}

CaseStore::~CaseStore() = default;

void CaseStore::append(const std::string& unit, std::span<const CaseRow> rows) {
    if (!joined_.empty())
        throw InputError(
            fmt::format("unit '{}' is in none of the files ({} and others) of a run that ought to be whole", unit,
                        joined_.front().string()));
    if (units_.contains(unit)) throw InputError(fmt::format("unit '{}' is stored already", unit));
    base::ContentHash hash;
    std::string text;
    for (const auto& row : rows) {
        const auto line = encode_case_row(row) + '\n';
        hash.add(line);
        text += line;
    }
    out_ << text << unit_line(unit, rows.size(), hash) << '\n';
    if (!out_.flush()) throw InputError(fmt::format("{}: takes no more (disk full?)", name()));
    units_.insert(unit);
}

void CaseStore::read(const std::function<void(const CaseRow&)>& visit) const {
    std::set<std::string> units;
    const auto take = [&](const StoredUnit& unit) {
        if (!units.insert(unit.name).second) return;  // of an earlier file
        for (const auto& row : unit.rows) visit(row);
    };
    for (const auto& file : joined_) read_case_units(file, take);
    if (joined_.empty()) read_case_units(path(), take);
    if (units != units_)
        throw InputError(fmt::format("{}: {} of {} units can be read back; it was damaged while it was written", name(),
                                     units.size(), units_.size()));
}

void CaseStore::finish() {
    out_.close();
    if (file_.empty() || !written_) return;
    try {
        written_->become(file_);
    } catch (const std::system_error& e) {
        throw InputError(fmt::format("{}: cannot be replaced ({}); check the folder", name(), e.code().message()));
    }
}

std::set<std::string> read_case_rows(const fs::path& file, const std::function<void(const CaseRow&)>& visit,
                                     std::uintmax_t* whole_bytes) {
    std::ifstream in(file, std::ios::binary);
    return read_case_rows(in, file.string(), visit, whole_bytes);
}

std::set<std::string> read_case_rows(std::istream& in, const std::string& name,
                                     const std::function<void(const CaseRow&)>& visit, std::uintmax_t* whole_bytes) {
    std::set<std::string> units;
    const auto bytes = read_case_units(in, name, [&](const StoredUnit& unit) {
        for (const auto& row : unit.rows) visit(row);
        units.insert(unit.name);
    });
    if (whole_bytes) *whole_bytes = bytes;
    return units;
}

std::uintmax_t read_case_units(const fs::path& file, const std::function<void(const StoredUnit&)>& visit) {
    std::ifstream in(file, std::ios::binary);
    return read_case_units(in, file.string(), visit);
}

std::uintmax_t read_case_units(std::istream& in, const std::string& name_of_file,
                               const std::function<void(const StoredUnit&)>& visit) {
    constexpr std::size_t most_rows = 2'000'000;  // of a unit: 1000 sources by 50 methods leave 800,000
    std::string line;
    if (!next_line(in, line, name_of_file) || line != case_row_header() || in.eof())
        throw InputError(
            fmt::format("{}: is no table of cases; its first line has to be '{}'", name_of_file, case_row_header()));
    StoredUnit unit;
    base::ContentHash hash;
    std::uintmax_t bytes = line.size() + 1, whole_bytes = bytes;
    while (next_line(in, line, name_of_file)) {
        bytes += line.size() + 1;
        if (line.starts_with(unit_mark)) {
            unit.name = line.substr(unit_mark.size(), line.rfind(": ") - unit_mark.size());
            if (in.eof() || line != unit_line(unit.name, unit.rows.size(), hash)) break;  // cut off or damaged
            unit.checksum = hash.text();
            visit(unit);
            whole_bytes = bytes;
            unit.rows.clear();
            hash = {};
            continue;
        }
        hash.add(line + '\n');
        auto row = decode_case_row(line);
        if (!row) break;  // cut off
        if (unit.rows.size() == most_rows)
            throw InputError(
                fmt::format("{}: more than {} rows without the line that ends their unit; it is no table "
                            "of cases as mimik writes it",
                            name_of_file, most_rows));
        unit.rows.push_back(std::move(*row));
    }
    return whole_bytes;  // rows without their unit's line were cut off
}

}  // namespace mimik::evaluation
