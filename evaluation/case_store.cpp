#include "evaluation/case_store.h"

#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "base/content_hash.h"
#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"

namespace mimik::evaluation {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view unit_mark = "# unit ";
constexpr std::size_t columns = 11;

/// "# unit 12L bs003: 65 rows, 0123456789abcdef"
std::string unit_line(const std::string& unit, std::size_t rows, const base::ContentHash& hash) {
    return fmt::format("{}{}: {} rows, {}", unit_mark, unit, rows, hash.text());
}

std::optional<double> number(std::string_view text) { return text.empty() ? std::nullopt : base::parse_double(text); }

CaseRow decode_row(const std::vector<std::string>& fields) {
    return {{fields[0], fields[1], fields[2], fields[3], number(fields[4]).value_or(1.0)},
            fields[5],
            fields[6],
            fields[7],
            number(fields[8]),
            fields[9],
            fields[10]};
}

fs::path temporary_file() {
    auto pattern = (fs::temp_directory_path() / "mimik-cases-XXXXXX").string();
    const int descriptor = ::mkstemp(pattern.data());
    if (descriptor < 0) throw InputError(fmt::format("{}: no temporary file can be made there", pattern));
    ::close(descriptor);
    return pattern;
}

}  // namespace

CaseStore::CaseStore() : written_(temporary_file()) {
    out_.open(written_, std::ios::binary | std::ios::trunc);
    out_ << case_row_header() << '\n';
}

CaseStore::CaseStore(fs::path file) : file_(std::move(file)), written_(file_.string() + ".part") {
    if (file_.has_parent_path()) fs::create_directories(file_.parent_path());
    out_.open(written_, std::ios::binary | std::ios::trunc);
    out_ << case_row_header() << '\n';
    if (!out_.flush()) throw InputError(fmt::format("{}: cannot be written", written_.string()));
}

CaseStore::~CaseStore() {
    out_.close();
    std::error_code ignored;
    if (!written_.empty()) fs::remove(written_, ignored);
}

void CaseStore::append(const std::string& unit, std::span<const CaseRow> rows) {
    if (units_.contains(unit)) throw InputError(fmt::format("unit '{}' is stored already", unit));
    base::ContentHash hash;
    std::string text;
    for (const auto& row : rows) {
        const auto line = encode_case_row(row) + '\n';
        hash.add(line);
        text += line;
    }
    out_ << text << unit_line(unit, rows.size(), hash) << '\n';
    if (!out_.flush()) throw InputError(fmt::format("{}: takes no more (disk full?)", written_.string()));
    units_.insert(unit);
}

void CaseStore::read(const std::function<void(const CaseRow&)>& visit) const {
    const auto units = read_case_rows(written_, visit);
    if (units != units_)
        throw InputError(fmt::format("{}: {} of {} units can be read back; it was damaged while it was written",
                                     written_.string(), units.size(), units_.size()));
}

void CaseStore::finish() {
    out_.close();
    if (file_.empty()) return;
    fs::rename(written_, file_);
    written_.clear();
}

std::set<std::string> read_case_rows(const fs::path& file, const std::function<void(const CaseRow&)>& visit) {
    std::ifstream in(file, std::ios::binary);
    std::string line;
    if (!std::getline(in, line) || line != case_row_header())
        throw InputError(
            fmt::format("{}: is no table of cases; its first line has to be '{}'", file.string(), case_row_header()));
    std::set<std::string> units;
    std::vector<CaseRow> rows;
    base::ContentHash hash;
    std::vector<std::string> fields;
    while (std::getline(in, line)) {
        if (line.starts_with(unit_mark)) {
            const auto name = line.substr(unit_mark.size(), line.rfind(": ") - unit_mark.size());
            if (line != unit_line(name, rows.size(), hash)) return units;
            for (const auto& row : rows) visit(row);
            units.insert(name);
            rows.clear();
            hash = {};
            continue;
        }
        hash.add(line + '\n');
        try {
            base::LineReader one_line(line, file.string());
            if (!one_line.next()) return units;
            base::split_csv_line(one_line, fields);
        } catch (const InputError&) {
            return units;  // cut off within quotes
        }
        if (fields.size() != columns) return units;
        rows.push_back(decode_row(fields));
    }
    return units;  // rows without their unit's line were cut off
}

}  // namespace mimik::evaluation
