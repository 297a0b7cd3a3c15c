#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/error_report.h"
#include "cli/notes.h"
#include "cli/terminal.h"
#include "database/known_databases.h"
#include "database/scan_index.h"
#include "io/json_values.h"

namespace mimik::cli {
namespace {

using namespace database;

struct Request {
    Common common;
    std::filesystem::path root;
    Selection selection;
    std::string side, unit = "mm";
    std::vector<std::string> action_units;
    ScanIndexOptions index;
    bool no_index = false, no_catalogue = false;  // the second is what the first was called
    bool list = false;
};

struct Counts {
    std::size_t errors = 0, warnings = 0, notes = 0, unreadable = 0;

    void add(const ScanSummary& summary) {
        unreadable += summary.error.empty() ? 0U : 1U;
        for (const auto& finding : summary.findings)
            ++(finding.severity == Severity::error ? errors : finding.severity == Severity::warning ? warnings : notes);
    }
    [[nodiscard]] std::string text(bool checked) const {
        if (!checked) return unreadable ? fmt::format("{} unreadable", unreadable) : "-";
        std::vector<std::string> parts;
        const auto part = [&](std::size_t count, const char* word) {
            if (count) parts.push_back(base::counted(count, word));
        };
        part(errors, "error");
        part(warnings, "warning");
        part(notes, "note");
        return parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, ", "));
    }
};

nlohmann::ordered_json json_of(const ScanEntry& entry, const ScanSummary& summary) {
    nlohmann::ordered_json json = {{"name", entry.id.name()},
                                   {"file", entry.scan_file.string()},
                                   {"group", entry.id.group},
                                   {"code", entry.id.code},
                                   {"repetition", entry.id.repetition},
                                   {"action_unit", nullptr},
                                   {"side", to_string(entry.id.side())},
                                   {"low_intensity", entry.id.low_intensity()},
                                   {"rows", summary.rows},
                                   {"cols", summary.cols},
                                   {"points", summary.points},
                                   {"landmarks", summary.landmarks},
                                   {"missing_landmarks", summary.missing_landmarks()},
                                   {"remarks", summary.remarks},
                                   {"error", nullptr},
                                   {"findings", nullptr}};
    if (const auto unit = entry.id.action_unit()) json["action_unit"] = *unit;
    if (!summary.error.empty()) json["error"] = summary.error;
    if (summary.checked) json["findings"] = nlohmann::ordered_json::parse(to_json(summary.findings));
    auto scores = nlohmann::ordered_json::array();
    for (const auto& score : entry.facs_scores)
        scores.push_back({{"action_unit", score.action_unit},
                          {"side", to_string(score.side)},
                          {"intensity", score.intensity ? std::string(1, score.intensity) : std::string()}});
    json["facs_scores"] = std::move(scores);
    return json;
}

/// Columns as wide as their widest cell; the first is left-aligned, and the last.
void print_table(std::vector<std::vector<std::string>> rows) {
    for (auto& row : rows)
        for (auto& cell : row) cell = one_line(cell);
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const auto& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c) {
            if (c > 0) line += "  ";
            if (c + 1 == row.size())
                line += row[c];
            else
                line += c == 0 ? fmt::format("{:<{}}", row[c], widths[c]) : fmt::format("{:>{}}", row[c], widths[c]);
        }
        std::cout << line << '\n';
    }
}

std::string landmark_counts(std::size_t least, std::size_t most) {
    return least == most ? fmt::format("{}", least) : fmt::format("{}-{}", least, most);
}

