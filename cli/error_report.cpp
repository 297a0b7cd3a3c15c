#include "cli/error_report.h"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "io/json_values.h"

namespace mimik::cli {
namespace {

bool is_file(std::string_view text, const std::vector<std::string>& words) {
    if (text.empty()) return false;
    const auto names_it = [&](const std::string& word) {
        return word == text || (word.starts_with("--") && word.ends_with(text) && word.size() > text.size() &&
                                word[word.size() - text.size() - 1] == '=');
    };
    if (std::any_of(words.begin(), words.end(), names_it)) return true;
    std::error_code ignored;
    if (std::filesystem::exists(std::filesystem::path(text), ignored)) return true;
    return text.find('/') != std::string_view::npos && text.find("; ") == std::string_view::npos;
}

/// Takes "line 12: " or, of "file:12", the 12 off.
nlohmann::ordered_json line_of(std::string_view after_file) {
    constexpr std::string_view word = "line ";
    if (!after_file.starts_with(word)) return nullptr;
    after_file.remove_prefix(word.size());
    const auto number = base::parse_integer(after_file.substr(0, after_file.find_first_not_of("0123456789")));
    return number ? nlohmann::ordered_json(*number) : nlohmann::ordered_json(nullptr);
}

struct Named {
    nlohmann::ordered_json file = nullptr, line = nullptr, option = nullptr;
};

/// Messages begin with what they are about: "--texture: face.png: ...", "points.csv: line 3: ...", "--rows is ...".
Named named_by(std::string_view message, const std::vector<std::string>& words) {
    Named named;
    if (message.starts_with("-")) {
        const auto end = std::min(message.find_first_of(" :"), message.size());
        named.option = std::string(message.substr(0, end));
        message.remove_prefix(message.substr(end).starts_with(": ") ? end + 2 : end);
    }
    for (auto colon = message.find(": "); colon != std::string_view::npos; colon = message.find(": ", colon + 1)) {
        auto file = message.substr(0, colon);
        const auto rest = message.substr(colon + 2);
        if (is_file(file, words)) return {std::string(file), line_of(rest), named.option};
        // "from.csv, to.csv: ...": the first stands for all.
        const auto first = file.substr(0, file.find(", "));
        if (first.size() < file.size() && is_file(first, words)) return {std::string(first), nullptr, named.option};
        const auto number = file.rfind(':');
        if (number == std::string_view::npos || !is_file(file.substr(0, number), words)) continue;
        if (const auto line = base::parse_integer(file.substr(number + 1)))
            return {std::string(file.substr(0, number)), *line, named.option};
    }
    return named;
}

}  // namespace

std::string error_json(const std::string& message, int exit_code, const std::vector<std::string>& words) {
    const auto named = named_by(message, words);
    return io::json_text(nlohmann::ordered_json{{"schema", 1},
                                                {"error", message},
                                                {"exit_code", exit_code},
                                                {"file", named.file},
                                                {"line", named.line},
                                                {"option", named.option}});
}

bool asks_for_json(const std::vector<std::string>& words) {
    const auto end = std::find(words.begin(), words.end(), "--");
    return std::find(words.begin(), end, "--json") != end;
}

void refuse_workspace(const std::filesystem::path& database) {
    std::error_code ignored;
    if (std::filesystem::exists(database / "workspace.json", ignored) &&
        !std::filesystem::exists(database / "manifest.csv", ignored))
        throw InputError(fmt::format(
            "{}: is a workspace that 'mimik preprocess' made; give the database of scans that it was made of",
            database.string()));
}

std::string with_file(const std::vector<std::filesystem::path>& files, std::string_view message) {
    if (message.starts_with("--")) return std::string(message);  // of an option, not of a file
    for (const auto& file : files)
        if (!file.empty() && message.find(file.string()) != std::string_view::npos) return std::string(message);
    if (files.empty() || files.front().empty()) return std::string(message);
    return fmt::format("{}: {}", files.front().string(), message);
}

std::string no_memory_for(const std::vector<std::filesystem::path>& files) {
    std::vector<std::string> names;
    for (const auto& file : files) names.push_back(file.string());
    return fmt::format("{}: more memory is needed than there is; give {}", fmt::join(names, ", "),
                       names.size() == 1 ? "a smaller file" : "smaller files");
}

}  // namespace mimik::cli
