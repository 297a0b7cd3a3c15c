#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "animation/model_method.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "base/version.h"
#include "cli/command.h"
#include "cli/notes.h"
#include "evaluation/tune_points.h"
#include "facs/catalogue_edit.h"
#include "io/json_values.h"

namespace mimik::cli {
namespace {

using evaluation::OwnScore;
using evaluation::TunedUnit;

struct Arguments {
    Common common;
    std::vector<std::string> workspaces, unseen, action_units;
    std::string catalogue_file, output;
    int hold_out = 3;
    bool fixed_carried = false;
    evaluation::TuneOptions options;
};

/// A workspace that stays open, and who of it takes part.
struct OpenWorkspace {
    explicit OpenWorkspace(const std::string& folder) : workspace(folder), reader(workspace) {}
    preprocessing::Workspace workspace;
    evaluation::PerformanceReader reader;
};

struct Groups {
    std::vector<std::unique_ptr<OpenWorkspace>> open;
    std::vector<evaluation::TuneGroup> training, unseen;
};

/// Without workspaces of their own, every so many-th subject of the training ones is not seen.
Groups open_groups(const Arguments& arguments) {
    Groups groups;
    for (const auto& folder : arguments.workspaces) {
        const auto& open = *groups.open.emplace_back(std::make_unique<OpenWorkspace>(folder));
        evaluation::TuneGroup training{&open.reader, {}}, unseen{&open.reader, {}};
        const auto subjects = open.workspace.shown_subjects();
        for (std::size_t k = 0; k < subjects.size(); ++k) {
            const bool held = arguments.unseen.empty() && arguments.hold_out > 0 &&
                              (k + 1) % static_cast<std::size_t>(arguments.hold_out) == 0;
            (held ? unseen : training).subjects.push_back(subjects[k]);
        }
        groups.training.push_back(std::move(training));
        if (!unseen.subjects.empty()) groups.unseen.push_back(std::move(unseen));
    }
    for (const auto& folder : arguments.unseen) {
        for (const auto& training : arguments.workspaces)
            if (std::error_code none; std::filesystem::equivalent(folder, training, none))
                throw InputError(fmt::format("--unseen: {} is tuned on, too; give another, or leave it out", folder));
        const auto& open = *groups.open.emplace_back(std::make_unique<OpenWorkspace>(folder));
        groups.unseen.push_back({&open.reader, open.workspace.shown_subjects()});
    }
    return groups;
}

/// The AUs that were typed, or those of the thesis.
std::vector<int> units_of(const Arguments& arguments, const facs::FacsCatalogue& catalogue) {
    std::vector<int> units;
    for (const auto& text : arguments.action_units) {
        const auto expression = catalogue.expression(text);
        if (expression.units().size() != 1 || expression.units().front().side != facs::Side::both)
            throw InputError(fmt::format(
                "--au: '{}' is not one AU on both sides; points are tuned on both at once, such as 12", text));
        const int unit = expression.units().front().unit;
        if (std::find(units.begin(), units.end(), unit) != units.end())
            throw InputError(fmt::format("--au: AU{} is asked for twice; give it once", unit));
        units.push_back(unit);
    }
    return units;
}

std::string people_of(const evaluation::TuneGroup& group) {
    const auto& subjects = group.subjects;
    const auto origin = group.reader->truth_origin();
    auto text = subjects.empty()
                    ? std::string("nobody")
                    : fmt::format("{} ({})", base::counted(subjects.size(), "subject"),
                                  subjects.size() > 2 ? fmt::format("{} to {}", subjects.front(), subjects.back())
                                                      : fmt::format("{}", fmt::join(subjects, ", ")));
    if (origin) return fmt::format("{} seed {}, {}", origin->face_model, origin->seed, text);
    return fmt::format("{}, {}", group.reader->workspace().database_root().filename().string(), text);
}

std::string scores_text(const char* whom, const std::vector<OwnScore>& scores) {
    std::string text;
    for (const auto& score : scores)
        text += fmt::format(
            "#   {:<9} {:>5}: {:>3} cases, {:.3f} -> {:.3f} mm (doing nothing {:.3f}), explained {:.3f} "
            "-> {:.3f}\n",
            whom, score.expression.code(), score.cases, score.before_mm, score.after_mm, score.nothing_mm,
            score.explained_before(), score.explained_after());
    return text;
}

/// What the file says of itself, above the catalogue that it began as.
std::string header_of(const Arguments& arguments, const Groups& groups, const std::vector<TunedUnit>& tuned,
                      const std::string& from) {
    const auto& options = arguments.options;
    std::string text = fmt::format(
        "# Points tuned by 'mimik tune' (Mimik {}), beginning with the {}: the procedure of the thesis, sections "
        "5.5.1\n"
        "# and 5.5.2, done by a search. Each source was animated by its own model (method thesis) and compared with "
        "its\n"
        "# own expressive scan; the offsets of the points moved by at most {} mm, left and right alike.\n"
        "# Search: pattern search, steps {} to {} mm, no chance in it.\n#\n",
        base::version(), from, options.most_mm, options.search.first_step, options.search.last_step);
    for (const auto& group : groups.training) text += "# Tuned on: " + people_of(group) + "\n";
    for (const auto& group : groups.unseen) text += "# Not seen: " + people_of(group) + "\n";
    text += "# Mean error in the zone, of the source on itself, before -> after:\n#\n";
    for (const auto& unit : tuned) {
        text += fmt::format("# AU{}: {} evaluations{}\n", unit.unit, unit.evaluations,
                            unit.converged ? "" : ", stopped before it was done");
        text += scores_text("training", unit.training) + scores_text("not seen", unit.unseen);
    }
    return text + "\n";
}

nlohmann::json scores_json(const std::vector<OwnScore>& scores) {
    auto list = nlohmann::json::array();
    for (const auto& score : scores)
        list.push_back({{"expression", score.expression.code()},
                        {"cases", score.cases},
                        {"before_mm", score.before_mm},
                        {"after_mm", score.after_mm},
                        {"nothing_mm", score.nothing_mm},
                        {"explained_before", score.explained_before()},
                        {"explained_after", score.explained_after()}});
    return list;
}

nlohmann::json to_json(const TunedUnit& unit) {
    auto points = nlohmann::json::array();
    for (const auto& point : unit.points)
        points.push_back({{"name", point.name},
                          {"offset", {point.lateral, point.up}},
                          {"was", {point.was_lateral, point.was_up}},
                          {"moved_mm", point.moved_mm}});
    return {{"au", unit.unit},  {"evaluations", unit.evaluations},        {"converged", unit.converged},
            {"points", points}, {"training", scores_json(unit.training)}, {"unseen", scores_json(unit.unseen)}};
}

void say(const TunedUnit& unit) {
    std::cout << fmt::format("AU{}: {} evaluations{}\n", unit.unit, unit.evaluations,
                             unit.converged ? "" : ", stopped before it was done");
    for (const auto& [whom, scores] : {std::pair("training", &unit.training), std::pair("not seen", &unit.unseen)})
        for (const auto& score : *scores)
            std::cout << fmt::format("  {} {}: explains {:.3f} -> {:.3f} of the source on itself ({})\n", whom,
                                     score.expression.code(), score.explained_before(), score.explained_after(),
                                     base::counted(score.cases, "case"));
}

int run(Arguments& arguments) {
    auto& options = arguments.options;
    options.carried = !arguments.fixed_carried;
    check_by_option({{"most_mm", "--most"},
                     {"first_step", "--first-step"},
                     {"last_step", "--last-step"},
                     {"most_evaluations", "--most-evaluations"}},
                    [&] { options.check(); });
    if (arguments.output.empty()) throw InputError("--output: is empty; name the catalogue file to write");
    const auto text = arguments.catalogue_file.empty() ? std::string(facs::builtin_catalogue_text())
                                                       : base::read_text(arguments.catalogue_file, 1 << 22);
    const auto catalogue =
        arguments.catalogue_file.empty() ? facs::builtin_catalogue() : facs::read_catalogue(arguments.catalogue_file);
    const auto units = units_of(arguments, catalogue);
    refuse_doubles("--au", arguments.action_units);
    const auto groups = open_groups(arguments);
    const auto method = animation::method_by_name("thesis");
    const auto& thesis = dynamic_cast<const animation::ModelMethod&>(*method);
    evaluation::FailureList failures;
    std::vector<TunedUnit> tuned;
    std::vector<facs::PointOffset> offsets;
    {
        Progress progress(arguments.common, "tune",
                          units.size() * static_cast<std::size_t>(options.search.most_evaluations));
        for (const int unit : units) {
            try {
                tuned.push_back(evaluation::tune_points(
                    groups.training, groups.unseen, catalogue, unit, thesis, options, failures,
                    [&](int, double share) { progress.advance(fmt::format("AU{} {:.4f}", unit, 1 - share)); }));
            } catch (const InputError& e) {  // what the others took hours for is not lost
                failures.add(fmt::format("AU{}: {}", unit, e.what()));
                continue;
            }
            for (const auto& point : tuned.back().points)
                if (point.moved_mm > 0) offsets.push_back({unit, point.name, point.lateral, point.up});
        }
    }
    if (tuned.empty()) throw InputError(fmt::format("no AU was tuned ({})", fmt::join(failures.sorted(), "; ")));
    base::write_atomically(arguments.output,
                           header_of(arguments, groups, tuned, catalogue.name()) + facs::with_offsets(text, offsets));
    if (arguments.common.json) {
        auto list = nlohmann::json::array();
        for (const auto& unit : tuned) list.push_back(to_json(unit));
        std::cout << io::json_text(nlohmann::json{
            {"schema", 1}, {"catalogue", arguments.output}, {"units", list}, {"failures", failures.sorted()}});
    } else {
        for (const auto& unit : tuned) say(unit);
        std::cout << arguments.output << '\n';
    }
    say_failures(failures.sorted());
    return failures.sorted().empty() ? exit_done : exit_done_with_failures;
}

}  // namespace

void add_tune_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand("tune", "Move a catalogue's points to where the thesis method does best");
    auto arguments = std::make_shared<Arguments>();
    arguments->action_units = {"1", "2", "4", "12", "14", "15", "17", "20"};
    auto& options = arguments->options;
    command->add_option("WORK", arguments->workspaces, "Folders made by 'mimik preprocess': the subjects tuned on")
        ->required();
    command->add_option("--unseen", arguments->unseen, "Workspaces whose subjects are scored and not tuned on");
    command
        ->add_option("--hold-out", arguments->hold_out,
                     "Without --unseen: every so many-th subject is scored and not tuned on; 0: none")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    command->add_option("--au", arguments->action_units, "AUs whose points move")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--catalogue", arguments->catalogue_file,
                        "Another FACS catalogue (TOML) to begin with than the built-in one");
    command->add_option("-o,--output", arguments->output, "Catalogue file to write")->required();
    command->add_option("--most", options.most_mm, "How far a point may move, mm")->capture_default_str();
    command->add_flag("--fixed-carried", arguments->fixed_carried,
                      "Move points of muscles and wrinkles alone, not those that they carry");
    command->add_option("--first-step", options.search.first_step, "Of the search, mm")->capture_default_str();
    command->add_option("--last-step", options.search.last_step, "Of the search, mm")->capture_default_str();
    command->add_option("--most-evaluations", options.search.most_evaluations, "Of the search, per AU")
        ->capture_default_str();
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