void print_subjects(const ScanDatabase& database, const std::vector<const ScanEntry*>& scans,
                    const ScanIndexResult& result) {
    // Groups in the order in which Bosphorus counts them, then those it does not have.
    std::vector<std::string> groups = {"N", "E", "LFAU", "UFAU", "CAU", "YR", "PR", "CR", "O", "IGN"};
    std::set<std::string> there;
    for (const auto* entry : scans) there.insert(entry->id.group);
    std::erase_if(groups, [&](const auto& group) { return !there.contains(group); });
    for (const auto& group : there)
        if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);

    std::vector<std::vector<std::string>> rows(1, {"subject", "sex", "scans"});
    rows[0].insert(rows[0].end(), groups.begin(), groups.end());
    rows[0].insert(rows[0].end(), {"landmarks", "defects"});
    for (std::size_t begin = 0; begin < scans.size();) {
        std::size_t end = begin, least = SIZE_MAX, most = 0;
        std::map<std::string, int> counts;
        Counts defects;
        bool checked = true;
        for (; end < scans.size() && scans[end]->id.subject == scans[begin]->id.subject; ++end) {
            ++counts[scans[end]->id.group];
            const auto& summary = result.summaries[end];
            least = std::min(least, summary.landmarks.size());
            most = std::max(most, summary.landmarks.size());
            defects.add(summary);
            checked = checked && summary.checked;
        }
        const auto& subject = scans[begin]->id.subject;
        std::vector<std::string> row = {subject + (database.hidden(subject) ? " (hidden)" : ""), scans[begin]->sex,
                                        std::to_string(end - begin)};
        for (const auto& group : groups) row.push_back(counts[group] ? std::to_string(counts[group]) : "");
        row.push_back(landmark_counts(least, most));
        row.push_back(defects.text(checked));
        rows.push_back(std::move(row));
        begin = end;
    }
    print_table(rows);
}

void print_scans(const ScanDatabase& database, const std::vector<const ScanEntry*>& scans,
                 const ScanIndexResult& result) {
    std::vector<std::vector<std::string>> rows(1, {"scan", "points", "landmarks", "AU", "side", "FACS", "defects"});
    for (std::size_t i = 0; i < scans.size(); ++i) {
        const auto& entry = *scans[i];
        const auto& summary = result.summaries[i];
        Counts defects;
        defects.add(summary);
        std::vector<std::string> facs;
        for (const auto& score : entry.facs_scores)
            facs.push_back(fmt::format("{}{}{}",
                                       score.side == facs::Side::left    ? "L"
                                       : score.side == facs::Side::right ? "R"
                                                                         : "",
                                       score.action_unit, score.intensity ? std::string(1, score.intensity) : ""));
        const auto unit = entry.id.action_unit();
        rows.push_back({entry.id.name() + (database.hidden(entry.id.subject) ? " (hidden)" : ""),
                        std::to_string(summary.points), std::to_string(summary.landmarks.size()),
                        unit ? std::to_string(*unit) : "",
                        entry.id.side() == facs::Side::both ? "" : to_string(entry.id.side()),
                        fmt::format("{}", fmt::join(facs, "+")), defects.text(summary.checked)});
    }
    print_table(rows);
}

/// Findings that are alike in severity, kind and mend, with the scans that have them, each once.
struct FindingGroup {
    const Finding* first = nullptr;
    struct Scan {
        std::string name, what, where;
    };
    std::vector<Scan> scans;
};

/// Worst first; otherwise in the order of the scans.
std::vector<FindingGroup> groups_of(const std::vector<const ScanEntry*>& scans, const ScanIndexResult& result,
                                    bool notes) {
    std::vector<FindingGroup> groups;
    std::map<std::tuple<Severity, std::string, std::string>, std::size_t> place;
    for (std::size_t i = 0; i < scans.size(); ++i)
        for (const auto& finding : result.summaries[i].findings) {
            if (!notes && finding.severity == Severity::note) continue;
            const auto [at, is_new] = place.try_emplace({finding.severity, finding.kind, finding.mend}, groups.size());
            if (is_new) groups.push_back({&finding, {}});
            auto& members = groups[at->second].scans;
            auto name = scans[i]->id.name();
            if (!members.empty() && members.back().name == name)
                members.back().what += "; " + finding.what;
            else
                members.push_back({std::move(name), finding.what, finding.where});
        }
    std::stable_sort(groups.begin(), groups.end(), [](const FindingGroup& a, const FindingGroup& b) {
        return a.first->severity > b.first->severity;
    });
    return groups;
}

