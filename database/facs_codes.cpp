#include "database/facs_codes.h"

#include <charconv>
#include <optional>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::database {
namespace {

constexpr std::size_t max_lines = 100'000;
constexpr std::size_t max_remarks = 20;

std::optional<FacsScore> parse_code(std::string_view code) {
    FacsScore score;
    if (code.starts_with('L') || code.starts_with('R')) {
        score.side = code.front() == 'L' ? facs::Side::left : facs::Side::right;
        code.remove_prefix(1);
    }
    const auto [end, error] = std::from_chars(code.data(), code.data() + code.size(), score.action_unit);
    if (error != std::errc{} || score.action_unit < 0 || score.action_unit > 999) return std::nullopt;
    code.remove_prefix(static_cast<std::size_t>(end - code.data()));
    if (code.size() == 1 && code[0] >= 'A' && code[0] <= 'E') {
        score.intensity = code[0];
        code = {};
    }
    return code.empty() ? std::optional(score) : std::nullopt;
}

struct ParsedCodes {
    std::vector<FacsScore> scores;
    bool any = false;  ///< a code was understood, if only the 0
    std::vector<std::string_view> unknown;
};

ParsedCodes parse_codes(std::string_view codes) {
    ParsedCodes parsed;
    for (auto end = std::size_t{0}; end != std::string_view::npos;) {
        end = codes.find('+');
        const auto code = base::trimmed(codes.substr(0, end));
        if (const auto score = parse_code(code)) {
            parsed.any = true;
            if (score->action_unit > 0) parsed.scores.push_back(*score);
        } else {
            parsed.unknown.push_back(code);
        }
        if (end != std::string_view::npos) codes.remove_prefix(end + 1);
    }
    return parsed;
}

}  // namespace

FacsCodes parse_facs_codes(std::string_view text, const std::string& name) {
    FacsCodes result;
    std::size_t not_understood = 0;
    base::LineReader lines(text, name);
    const auto remark = [&](const std::string& what) {
        if (not_understood++ < max_remarks)
            result.remarks.push_back(fmt::format("{}: line {}: {}", name, lines.number(), what));
    };
    while (lines.next()) {
        if (lines.number() > max_lines)
            throw InputError(fmt::format("{}: more than {} lines; is it the right file?", name, max_lines));
        const auto line = base::trimmed(lines.line());
        const auto arrow = line.find("->");
        if (line.empty()) continue;
        if (arrow != std::string_view::npos) {
            auto scan = base::trimmed(line.substr(0, arrow));
            scan = scan.substr(0, scan.find('.'));  // some lists name the file
            const auto id = parse_scan_name(scan);
            auto codes = parse_codes(base::trimmed(line.substr(arrow + 2)));
            if (id && codes.any) {
                for (const auto code : codes.unknown)
                    remark(
                        fmt::format("code {} of {} is no action unit with an optional L or R before and A to E after "
                                    "it; the code is left out",
                                    base::in_quotes(code), id->name()));
                result.scores[*id] = std::move(codes.scores);
                continue;
            }
        }
        if (lines.number() <= 2) continue;  // the two header lines, which may show the form with its arrow
        remark(fmt::format("{} is not of the form 'bs000_LFAU_12_0 -> 6B+12C'; the line is left out",
                           base::in_quotes(line)));
    }
    if (not_understood > 0 && result.scores.empty())
        throw InputError(
            fmt::format("{}: no line is of the form 'bs000_LFAU_12_0 -> 6B+12C'; is it the right file?", name));
    if (not_understood > max_remarks)
        result.remarks.push_back(fmt::format(
            "{}: {} not understood", name,
            base::counted(not_understood - max_remarks, "more line or code is", "more lines or codes are")));
    return result;
}

}  // namespace mimik::database
