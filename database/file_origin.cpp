#include "database/file_origin.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "database/known_databases.h"
#include "database/scan_id.h"
#include "io/json_values.h"

namespace mimik::database {
namespace {

namespace fs = std::filesystem;

using Saying = std::pair<std::string, std::string>;

constexpr std::size_t head_bytes = 1 << 16;
constexpr std::size_t most_glb_json_bytes = 1 << 24;

/// "key: value" behind a mark at the beginning of lines.
std::vector<Saying> in_lines(std::string_view head, std::string_view mark, std::string_view last_line) {
    std::vector<Saying> sayings;
    while (!head.empty()) {
        auto line = head.substr(0, head.find('\n'));
        head.remove_prefix(std::min(line.size() + 1, head.size()));
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (!last_line.empty() && line == last_line) break;
        if (!line.starts_with(mark)) continue;
        const auto text = line.substr(mark.size());
        if (const auto colon = text.find(": "); colon != std::string_view::npos)
            sayings.emplace_back(base::trimmed(text.substr(0, colon)), base::trimmed(text.substr(colon + 2)));
    }
    return sayings;
}

/// Strings of VTK's XML files are the numbers of their bytes.
std::string from_byte_numbers(std::string_view text) {
    std::string bytes;
    for (auto word = base::next_word(text); !word.empty(); word = base::next_word(text)) {
        const auto number = base::parse_integer(base::trimmed(word));
        if (!number || *number <= 0 || *number > 255) break;
        bytes += static_cast<char>(*number);
    }
    return bytes;
}

std::vector<Saying> in_field_data(const std::string& head) {
    std::vector<Saying> sayings;
    const auto end = std::min(head.find("</FieldData>"), head.size());
    constexpr std::string_view array = "<Array type=\"String\" Name=\"";
    for (auto at = head.find(array); at < end; at = head.find(array, at + 1)) {
        const auto name = at + array.size(), quote = head.find('"', name);
        const auto content = head.find('>', quote), close = head.find('<', content);
        if (close == std::string::npos) break;
        std::string numbers = head.substr(content + 1, close - content - 1);
        std::replace(numbers.begin(), numbers.end(), '\n', ' ');
        sayings.emplace_back(head.substr(name, quote - name), from_byte_numbers(numbers));
    }
    return sayings;
}

std::vector<Saying> in_asset_extras(const fs::path& file, const std::string& head) {
    constexpr std::size_t json_at = 20;
    if (head.size() < json_at || !head.starts_with("glTF")) return {};
    std::uint32_t length = 0;
    for (std::size_t k = 0; k < 4; ++k)
        length |= static_cast<std::uint32_t>(static_cast<unsigned char>(head[12 + k])) << (8 * k);
    if (length > most_glb_json_bytes) return {};
    const auto text = base::read_text_head(file, json_at + length).substr(json_at);
    std::vector<Saying> sayings;
    const auto document = io::parse_json(text, file.string());
    const auto asset = document.find("asset");
    if (asset == document.end() || !asset->is_object() || !asset->contains("extras")) return {};
    for (const auto& [key, value] : asset->at("extras").items())
        if (value.is_string()) sayings.emplace_back(key, value.get<std::string>());
    return sayings;
}

/// The scans that a model was measured on.
std::vector<Saying> in_model(const fs::path& file) {
    std::vector<Saying> sayings;
    const auto document = io::parse_json(base::read_text(file, io::most_json_bytes), file.string());
    if (!document.is_object() || !document.contains("sources") || !document.at("sources").is_array()) return {};
    for (const auto& source : document.at("sources"))
        if (source.is_string()) sayings.emplace_back("source", source.get<std::string>());
    return sayings;
}

std::vector<Saying> sayings_of(const fs::path& file) {
    const auto extension = base::lower_case(file.extension().string());
    if (extension == ".json") return in_model(file);
    if (extension != ".ply" && extension != ".obj" && extension != ".vtp" && extension != ".glb") return {};
    const auto head = base::read_text_head(file, head_bytes);
    if (extension == ".ply") return in_lines(head, "comment ", "end_header");
    if (extension == ".obj") return in_lines(head, "# ", "");
    if (extension == ".vtp") return in_field_data(head);
    return in_asset_extras(file, head);
}

/// Words without what stands around and between them.
std::vector<std::string> words_of(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '(' || c == ')' || c == ',' || c == ';'; }, ' ');
    std::vector<std::string> words;
    std::string_view rest = text;
    for (auto word = base::next_word(rest); !word.empty(); word = base::next_word(rest)) words.emplace_back(word);
    return words;
}

}  // namespace

FileOrigin origin_of(const fs::path& file) {
    FileOrigin origin;
    std::set<std::string> subjects;
    try {
        for (const auto& [key, value] : sayings_of(file)) {
            if (key == "database") {
                origin.place = database_of_mark(value);
                origin.database = fs::path(value).is_absolute() ? database_mark(value) : value;
            } else if (key == "subjects") {
                for (auto& word : words_of(value)) subjects.insert(std::move(word));
            } else if (key == "source" || key == "target") {
                for (const auto& word : words_of(value)) {
                    subjects.insert(word);  // "bs003", or a word that is nobody
                    if (const auto scan = parse_scan_name(fs::path(word).stem().string()))
                        subjects.insert(scan->subject);
                }
            }
        }
    } catch (const InputError&) {
        return {};
    }
    origin.subjects.assign(subjects.begin(), subjects.end());
    return origin;
}

std::vector<std::pair<std::string, std::string>> said_in_files(const FileOrigin& origin) {
    std::vector<Saying> sayings;
    if (!origin.subjects.empty()) sayings.emplace_back("subjects", fmt::format("{}", fmt::join(origin.subjects, " ")));
    if (!origin.place.empty())
        sayings.emplace_back("database", remember_database(origin.place));
    else if (!origin.database.empty())
        sayings.emplace_back("database", origin.database);
    return sayings;
}

FileOrigin united(const FileOrigin& one, const FileOrigin& other) {
    std::set<std::string> subjects(one.subjects.begin(), one.subjects.end());
    subjects.insert(other.subjects.begin(), other.subjects.end());
    const auto& of_database = one.database.empty() ? other : one;
    return {{subjects.begin(), subjects.end()}, of_database.database, of_database.place};
}

}  // namespace mimik::database