/// `all`: every note and every scan; else three scans of a group stand for it.
void print_findings(const std::vector<const ScanEntry*>& scans, const ScanIndexResult& result, bool all) {
    for (std::size_t i = 0; i < scans.size(); ++i) {
        const auto& summary = result.summaries[i];
        if (!summary.checked && !summary.error.empty())
            std::cout << fmt::format("\n{}: unreadable: {}\n", one_line(scans[i]->id.name()), one_line(summary.error));
        if (all && !summary.checked)  // the doctor says the same with a mend
            for (const auto& remark : summary.remarks)
                std::cout << fmt::format("\n{}: {}\n", one_line(scans[i]->id.name()), one_line(remark));
    }
    for (const auto& group : groups_of(scans, result, all)) {
        constexpr std::size_t most = 3;
        const std::size_t shown = all || group.scans.size() == most + 1 ? group.scans.size() : most;
        std::cout << fmt::format("\n{} ({}): {}\n", to_string(group.first->severity), group.first->kind,
                                 base::counted(group.scans.size(), "scan"));
        for (std::size_t k = 0; k < group.scans.size() && k < shown; ++k)
            std::cout << fmt::format("    {}: {}\n        at {}\n", one_line(group.scans[k].name),
                                     one_line(group.scans[k].what), one_line(group.scans[k].where));
        if (group.scans.size() > shown)
            std::cout << fmt::format("    and {} more; --list names every one\n", group.scans.size() - shown);
        std::cout << fmt::format("    mend: {}\n", one_line(group.first->mend));
    }
}

void print_json(const ScanDatabase& database, const std::vector<const ScanEntry*>& scans,
                const ScanIndexResult& result) {
    auto counts = nlohmann::ordered_json::array();
    for (const auto& group : groups_of(scans, result, true))
        counts.push_back({{"severity", to_string(group.first->severity)},
                          {"kind", group.first->kind},
                          {"mend", group.first->mend},
                          {"scans", group.scans.size()}});
    nlohmann::ordered_json json = {{"schema", 1},
                                   {"database", database.root.string()},
                                   {"layout", database.layout == DatabaseLayout::manifest ? "manifest" : "bosphorus"},
                                   {"hidden_subjects", database.hidden_subjects},
                                   {"one_sided_codes",
                                    {{"own_side", database.code_sides.own_side},
                                     {"other_side", database.code_sides.other_side},
                                     {"undecided", database.code_sides.undecided},
                                     {"names_are_the_viewers", database.code_sides.swapped}}},
                                   {"remarks", database.remarks},
                                   {"index",
                                    {{"file", result.file.string()},
                                     {"scans_read", result.scans_read},
                                     {"scans_remembered", result.scans_remembered},
                                     {"remark", result.remark}}},
                                   {"finding_counts", std::move(counts)},
                                   {"subjects", nlohmann::ordered_json::array()}};
    auto& subjects = json["subjects"];
    for (std::size_t i = 0; i < scans.size(); ++i) {
        const auto& entry = *scans[i];
        if (subjects.empty() || subjects.back()["subject"] != entry.id.subject)
            subjects.push_back({{"subject", entry.id.subject},
                                {"sex", entry.sex},
                                {"hidden", database.hidden(entry.id.subject)},
                                {"scans", nlohmann::ordered_json::array()}});
        subjects.back()["scans"].push_back(json_of(entry, result.summaries[i]));
    }
    std::cout << io::json_text(json);
}

int action_unit_number(const std::string& text) {
    std::string_view word = text;
    if (base::equal_ignoring_case(word.substr(0, 2), "AU")) word.remove_prefix(2);
    constexpr std::int64_t most = 999;
    if (const auto number = base::parse_integer(word); number && *number > 0 && *number <= most)
        return static_cast<int>(*number);
    throw InputError(fmt::format(
        "--au is '{}'; give the number of an AU, such as 12 or AU12, and the side, if it matters, by --side", text));
}

