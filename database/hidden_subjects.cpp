#include "database/hidden_subjects.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <system_error>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "database/file_origin.h"
#include "database/known_databases.h"
#include "database/manifest.h"
#include "database/scan_id.h"
#include "io/json_values.h"

namespace mimik::database {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t max_list_bytes = 16 << 20;
constexpr std::string_view list_name = "unallowed_subjects.txt";
constexpr std::size_t most_remarks = 50;
constexpr int levels_above_database = 2;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// "bs001" of "bs001", "BS1" and "01"; empty for other words.
std::optional<std::string> numbered(std::string_view word) {
    const std::string lower = base::lower_case(word);
    std::string_view digits = lower;
    if (digits.starts_with("bs")) digits.remove_prefix(2);
    if (digits.empty() || !std::all_of(digits.begin(), digits.end(), is_digit)) return std::nullopt;
    while (digits.size() > 1 && digits.front() == '0') digits.remove_prefix(1);
    return fmt::format("bs{:0>3}", digits);
}

/// What two spellings of one subject have in common.
std::string canonical(std::string_view word) {
    if (auto number = numbered(word)) return *number;
    std::string name = base::lower_case(word);
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ' ' || c == '_'; }, '-');
    return name;
}

class ListReader {
public:
    ListReader(std::string text, const std::string& name, std::span<const std::string> subjects)
        : text_(std::move(text)), lines_(text_, name), name_(name) {
        for (const auto& subject : subjects) {
            known_.emplace_back(canonical(subject), subject);
            numbers_are_subjects_ = numbers_are_subjects_ || numbered(subject).has_value();
        }
    }

    HiddenSubjects read() {
        while (lines_.next()) {
            if (std::any_of(lines_.line().begin(), lines_.line().end(),
                            [](char c) { return c >= 0 && c < ' ' && c != '\t'; }))
                lines_.fail("is not plain text; save the list as UTF-8 with a line for each subject");
            // A whole line first: a name may hold any character that separates others.
            if (hide_known(base::trimmed(lines_.line()))) continue;
            const auto entries = base::trimmed(lines_.line().substr(0, lines_.line().find('#')));
            if (!entries.empty() && !hide_known(entries)) take_parts(entries, " \t,;", &ListReader::take_field);
        }
        return {{found_.begin(), found_.end()}, std::move(remarks_)};
    }

    void refuse_if_none_matched(const HiddenSubjects& hidden) const {
        if (first_unmatched_line_ == 0 || !hidden.subjects.empty()) return;
        throw InputError(
            fmt::format("{}: line {}: {} is no subject of this database, nor is any other entry: nobody would be "
                        "hidden; write one subject a line as 'mimik scans' names them, or empty the list",
                        name_, first_unmatched_line_, base::in_quotes(first_unmatched_)));
    }

private:
    template <class Take>
    void take_parts(std::string_view text, std::string_view separators, const Take& take) {
        while (!text.empty()) {
            const auto end = std::min(text.find_first_of(separators), text.size());
            if (end > 0) (this->*take)(text.substr(0, end));
            text.remove_prefix(std::min(end + 1, text.size()));
        }
    }

    bool hide_known(std::string_view entry) {
        if (entry.empty()) return false;
        bool any = false;
        const auto wanted = canonical(entry);
        for (const auto& [spelling, subject] : known_) {
            if (spelling != wanted) continue;
            found_.insert(subject);
            any = true;
        }
        return any;
    }

    bool hide(std::string_view entry) {
        if (hide_known(entry)) return true;
        const auto number = numbered(entry);
        if (!number || !numbers_are_subjects_) return false;
        if (found_.insert(*number).second)
            remark(fmt::format("{}: line {}: no scan of '{}' is here; it is hidden all the same", name_,
                               lines_.number(), number->substr(0, 40)));
        return true;
    }

    /// What is no subject may be one with a full stop or brackets around it.
    void take_field(std::string_view field) {
        if (hide(field)) return;
        std::string words(field);
        std::replace_if(
            words.begin(), words.end(),
            [](char c) {
                const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
                return !(is_digit(c) || letter || c == '-' || static_cast<unsigned char>(c) >= 0x80);
            },
            ' ');
        if (words == field) return miss(field);
        take_parts(words, " ", &ListReader::take_word);
    }
    void take_word(std::string_view word) {
        if (!hide(word)) miss(word);
    }

    void miss(std::string_view entry) {
        if (first_unmatched_line_ == 0) {
            first_unmatched_line_ = lines_.number();
            first_unmatched_ = entry;
        }
        remark(fmt::format("{}: line {}: {} is no subject of this database and is not hidden", name_, lines_.number(),
                           base::in_quotes(entry)));
    }
    void remark(std::string text) {
        if (remarks_.size() < most_remarks) remarks_.push_back(std::move(text));
    }

