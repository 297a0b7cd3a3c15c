#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/folder_lock.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/error_report.h"
#include "cli/figure_start.h"
#include "cli/notes.h"
#include "cli/terminal.h"
#include "database/known_databases.h"
#include "database/scan_database.h"
#include "facs/facs_catalogue.h"
#include "io/json_values.h"
#include "preprocessing/preprocess_run.h"
#include "preprocessing/scan_reading.h"
#include "preprocessing/workspace.h"
#include "report/quality_sheet.h"

namespace mimik::cli {
namespace {

struct Arguments {
    Common common;
    std::string database, output, catalogue_file, unit = "mm", cleaning = "own";
    std::vector<CLI::Option*> of_own, of_pcl;  ///< options that one way of cleaning has alone
    std::vector<std::string> expressions;
    bool dry_run = false, sheets = false, keep_all = false;
    preprocessing::PreprocessOptions options;
};

// What one scan costs on one core and on disk. Processor time of a whole run on an AMD EPYC at 2.6 GHz, per scan of
// 35,000 points to a grid of 150 x 150 (bench_whole_job has its parts).
constexpr double seconds_per_scan = 0.043;
constexpr double bytes_per_vertex = 85;
constexpr double sheet_seconds_per_scan = 0.1, sheet_bytes_per_scan = 75e3;

/// A drawing program that is missing is said once, not once a subject, and nothing is written for it in vain.
report::QualitySheetReport draw_sheets(const Arguments& arguments) {
    const preprocessing::Workspace workspace(arguments.output);
    try {
        (void)find_figure_program();
    } catch (const InputError& e) {
        return {0, 0, {fmt::format("no quality sheets: {}", e.what())}};
    }
    const auto subjects = workspace.subjects();
    const auto shown = std::count_if(subjects.begin(), subjects.end(),
                                     [&](const auto& subject) { return !workspace.hidden(subject); });
    Progress progress(arguments.common, "sheets", static_cast<std::size_t>(shown));
    return report::draw_quality_sheets(workspace, draw_figure,
                                       [&](const std::string& subject) { progress.advance(subject); });
}

/// One line for what several scans have in common.
void print_remarks(const preprocessing::PreprocessReport& report, const std::vector<std::string>& of_database) {
    for (const auto& remark : grouped(of_database)) std::cerr << one_line(remark) << '\n';
    std::vector<std::string> notes;
    for (const auto& [scan, remark] : report.remarks) notes.push_back(fmt::format("{}: {}", scan, remark));
    say_notes(notes);
    // Most scans of a database: no reason to look at any of them.
    if (const auto count = report.closed_lips.size(); count > 0)
        std::cerr << fmt::format("{} closed lips, both inner marks on one grid vertex: splines take the first\n",
                                 base::counted(count, "scan has", "scans have"));
}

nlohmann::json listed(const std::vector<preprocessing::ScanRemark>& remarks) {
    auto list = nlohmann::json::array();
    for (const auto& [scan, remark] : remarks) list.push_back({{"scan", scan}, {"remark", remark}});
    return list;
}

int say_plan(const Arguments& arguments, const database::ScanDatabase& database, const facs::FacsCatalogue& catalogue,
             const std::vector<const database::ScanEntry*>& scans) {
    const auto plan = preprocessing::plan_preprocessing(database, arguments.output, catalogue, arguments.options);
    // Another face of a subject means another sheet with all of them.
    const auto on_new_sheet = [&](const database::ScanEntry* entry) {
        const auto& subject = entry->id.subject;
        const auto& unfinished = plan.unfinished_subjects;
        if (database.hidden(subject)) return false;
        return std::find(unfinished.begin(), unfinished.end(), subject) != unfinished.end() ||
               !std::filesystem::exists(std::filesystem::path(arguments.output) / "sheets" / (subject + ".done"));
    };
    const auto faces = static_cast<double>(plan.remaining);
    const auto on_sheets =
        arguments.sheets ? static_cast<double>(std::count_if(scans.begin(), scans.end(), on_new_sheet)) : 0.0;
    const double vertices =
        static_cast<double>(arguments.options.steps.gridding.rows) * arguments.options.steps.gridding.cols;
    const double megabytes = (faces * vertices * bytes_per_vertex + on_sheets * sheet_bytes_per_scan) / 1e6;
    const double seconds = (faces * seconds_per_scan + on_sheets * sheet_seconds_per_scan) / working_threads();
    if (arguments.common.json)
        std::cout << io::json_text(nlohmann::json{{"schema", 1},
                                                  {"dry_run", true},
                                                  {"scans", scans.size()},
                                                  {"up_to_date", plan.up_to_date},
                                                  {"remaining", plan.remaining},
                                                  {"seconds", seconds},
                                                  {"megabytes", megabytes}});
    else
        std::cout << fmt::format("{}: {} up to date, {} remain: about {:.0f} s, {:.0f} MB in {}\n",
                                 base::counted(scans.size(), "scan"), plan.up_to_date, plan.remaining, seconds,
                                 megabytes, arguments.output);
    return exit_done;
}

/// Text becomes expressions here, once.
std::vector<facs::Expression> parsed_expressions(const std::vector<std::string>& texts) {
    std::vector<facs::Expression> expressions;
    for (const auto& text : texts) {
        const auto expression = facs::parse_expression(text);
        if (!expression)
            throw InputError(fmt::format("--expression: {} is no expression; give 12, 12L, HAPPY or the like",
                                         base::in_quotes(text)));
        expressions.push_back(*expression);
    }
    return expressions;
}

/// What can be done about scans that the doctor refuses.
void print_way_out(const preprocessing::PreprocessReport& report) {
    std::set<std::string> kinds;
    for (const auto& failure : report.failures)
        for (const auto& kind : preprocessing::kinds_that_refuse())
            if (failure.reason.find(fmt::format(" ({}): ", kind)) != std::string::npos) kinds.insert(kind);
    if (kinds.empty()) return;
    std::cerr << fmt::format("mend the scans as it says{}, or take them as they are with --accept {}\n",
                             kinds.contains("unit") ? ", give their unit with --unit" : "", fmt::join(kinds, ","));
}

void check_size(const char* option, int lines) {
    constexpr int least = 2, most = 20'000;
    if (lines < least || lines > most)
        throw InputError(fmt::format("{} is {}; give {} to {}", option, lines, least, most));
}

/// An option of the other way of cleaning would be passed over in silence.
void take_cleaning(Arguments& arguments) {
    auto& steps = arguments.options.steps;
    check_by_option({{"cleaning", "--cleaning"}},
                    [&] { steps.cleaning_method = preprocessing::parse_cleaning_method(arguments.cleaning); });
    steps.pcl_cleaning.min_part = steps.cleaning.min_part;
    const bool pcl = steps.cleaning_method == preprocessing::CleaningMethod::pcl;
    for (const auto* option : pcl ? arguments.of_own : arguments.of_pcl)
        if (option->count() > 0)
            throw InputError(fmt::format("{} is an option of --cleaning {}, and --cleaning is {}; leave one out",
                                         option->get_name(), pcl ? "own" : "pcl", arguments.cleaning));
}

void add_cleaning_options(CLI::App& command, Arguments& arguments) {
    auto& steps = arguments.options.steps;
    auto& pcl = steps.pcl_cleaning;
    command
        .add_option("--cleaning", arguments.cleaning,
                    "own, or pcl: PCL's outlier removal and clusters, where libpcl-dev was there at the build")
        ->capture_default_str();
    arguments.of_own = {
        command.add_option("--spike-mm", steps.cleaning.spike_mm, "Farther than this from its neighbours is a spike")
            ->capture_default_str(),
        command
            .add_option("--max-jump-mm", steps.cleaning.max_jump_mm,
                        "Neighbours farther apart belong to different parts")
            ->capture_default_str()};
    arguments.of_pcl = {
        command.add_option("--pcl-neighbours", pcl.neighbours, "Of --cleaning pcl: neighbours that judge a point")
            ->capture_default_str(),
        command
            .add_option("--pcl-deviations", pcl.deviations,
                        "Of --cleaning pcl: farther from them than the mean by so many standard deviations is an "
                        "outlier")
            ->capture_default_str(),
        command
            .add_option("--pcl-tolerance-mm", pcl.tolerance_mm,
                        "Of --cleaning pcl: points farther apart belong to different parts")
            ->capture_default_str()};
    command.add_option("--min-part", steps.cleaning.min_part, "Smaller parts are stray, share of the largest")
        ->capture_default_str();
}

int run(Arguments& arguments) {
    refuse_workspace(arguments.database);
    take_cleaning(arguments);
    check_size("--rows", arguments.options.steps.gridding.rows);
    check_size("--cols", arguments.options.steps.gridding.cols);
    arguments.options.steps.crop.crop = !arguments.keep_all;
    arguments.options.expressions = parsed_expressions(arguments.expressions);
    const auto database = database::open_database(arguments.database, io::parse_length_unit(arguments.unit));
    if (!arguments.dry_run) database::remember_database(database.root);
    check_by_option({{"spike_mm", "--spike-mm"},
                     {"max_jump_mm", "--max-jump-mm"},
                     {"neighbours", "--pcl-neighbours"},
                     {"deviations", "--pcl-deviations"},
                     {"tolerance_mm", "--pcl-tolerance-mm"},
                     {"cleaning", "--cleaning"},
                     {"max_edge_mm", "--max-edge-mm"},
                     {"min_part", "--min-part"},
                     {"trim", "--trim"},
                     {"mean_mm", "--landmark-error"},
                     {"accept", "--accept"}},
                    [&] { arguments.options.check(); });
    preprocessing::check_workspace_place(database, arguments.output);
    const auto scans = preprocessing::scans_to_preprocess(database, arguments.output, arguments.options);
    const auto catalogue =
        arguments.catalogue_file.empty() ? facs::builtin_catalogue() : facs::read_catalogue(arguments.catalogue_file);
    check_output_folder(arguments.output, arguments.dry_run);
    if (arguments.dry_run) return say_plan(arguments, database, catalogue, scans);
    const base::FolderLock lock(arguments.output, base::FolderLock::Use::write);  // sheets included
    preprocessing::PreprocessReport report;
    {
        Progress progress(arguments.common, "preprocess", scans.size());
        report = preprocessing::preprocess_database(
            database, arguments.output, catalogue, arguments.options,
            [&](const std::string& scan) { progress.advance(scan); }, &lock);
    }
    report::QualitySheetReport sheets;
    if (arguments.sheets) sheets = draw_sheets(arguments);
    if (arguments.common.json) {
        auto failures = nlohmann::json::array();
        for (const auto& failure : report.failures)
            failures.push_back({{"scan", failure.scan}, {"reason", failure.reason}});
        auto remarks = nlohmann::json::array();
        for (const auto& remark : database.remarks) remarks.push_back({{"remark", remark}});
        for (auto& remark : listed(report.remarks)) remarks.push_back(std::move(remark));
        nlohmann::json document = {{"schema", 1},
                                   {"remarks", remarks},
                                   {"closed_lips", report.closed_lips},
                                   {"preprocessed", report.preprocessed},
                                   {"up_to_date", report.up_to_date},
                                   {"failures", failures},
                                   {"subjects_left_out", report.left_out},
                                   {"from_earlier_runs", report.from_earlier_runs},
                                   {"workspace", arguments.output}};
        if (arguments.sheets)
            document["sheets"] = {
                {"drawn", sheets.drawn}, {"up_to_date", sheets.up_to_date}, {"failures", sheets.failures}};
        std::cout << io::json_text(document);
    } else {
        if (!arguments.common.quiet) print_remarks(report, database.remarks);
        if (report.from_earlier_runs > 0 && !arguments.common.quiet)
            std::cerr << fmt::format(
                "note: {} kept up to date\n",
                base::counted(report.from_earlier_runs, "scan of earlier runs stays in the workspace and is",
                              "scans of earlier runs stay in the workspace and are"));
        for (const auto& failure : report.failures)
            std::cerr << one_line(fmt::format("{}: {}", failure.scan, failure.reason)) << '\n';
        print_way_out(report);
        for (const auto& subject : report.left_out)
            std::cerr << one_line(subject) << ": no usable neutral face, so the subject was left out\n";
        std::cout << fmt::format("{} preprocessed, {} already up to date, {} failed; workspace {}\n",
                                 base::counted(report.preprocessed, "face"), report.up_to_date, report.failures.size(),
                                 arguments.output);
        say_failures(sheets.failures);
        if (arguments.sheets)
            std::cout << fmt::format("{} drawn, {} already up to date; {}\n",
                                     base::counted(sheets.drawn, "quality sheet"), sheets.up_to_date,
                                     (std::filesystem::path(arguments.output) / "sheets").string());
    }
    return report.failures.empty() && report.left_out.empty() && sheets.failures.empty() ? exit_done
                                                                                         : exit_done_with_failures;
}

}  // namespace

void add_preprocess_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand("preprocess", "Clean, resample and normalise the scans of a database");
    auto arguments = std::make_shared<Arguments>();
    auto& options = arguments->options;
    command->add_option("DB", arguments->database, "Folder in Bosphorus layout, or with a manifest.csv")->required();
    add_output_folder(*command, arguments->output, "Workspace folder; a second run goes on where the first ended")
        ->required();
    command->add_option("--subject", options.subjects, "Only these subjects (bs003,bs007)")->delimiter(',');
    command
        ->add_option("--expression,--au", arguments->expressions,
                     "Only these expressions beside the neutrals (1,12,12L,HAPPY)")
        ->delimiter(',');
    command
        ->add_option("--unit", arguments->unit, "Unit of the scans of which manifest.csv says none: mm, cm, m or inch")
        ->capture_default_str();
    command
        ->add_option("--accept", options.accept,
                     "Take scans that these errors of 'scans --check' refuse: unit, frame, sides, landmarks-off-scan")
        ->delimiter(',');
    command
        ->add_option("--landmark-error", options.steps.landmark_error.mean_mm,
                     "Move every landmark by a drawn error, mm in the mean: how much results depend on marking")
        ->capture_default_str();
    command->add_option("--landmark-seed", options.steps.landmark_error.seed, "Of --landmark-error")
        ->capture_default_str();
    command->add_option("--rows", options.steps.gridding.rows, "Rows of the grid")->capture_default_str();
    command->add_option("--cols", options.steps.gridding.cols, "Columns of the grid")->capture_default_str();
    command->add_option(
        "--max-edge-mm", options.steps.gridding.max_edge_mm,
        "Longer triangle edges bridge a hole (default: 3 spacings; of a mesh all that no face covers is bridged)");
    add_cleaning_options(*command, *arguments);
    command->add_flag("--keep-all", arguments->keep_all,
                      "Keep neck, ears, hair and shoulders: without it a scan is cropped to the face by its landmarks");
    command->add_option("--trim", options.alignment.trim, "Share of the points that the alignment uses")
        ->capture_default_str();
    command->add_option("--catalogue", arguments->catalogue_file,
                        "Another FACS catalogue (TOML): what each AU leaves alone is what scans are aligned by");
    command->add_flag("--sheets", arguments->sheets, "Draw a quality sheet per subject: OUTPUT/sheets/bs003.png");
    command->add_flag("--dry-run", arguments->dry_run,
                      "Say what is up to date, what remains, its time and disk; do nothing");
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