int run(Request& request) {
    for (const auto& text : request.action_units) request.selection.action_units.push_back(action_unit_number(text));
    if (!request.side.empty()) request.selection.side = facs::parse_side(request.side);
    if (request.no_catalogue && !request.common.quiet)
        say_note("--no-catalogue is called --no-index now; the old name will go with a later version");
    request.index.use_cache = !request.no_index && !request.no_catalogue;
    check_by_option(
        {{"max_hole_mm", "--max-hole-mm"}, {"spike_mm", "--spike-mm"}, {"landmark_off_scan_mm", "--landmark-off-mm"}},
        [&] { request.index.doctor.check(); });
    refuse_workspace(request.root);
    const auto database = open_database(request.root, io::parse_length_unit(request.unit));
    if (request.index.use_cache) remember_database(database.root);
    const auto scans = select(database, request.selection);
    ScanIndexResult result;
    {
        Progress progress(request.common, request.index.check ? "checking" : "reading", scans.size());
        request.index.progress = [&](const ScanEntry& entry) { progress.advance(entry.id.name()); };
        result = scan_index(database, scans, request.index);
    }
    const auto bad = static_cast<std::size_t>(std::count_if(result.summaries.begin(), result.summaries.end(),
                                                            [](const ScanSummary& s) { return s.has_error(); }));

    if (request.common.json) {
        print_json(database, scans, result);
    } else {
        std::set<std::string> subjects;
        for (const auto* entry : scans) subjects.insert(entry->id.subject);
        std::cout << fmt::format(
            "{}: {} of {}{}\n", database.root.string(), base::counted(scans.size(), "scan"),
            base::counted(subjects.size(), "subject"),
            scans.size() == database.scans.size() ? "" : fmt::format(" selected from {}", database.scans.size()));
        const bool selected = scans.size() < database.scans.size();
        if (!scans.empty()) (request.list || selected ? print_scans : print_subjects)(database, scans, result);
        print_findings(scans, result, request.list || selected);
        if (!request.common.quiet) {
            if (!result.remark.empty()) std::cerr << "scan index: " << one_line(result.remark) << '\n';
            for (const auto& remark : grouped(database.remarks)) std::cerr << one_line(remark) << '\n';
        }
        if (request.index.check)
            std::cout << fmt::format("\n{} of {} errors\n", bad, base::counted(scans.size(), "scan has", "scans have"));
    }
    const bool unreadable = std::any_of(result.summaries.begin(), result.summaries.end(),
                                        [](const ScanSummary& s) { return !s.error.empty(); });
    return unreadable || (request.index.check && bad > 0) ? exit_done_with_failures : exit_done;
}

}  // namespace

void add_scans_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand("scans", "List the scans of a database; --check says what is wrong with them");
    const auto request = std::make_shared<Request>();
    add_common_options(*command, request->common);
    command->add_option("DB", request->root, "Folder with bs000, bs001, ... or with manifest.csv")->required();
    command->add_flag("--check", request->index.check, "Examine every scan and say how to mend what is wrong");
    command->add_option("--unit", request->unit, "Unit of the scans of which manifest.csv says none: mm, cm, m or inch")
        ->capture_default_str();
    command->add_option("--subject", request->selection.subjects, "Only these subjects, such as bs003,bs007")
        ->delimiter(',');
    command->add_option("--group", request->selection.groups, "Only these groups, such as N,LFAU")->delimiter(',');
    command->add_option("--au", request->action_units, "Only these action units, such as 1,12")->delimiter(',');
    command->add_option("--side", request->side, "Only left, right (the subject's own) or both-sided scans");
    command->add_flag("--list", request->list, "One line per scan, and every note (as when scans are selected)");
    command->add_flag("--no-index", request->no_index, "Read every scan; leave the user's cache alone");
    command->add_flag("--no-catalogue", request->no_catalogue)->group("");  // not in --help
    auto& doctor = request->index.doctor;
    command->add_option("--max-hole-mm", doctor.max_hole_mm, "A hole that takes more of the skin gets a warning")
        ->capture_default_str();
    command->add_option("--spike-mm", doctor.spike_mm, "Points further off their neighbourhood are spikes")
        ->capture_default_str();
    command
        ->add_option("--landmark-off-mm", doctor.landmark_off_scan_mm, "Landmarks further off the scan get a warning")
        ->capture_default_str();
    command->callback([request, &exit_code] { exit_code = run(*request); });
}

}  // namespace mimik::cli