    std::string text_;
    base::LineReader lines_;
    std::string name_;
    std::vector<std::pair<std::string, std::string>> known_;  // canonical, as the database spells it
    bool numbers_are_subjects_ = false;
    std::set<std::string> found_;
    std::vector<std::string> remarks_;
    std::size_t first_unmatched_line_ = 0;
    std::string first_unmatched_;
};

/// @throws InputError where it cannot be read: then nobody knows whom it hides.
std::string list_text(const fs::path& list) {
    std::error_code ignored;
    if (fs::is_directory(list, ignored))
        throw InputError(
            fmt::format("{}: is a folder, so nobody knows whom it hides; make it a text file with a subject "
                        "a line, or give the folder another name",
                        list.string()));
    return base::read_text(list, most_hidden_list_bytes);
}

void add_manifest_subjects(const fs::path& manifest_file, const fs::path& file, std::vector<std::string>& subjects) {
    std::error_code error;
    if (!fs::is_regular_file(manifest_file, error)) return;
    for (const auto& entry : parse_manifest(base::read_text(manifest_file, max_list_bytes), manifest_file).scans)
        if (entry.scan_file == file ||
            (entry.scan_file.filename() == file.filename() && fs::equivalent(entry.scan_file, file, error)))
            subjects.push_back(entry.id.subject);
}

/// Whose face the file may hold, by its name and by what lies between the list's folder and the file.
std::vector<std::string> possible_subjects(const fs::path& file, const fs::path& list_folder) {
    std::vector<std::string> subjects;
    const std::string stem = file.stem().string();
    if (const auto id = parse_scan_name(stem)) subjects.push_back(id->subject);
    // bs000.png is a sheet of bs000; a bare number is more often an action unit's.
    if (!std::all_of(stem.begin(), stem.end(), is_digit)) subjects.push_back(stem);
    for (auto folder = file.parent_path();; folder = folder.parent_path()) {
        add_manifest_subjects(folder / "manifest.csv", file, subjects);
        if (folder == list_folder) return subjects;
        subjects.push_back(folder.filename().string());
    }
}

struct FoundList {
    fs::path file;
    bool above = false;  ///< of the folder where the search began
};

std::vector<FoundList> lists_up_from(fs::path folder, int levels_above) {
    std::vector<FoundList> lists;
    for (int level = 0; level <= levels_above; ++level, folder = folder.parent_path()) {
        for (auto& file : hidden_subjects_files(folder)) lists.push_back({std::move(file), level > 0});
        if (folder == folder.parent_path()) break;
    }
    return lists;
}

/// Where the path lies, and where its links lead if that is another place. Empty if there is no such path.
std::vector<fs::path> places_of(const fs::path& path) {
    std::error_code error;
    std::vector<fs::path> places = {fs::absolute(path, error).lexically_normal()};
    if (error) return {};
    if (!places[0].has_filename()) places[0] = places[0].parent_path();  // "folder/" is "folder"
    if (auto target = fs::canonical(path, error); !error && target != places[0]) places.push_back(std::move(target));
    return places;
}

/// Of one list. @throws InputError if it holds one of the subjects.
void refuse_listed(const fs::path& file, const fs::path& list, std::span<const std::string> subjects) {
    const auto hidden = ListReader(list_text(list), list.string(), subjects).read().subjects;
    for (const auto& subject : subjects)
        if (is_hidden(hidden, subject))
            throw InputError(fmt::format("{}: subject '{}' stands in {} and must not be shown; choose another",
                                         file.string(), subject, list.string()));
}

/// The lists that a database goes by.
void refuse_listed_in_database(const fs::path& file, const fs::path& database, std::span<const std::string> subjects) {
    if (database.empty() || subjects.empty()) return;
    for (const auto& place : places_of(database))
        for (const auto& list : lists_up_from(place, levels_above_database)) refuse_listed(file, list.file, subjects);
}

/// What a workspace says of its database; empty if this folder is none.
struct WorkspaceOrigin {
    fs::path database;
    std::vector<std::string> hidden;
};
WorkspaceOrigin workspace_at(const fs::path& folder) {
    WorkspaceOrigin origin;
    for (const char* name : {"workspace.json", "workspace.before.json"}) {
        const auto file = folder / name;
        std::error_code ignored;
        if (!fs::is_regular_file(file, ignored)) continue;
        try {
            const auto document = io::parse_json(base::read_text(file, io::most_json_bytes), file.string());
            origin.database = io::read_field<std::string>(document, "database");
            origin.hidden = io::read_field<std::vector<std::string>>(document, "hidden_subjects");
            return origin;
        } catch (const InputError&) {
            continue;  // of another program, or damaged: commands that take workspaces say so
        }
    }
    return origin;
}

