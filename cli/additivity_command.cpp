#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/notes.h"
#include "evaluation/additivity.h"
#include "io/json_values.h"

namespace mimik::cli {
namespace {

using evaluation::Additivity;
using evaluation::AdditivityShare;

struct Arguments {
    Common common;
    std::string workspace, catalogue_file, emotions = facs::usual_emotion_set, output;
    std::vector<std::string> expressions;
    evaluation::AdditivityOptions options;
};

std::string csv(const std::vector<Additivity>& all) {
    std::string text =
        "expression,units,subject,vertices,motion_mm,sum_off_mm,scaled_sum_off_mm,resultant_off_mm,gain\n";
    for (const auto& one : all)
        for (const auto& each : one.cases)
            text += fmt::format("{},{},{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n", one.expression.code(),
                                fmt::join(one.units, "+"), each.subject, each.vertices, each.motion_mm, each.sum_off_mm,
                                each.scaled_sum_off_mm, each.resultant_off_mm, each.gain);
    return text;
}

std::string words(const AdditivityShare& share) {
    if (!share.interval) return fmt::format("{:.2f}", share.share);
    return fmt::format("{:.2f} [{:.2f}, {:.2f}]", share.share, share.interval->low, share.interval->high);
}

void say(const std::vector<Additivity>& all) {
    std::cout << "Part of an expression's motion that its Action Units give, on the same person\n\n"
                 "| expression | units | people | motion mm | sum | sum x gain | gain | resultant | strongest alone |\n"
                 "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
    for (const auto& one : all) {
        double motion = 0;
        for (const auto& each : one.cases) motion += each.motion_mm / static_cast<double>(one.cases.size());
        std::cout << fmt::format("| {} | {} | {} | {:.2f} | {} | {} | {:.2f} | {} | {} (AU {}) |\n",
                                 one.expression.name(), fmt::join(one.units, "+"), one.cases.size(), motion,
                                 words(one.sum), words(one.scaled_sum), one.gain, words(one.resultant),
                                 words(one.alone), one.strongest);
    }
}

nlohmann::ordered_json to_json(const AdditivityShare& share) {
    nlohmann::ordered_json one{{"share", share.share}};
    one["interval"] = share.interval ? nlohmann::ordered_json{share.interval->low, share.interval->high} : nullptr;
    return one;
}

nlohmann::ordered_json to_json(const Additivity& one) {
    auto cases = nlohmann::ordered_json::array();
    for (const auto& each : one.cases)
        cases.push_back({{"subject", each.subject},
                         {"vertices", each.vertices},
                         {"motion_mm", each.motion_mm},
                         {"sum_off_mm", each.sum_off_mm},
                         {"scaled_sum_off_mm", each.scaled_sum_off_mm},
                         {"resultant_off_mm", each.resultant_off_mm},
                         {"alone_off_mm", each.alone_off_mm},
                         {"gain", each.gain}});
    return {{"expression", one.expression.code()},
            {"units", one.units},
            {"sum", to_json(one.sum)},
            {"scaled_sum", to_json(one.scaled_sum)},
            {"gain", one.gain},
            {"resultant", to_json(one.resultant)},
            {"strongest", one.strongest},
            {"alone", to_json(one.alone)},
            {"registration_mm", one.registration_mm},
            {"cases", cases}};
}

int run(const Arguments& arguments) {
    check_by_option({{"moving_mm", "--moving"}, {"resamples", "--resamples"}, {"confidence", "--confidence"}},
                    [&] { arguments.options.check(); });
    const auto catalogue =
        (arguments.catalogue_file.empty() ? facs::builtin_catalogue() : facs::read_catalogue(arguments.catalogue_file))
            .with_emotions(arguments.emotions);
    refuse_doubles("--expression", arguments.expressions);
    const preprocessing::Workspace workspace(arguments.workspace);
    std::vector<facs::Expression> wanted;
    for (const auto& text : arguments.expressions) wanted.push_back(catalogue.expression(text));
    if (wanted.empty()) wanted = evaluation::combined_expressions(workspace, catalogue);
    if (wanted.empty())
        throw InputError(fmt::format(
            "{}: nobody was scanned with an expression of several AUs and with each of them alone; add such "
            "scans to the database",
            arguments.workspace));
    const evaluation::PerformanceReader reader(workspace);
    evaluation::FailureList failures;
    std::vector<Additivity> all;
    {
        Progress progress(arguments.common, "additivity", wanted.size());
        for (const auto& expression : wanted) {
            try {
                all.push_back(evaluation::additivity(reader, catalogue, expression, arguments.options, failures));
            } catch (const InputError& e) {
                failures.add(e.what());
            }
            progress.advance(expression.name());
        }
    }
    if (all.empty())
        throw InputError(fmt::format("no expression was measured ({})", fmt::join(failures.sorted(), "; ")));
    if (!arguments.output.empty()) base::write_atomically(arguments.output, csv(all));
    if (arguments.common.json) {
        auto list = nlohmann::ordered_json::array();
        for (const auto& one : all) list.push_back(to_json(one));
        std::cout << io::json_text(
            nlohmann::ordered_json{{"schema", 1}, {"expressions", list}, {"failures", failures.sorted()}});
    } else {
        say(all);
        if (!arguments.output.empty()) std::cout << "\n" << arguments.output << "\n";
    }
    say_failures(failures.sorted());
    return failures.sorted().empty() ? exit_done : exit_done_with_failures;
}

}  // namespace

void add_additivity_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand("additivity", "Whether Action Units add up to expressions made of them");
    auto arguments = std::make_shared<Arguments>();
    command->add_option("WORK", arguments->workspace, "Folder made by 'mimik preprocess'")->required();
    command
        ->add_option("--expression", arguments->expressions,
                     "Expressions of several AUs: HAPPY, AU12+AU15; without: all that were scanned, with their AUs")
        ->delimiter(',');
    command->add_option("--emotions", arguments->emotions, "What emotions are made of: emfacs, thesis (its Table 3-3)")
        ->capture_default_str();
    command->add_option("--catalogue", arguments->catalogue_file,
                        "Another FACS catalogue (TOML) than the built-in one");
    command->add_option("--moving", arguments->options.moving_mm, "A vertex counts from so much motion on, mm")
        ->capture_default_str();
    command->add_option("--resamples", arguments->options.resamples, "Of the bootstrap over people")
        ->capture_default_str();
    command->add_option("--confidence", arguments->options.confidence, "Of its intervals, share")
        ->capture_default_str();
    command->add_option("--seed", arguments->options.seed, "Of the bootstrap")->capture_default_str();
    command->add_option("-o,--output", arguments->output, "CSV file to write, a row per person");
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
