#include "io/texture_path.h"

#include <algorithm>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::io {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t longest_part = 255, longest_path = 4096;

bool has_control_character(std::string_view text) {
    return std::any_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; });
}

/// The parts of a path of any system that can lie in a folder. A file's name alone is left of a path with "..".
std::vector<std::string> parts_of(std::string_view written) {
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin <= written.size();) {
        const auto end = std::min(written.find_first_of("/\\", begin), written.size());
        const auto part = written.substr(begin, end - begin);
        begin = end + 1;
        if (part == "..")
            parts.clear();
        else if (!part.empty() && part != "." && !part.ends_with(':'))
            parts.emplace_back(part.size() > 2 && part[1] == ':' ? part.substr(2) : part);  // "C:skin.png"
    }
    return parts;
}

std::string without_percent(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool blank = text.substr(i, 3) == "%20";
        out += blank ? ' ' : text[i];
        i += blank ? 2 : 0;
    }
    return out;
}

/// A part of a path as the folder has it: exactly, else with other capitals.
std::optional<std::string> entry_of(const fs::path& folder, const std::string& part, bool is_last) {
    std::error_code ignored;
    const auto fits = [&](const fs::path& path) {
        return is_last ? fs::is_regular_file(path, ignored) : fs::is_directory(path, ignored);
    };
    if (fits(folder / part)) return part;
    std::vector<std::string> names;
    for (fs::directory_iterator it(folder.empty() ? fs::path(".") : folder, ignored), end; !ignored && it != end;
         it.increment(ignored)) {
        auto name = it->path().filename().string();
        if (base::equal_ignoring_case(name, part) && fits(it->path())) names.push_back(std::move(name));
    }
    if (names.empty()) return std::nullopt;
    return *std::min_element(names.begin(), names.end());
}

std::string found(const fs::path& folder, std::span<const std::string> parts) {
    fs::path at = folder;
    std::string path;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const auto entry = entry_of(at, parts[k], k + 1 == parts.size());
        if (!entry) return {};
        at /= *entry;
        path += (path.empty() ? "" : "/") + *entry;
    }
    return path;
}

}  // namespace

std::string checked_texture_path(const std::string& texture, const std::string& file) {
    std::string path;
    bool good = true;
    for (std::size_t begin = 0; begin <= texture.size();) {
        const auto end = std::min(texture.find('/', begin), texture.size());
        const auto part = std::string_view(texture).substr(begin, end - begin);
        begin = end + 1;
        if (part == "." && end < texture.size()) continue;
        good = good && !part.empty() && part != "." && part != ".." && part.size() <= longest_part &&
               part.find_first_of("\\:") == std::string_view::npos && !has_control_character(part);
        path += path.empty() ? "" : "/";
        path += part;
    }
    if (!good || path.size() > longest_path)
        throw InputError(
            fmt::format("{}: texture name is {}; put the image into the mesh's folder or one below it, and name it "
                        "from there, with '/' and without '..'",
                        file, base::in_quotes(texture)));
    return path;
}

std::string find_beside(const fs::path& folder, std::string_view written) {
    written = base::trimmed(written);
    if (written.size() >= 2 && written.front() == '"' && written.back() == '"')
        written = base::trimmed(written.substr(1, written.size() - 2));
    if (written.size() > longest_path || has_control_character(written)) return {};
    const auto plain = without_percent(written);
    for (const std::string_view spelling : {written, std::string_view(plain)}) {
        const auto parts = parts_of(spelling);
        if (parts.size() > 64 ||
            std::any_of(parts.begin(), parts.end(), [](const std::string& part) { return part.size() > longest_part; }))
            return {};
        for (std::size_t begin = 0; begin < parts.size(); ++begin)
            if (auto path = found(folder, std::span(parts).subspan(begin)); !path.empty()) return path;
        if (plain == written) break;
    }
    return {};
}

bool lies_below(const fs::path& file, const fs::path& folder) {
    std::error_code error;
    const auto inner = fs::canonical(file, error);
    if (error) return false;
    const auto outer = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
    if (error) return false;
    return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

}  // namespace mimik::io