constexpr int levels_above_file = 4;

void refuse_hidden_at(const fs::path& file, const FileOrigin& origin) {
    const auto with_origin = [&](std::vector<std::string> subjects) {
        subjects.insert(subjects.end(), origin.subjects.begin(), origin.subjects.end());
        return subjects;
    };
    for (const auto& list : lists_up_from(file.parent_path(), levels_above_file))
        refuse_listed(file, list.file, with_origin(possible_subjects(file, list.file.parent_path())));
    auto folder = file.parent_path();
    for (int level = 0; level <= levels_above_file; ++level, folder = folder.parent_path()) {
        if (const auto workspace = workspace_at(folder); !workspace.database.empty()) {
            const auto subjects = with_origin(possible_subjects(file, folder));
            for (const auto& subject : subjects)
                if (is_hidden(workspace.hidden, subject))
                    throw InputError(
                        fmt::format("{}: subject '{}' was hidden when {} was made and must not be shown; "
                                    "choose another",
                                    file.string(), subject, folder.string()));
            refuse_listed_in_database(file, workspace.database, subjects);
        }
        if (folder == folder.parent_path()) break;
    }
    refuse_listed_in_database(file, origin.place, origin.subjects);
}

}  // namespace

HiddenSubjects parse_hidden_subjects(std::string_view text, const std::string& name,
                                     std::span<const std::string> subjects) {
    ListReader reader(std::string(text), name, subjects);
    auto hidden = reader.read();
    reader.refuse_if_none_matched(hidden);
    return hidden;
}

std::vector<fs::path> hidden_subjects_files(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code error, ignored;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
        if (base::equal_ignoring_case(it->path().filename().string(), list_name)) files.push_back(it->path());
    if (error) {  // a folder that may be entered but not listed
        files.clear();
        if (fs::exists(folder / list_name, ignored)) files.push_back(folder / list_name);
    }
    std::sort(files.begin(), files.end());
    return files;
}

bool is_hidden(std::span<const std::string> hidden_subjects, std::string_view subject) {
    return std::any_of(hidden_subjects.begin(), hidden_subjects.end(),
                       [&](const auto& hidden) { return base::equal_ignoring_case(hidden, subject); });
}

HiddenSubjects hidden_subjects_of(const fs::path& folder, std::span<const std::string> subjects, KnownSubjects known) {
    HiddenSubjects hidden;
    std::set<std::string> found;
    std::set<fs::path> seen;
    for (const auto& place : places_of(folder))
        for (const auto& list : lists_up_from(place, levels_above_database)) {
            if (!seen.insert(list.file).second) continue;
            const auto text = list_text(list.file);
            auto entries = list.above || known == KnownSubjects::some
                               ? ListReader(text, list.file.string(), subjects).read()
                               : parse_hidden_subjects(text, list.file.string(), subjects);
            found.insert(entries.subjects.begin(), entries.subjects.end());
            if (!list.above && known == KnownSubjects::all)
                std::move(entries.remarks.begin(), entries.remarks.end(), std::back_inserter(hidden.remarks));
        }
    hidden.subjects.assign(found.begin(), found.end());
    return hidden;
}

std::string hidden_subjects_text(std::span<const std::string> hidden_subjects) {
    std::string text;
    for (const auto& subject : hidden_subjects) text += subject + '\n';
    return text;
}

void refuse_hidden_file(const fs::path& file) {
    const auto origin = origin_of(file);
    for (const auto& place : places_of(file)) refuse_hidden_at(place, origin);
}

namespace {

/// The database of the workspace that a file lies in; empty if it lies in none.
fs::path database_above(const fs::path& file) {
    auto folder = file.parent_path();
    for (int level = 0; level <= levels_above_file; ++level) {
        if (auto database = workspace_at(folder).database; !database.empty()) return database;
        folder = folder.parent_path();
    }
    return {};
}

}  // namespace

FileOrigin origin_to_carry(std::span<const fs::path> files) {
    FileOrigin all;
    for (const auto& file : files) {
        auto origin = origin_of(file);
        const auto places = places_of(file);
        // A model names its scans, and no database: that of the workspace it lies in.
        if (!origin.subjects.empty() && origin.database.empty() && !places.empty()) {
            origin.place = database_above(places.front());
            if (!origin.place.empty()) origin.database = database_mark(origin.place);
        }
        if (const auto scan = parse_scan_name(file.stem().string()); scan && !places.empty()) {
            FileOrigin by_name{{scan->subject}, {}, database_above(places.front())};
            // A scan of a database: its lists lie beside it or above.
            if (by_name.place.empty()) by_name.place = places.front().parent_path();
            by_name.database = database_mark(by_name.place);
            origin = united(origin, by_name);
        }
        all = united(all, origin);
    }
    return all;
}

}  // namespace mimik::database
