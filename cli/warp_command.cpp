#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/output_folder.h"
#include "base/text.h"
#include "base/version.h"
#include "cli/command.h"
#include "cli/error_report.h"
#include "cli/method_options.h"
#include "cli/notes.h"
#include "database/hidden_subjects.h"
#include "io/json_values.h"
#include "io/warp_file.h"

namespace mimik::cli {
namespace {

struct WarpArguments {
    Common common;
    std::filesystem::path from, to, input, output;
    std::string kernel = "r", pair_by = "name", frame;
    geometry::ThinPlateSplineOptions options;
};

int run_warp(const WarpArguments& arguments) {
    for (const auto& file : {arguments.input, arguments.from, arguments.to}) database::refuse_hidden_file(file);
    refuse_range_scan(arguments.input);
    auto options = arguments.options;
    options.kernel = kernel_by_name(arguments.kernel);
    check_by_option({{"smoothing", "--smoothing"}}, [&] { options.check(); });
    io::WarpFileOptions more;
    more.pair_by = arguments.pair_by == "order" ? io::PairBy::order : io::PairBy::name;
    if (!arguments.frame.empty()) more.input_frame = io::parse_body_frame(arguments.frame);
    more.made_by = {{"made_by", fmt::format("Mimik {} warp", base::version())},
                    {"source", arguments.input.filename().string()},
                    {"from_landmarks", arguments.from.filename().string()},
                    {"to_landmarks", arguments.to.filename().string()},
                    {"kernel", arguments.kernel},
                    {"smoothing", fmt::format("{}", arguments.options.smoothing)}};
    const std::array files = {arguments.input, arguments.from, arguments.to};
    for (auto& said : database::said_in_files(database::origin_to_carry(files)))
        more.made_by.push_back(std::move(said));
    const auto output = base::where_links_lead(arguments.output);
    const auto report = naming_any({arguments.from, arguments.to, arguments.input, arguments.output}, [&] {
        return io::warp_file(
            arguments.from, arguments.to, arguments.input, output, options,
            [](const std::filesystem::path& image) { database::refuse_hidden_file(image); }, more);
    });
    if (arguments.common.json) {
        std::cout << io::json_text(nlohmann::json{{"schema", 1},
                                                  {"output", arguments.output.string()},
                                                  {"landmarks", report.landmarks},
                                                  {"points", report.points},
                                                  {"largest_landmark_residual", report.largest_landmark_residual},
                                                  {"largest_displacement", report.largest_displacement},
                                                  {"bending_energy", report.bending_energy},
                                                  {"remarks", report.remarks}});
    } else if (!arguments.common.quiet) {
        say_notes(report.remarks);
        std::cout << fmt::format("{}: {} moved by up to {:.3f} through {} (met within {:.2g})\n",
                                 arguments.output.string(), base::counted(report.points, "point"),
                                 report.largest_displacement, base::counted(report.landmarks, "landmark"),
                                 report.largest_landmark_residual);
    }
    return exit_done;
}

}  // namespace

void add_warp_command(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<WarpArguments>();
    auto* command = app.add_subcommand("warp", "Warp a mesh or points by landmarks (thin-plate spline)");
    command
        ->add_option("--from", arguments->from,
                     "Landmarks on the input: .csv .tsv .pp .fcsv .mrk.json .lm3 .ljson .lan (docs/formats.md)")
        ->required();
    command->add_option("--to", arguments->to, "Where they go: the same names")->required();
    command->add_option("--pair-by", arguments->pair_by, "name; or order, where the names of two lists differ")
        ->check(CLI::IsMember({"name", "order"}))
        ->capture_default_str();
    command
        ->add_option("--frame", arguments->frame,
                     "LPS or RAS: frame of an INPUT that does not say it, for landmarks that do (Slicer)")
        ->check(CLI::IsMember({"LPS", "RAS"}, CLI::ignore_case));
    command->add_option("--kernel", arguments->kernel, "r, or r2logr (r^2 ln r^2)")
        ->check(CLI::IsMember({"r", "r2logr"}))
        ->capture_default_str();
    command
        ->add_option("--smoothing", arguments->options.smoothing,
                     "X in (K + X I) W + P A = V; 0 passes through every landmark; unit of K")
        ->capture_default_str();
    command->add_option("INPUT", arguments->input, "Points (.csv) or mesh (.ply .obj .stl .vtp .pcd)")->required();
    command->add_option("-o,--output", arguments->output, "File to write (.csv .ply .obj .stl .vtp)")->required();
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run_warp(*arguments); });
}

}  // namespace mimik::cli
