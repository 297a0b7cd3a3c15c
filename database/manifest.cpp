#include "database/manifest.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/text.h"

namespace mimik::database {
namespace {

namespace fs = std::filesystem;

// A row may have 10 bytes, and takes up to 6 kB of memory from then on (in the JSON of what is wrong with it).
// Bosphorus has 4,666 scans.
constexpr std::size_t max_scans = 100'000;

/// A path of the manifest, absolute; backslashes, as Windows has them, are slashes. It must not lead out of the
/// manifest's folder: a database that was downloaded shall not reach other files.
fs::path inside(const base::CsvReader& rows, const std::string& value, const fs::path& folder, const char* column) {
    std::string slashes = value;
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    const bool drive = value.size() > 2 && value[1] == ':' && slashes[2] == '/';
    const fs::path path = fs::path(slashes).lexically_normal();
    if (drive || path.is_absolute() || path.empty() || *path.begin() == "..")
        rows.fail(fmt::format("{} {} leads out of the manifest's folder; copy or link the file into it", column,
                              base::in_quotes(value)));
    return folder / path;
}

/// Letters, digits and '-': a subject's name becomes part of file names.
std::string subject_name(const base::CsvReader& rows, const std::string& value) {
    std::string name;
    for (const char c : value) {
        const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
                           c == '.' || static_cast<unsigned char>(c) >= 0x80;
        if (!plain && c != ' ' && c != '_')
            rows.fail(fmt::format("subject {} has a character that file names cannot hold; use letters, digits and '-'",
                                  base::in_quotes(value)));
        name += plain ? c : '-';
    }
    if (!base::is_utf8(name))
        rows.fail(fmt::format("subject {} is not written in UTF-8; save the table as UTF-8", base::in_quotes(value)));
    if (name.empty() || name.size() > 100 || name.front() == '.')
        rows.fail(fmt::format("subject {} is no name; give 1 to 100 letters, digits or '-'", base::in_quotes(value)));
    return name;
}

/// Remarks spellings that one code stands for because it has '-' for what they differ in.
class Spellings {
public:
    void add(const ScanId& expression, const std::string& text, const std::string& file,
             std::vector<std::string>& remarks) {
        if (expression.code.find('-') == std::string::npos) return;
        std::string letters = base::lower_case(text);  // however the words are separated
        std::erase_if(letters, [](char c) { return c == ' ' || c == '\t' || c == '_' || c == '-'; });
        const auto [first, is_new] = first_.try_emplace(expression.group_and_code(), text);
        if (!seen_.emplace(expression.group_and_code(), std::move(letters)).second || is_new) return;
        remarks.push_back(
            fmt::format("{}: expressions {} and {} are both called {} and count as one; use other letters or digits if "
                        "they are two",
                        file, base::in_quotes(first->second), base::in_quotes(text), expression.group_and_code()));
    }

private:
    std::map<std::string, std::string> first_;
    std::set<std::pair<std::string, std::string>> seen_;
};

/// Also the words.
std::string parse_sex(const base::CsvReader& rows, const std::string& value) {
    std::string word = base::lower_case(value);
    if (word.empty() || word == "m" || word == "f") return word;
    if (word == "male" || word == "man") return "m";
    if (word == "female" || word == "woman") return "f";
    rows.fail(fmt::format("sex is {}; give m, f or nothing", base::in_quotes(value)));
}

}  // namespace

Manifest parse_manifest(std::string_view text, const fs::path& file) {
    base::CsvReader rows(text, file.string());
    const auto subject = rows.column("subject"), expression = rows.column("expression"), scan = rows.column("scan");
    const auto landmarks = rows.find_column("landmarks"), sex = rows.find_column("sex"),
               unit = rows.find_column("unit");
    const fs::path folder = file.parent_path();
    Manifest manifest;
    std::map<ScanId, int> repetitions;
    Spellings spellings;
    while (rows.next()) {
        if (manifest.scans.size() == max_scans)
            rows.fail(fmt::format("more than {} scans; split the database", max_scans));
        ScanEntry entry;
        const auto shown = facs::parse_expression(rows.field(expression));
        if (!shown) rows.fail("expression is empty; give N, AU12, 12L, HAPPY or the like");
        if (shown->code().size() > 100)
            rows.fail(
                fmt::format("expression {} becomes part of file names; give at most 100 bytes of letters and digits",
                            base::in_quotes(rows.field(expression))));
        entry.id = {subject_name(rows, rows.field(subject)), shown->group(), shown->code(), 0};
        if (entry.id.subject != rows.field(subject))
            manifest.remarks.push_back(fmt::format("{}: subject {} is called '{}'", file.string(),
                                                   base::in_quotes(rows.field(subject)), entry.id.subject));
        if (entry.id.group == "OTHER")
            manifest.remarks.push_back(fmt::format("{}: expression {} is none that Mimik knows; it is kept as {}",
                                                   file.string(), base::in_quotes(rows.field(expression)),
                                                   entry.id.group_and_code()));
        spellings.add(entry.id, rows.field(expression), file.string(), manifest.remarks);
        if (rows.field(scan).empty()) rows.fail("scan is empty; name the file");
        entry.scan_file = inside(rows, rows.field(scan), folder, "scan");
        entry.file_name_stem = entry.scan_file.stem().string();
        if (landmarks && !rows.field(*landmarks).empty())
            entry.landmarks_file = inside(rows, rows.field(*landmarks), folder, "landmarks");
        if (sex) entry.sex = parse_sex(rows, rows.field(*sex));
        try {
            if (unit && !rows.field(*unit).empty()) {
                entry.unit = io::parse_length_unit(rows.field(*unit));
                entry.unit_is_said = true;
            }
        } catch (const InputError& e) {
            rows.fail(e.what());
        }
        entry.id.repetition = repetitions[entry.id]++;
        manifest.scans.push_back(std::move(entry));
    }
    return manifest;
}

std::map<std::string, std::string> parse_subjects(std::string_view text, const std::string& name) {
    base::CsvReader rows(text, name);
    const auto subject = rows.column("subject"), sex = rows.column("sex");
    std::map<std::string, std::string> sexes;
    while (rows.next()) {
        if (rows.field(subject).empty()) rows.fail("subject is empty; name one as its folder is named");
        const auto [known, is_new] =
            sexes.emplace(base::lower_case(rows.field(subject)), parse_sex(rows, rows.field(sex)));
        if (!is_new) rows.fail(fmt::format("subject {} stands twice; delete one", base::in_quotes(known->first)));
    }
    return sexes;
}

}  // namespace mimik::database
