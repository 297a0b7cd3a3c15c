#include <csignal>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/terminal.h"
#include "io/json_values.h"
#include "synthesis/synthesize.h"

namespace mimik::cli {
namespace {

struct SynthesizeArguments {
    Common common;
    std::string out, face_model;
    bool dry_run = false, no_facs_codes = false;
    OptionOfField option_of_field;
    synthesis::SynthesizeOptions options;
};

volatile std::sig_atomic_t stop_signal = 0;

/// Stops at the next scan that is done, so that what was begun is cleaned up; a second signal ends the program as ever.
void stop_at_signals() {
    struct sigaction action {};
    action.sa_handler = [](int signal) { stop_signal = signal; };
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
}
struct Stopped : std::exception {};

int run_synthesize(const SynthesizeArguments& arguments) {
    auto options = arguments.options;
    options.facs_codes = !arguments.no_facs_codes;
    check_by_option(arguments.option_of_field, [&] { options.check(); });
    synthesis::check_database_place(arguments.out);
    const auto model = arguments.face_model.empty() ? synthesis::make_builtin_face_model()
                                                    : synthesis::load_ict_face_model(arguments.face_model);
    const auto estimate = synthesis::estimate_database(*model, options);
    synthesis::check_database_place(arguments.out, estimate.bytes);
    std::error_code ignored;
    if (arguments.dry_run && !std::filesystem::is_symlink(arguments.out, ignored))  // a link's goal may be made
        check_output_folder(arguments.out, arguments.dry_run);
    if (arguments.dry_run) {
        const double seconds = estimate.core_seconds / working_threads();
        const double megabytes = static_cast<double>(estimate.bytes) / 1e6;
        if (arguments.common.json)
            std::cout << io::json_text(nlohmann::json{{"schema", 1},
                                                      {"dry_run", true},
                                                      {"scans", estimate.scans},
                                                      {"bytes", estimate.bytes},
                                                      {"megabytes", megabytes},
                                                      {"seconds", seconds},
                                                      {"skipped_expressions", estimate.skipped_expressions}});
        else
            std::cout << fmt::format("{}, about {:.0f} MB and {:.0f} s\n", base::counted(estimate.scans, "scan"),
                                     megabytes, seconds);
        return exit_done;
    }
    Progress progress(arguments.common, "synthesize", estimate.scans);
    options.on_scan_done = [&](const std::string& scan) {
        if (stop_signal != 0) throw Stopped();
        progress.advance(scan);
    };
    stop_at_signals();
    synthesis::SynthesizeReport report;
    try {
        report = synthesis::synthesize_database(arguments.out, *model, options);
    } catch (const Stopped&) {
        say_error("mimik", fmt::format("stopped; nothing was left at {}", arguments.out));
        return 128 + stop_signal;  // as shells count
    }
    if (arguments.common.json) {
        std::cout << io::json_text(nlohmann::json{{"schema", 1},
                                                  {"database", arguments.out},
                                                  {"face_model", model->name()},
                                                  {"subjects", report.subjects},
                                                  {"scans", report.scans},
                                                  {"valid_points", report.valid_points},
                                                  {"lost_grazing", report.lost_grazing},
                                                  {"lost_holes", report.lost_holes},
                                                  {"landmarks_marked", report.landmarks_marked},
                                                  {"landmarks_invisible", report.landmarks_invisible},
                                                  {"bytes", report.bytes},
                                                  {"skipped_expressions", report.skipped_expressions}});
        return exit_done;
    }
    for (const auto& expression : report.skipped_expressions)
        if (!arguments.common.quiet) std::cerr << "left out: " << expression << '\n';
    if (!arguments.common.quiet)
        std::cout << fmt::format("{}: {} of {} ({}), {} points each on average, {:.0f} MB\n", arguments.out,
                                 base::counted(report.scans, "scan"), base::counted(report.subjects, "subject"),
                                 model->name(), report.valid_points / report.scans,
                                 static_cast<double>(report.bytes) / 1e6);
    return exit_done;
}

/// Adds options of one group, and remembers which field each of them sets.
auto adder(CLI::App& command, OptionOfField& option_of_field, const char* group) {
    return [&command, &option_of_field, group](const char* name, const char* field, auto& value, const char* help) {
        option_of_field[field] = name;
        command.add_option(name, value, help)->capture_default_str()->group(group);
    };
}

void add_variances(CLI::App& command, synthesis::VarianceOptions& v, OptionOfField& option_of_field) {
    const auto add = adder(command, option_of_field, "Variances");
    add("--identity", "identity", v.identity, "Spread of identity in standard deviations of the population");
    add("--amplitude-person", "amplitude_person", v.amplitude_person,
        "Log-normal factor on all expressions of a person");
    add("--amplitude-performance", "amplitude_performance", v.amplitude_performance, "Log-normal factor per scan");
    add("--shape", "shape", v.shape, "Log-normal factor per main shape and scan");
    add("--asymmetry-person", "asymmetry_person", v.asymmetry_person,
        "Left x (1 + a), right x (1 - a): a person's share of a");
    add("--asymmetry-performance", "asymmetry_performance", v.asymmetry_performance, "A scan's share of a");
    add("--co-activation", "co_activation", v.co_activation, "Scales the mean weight of co-activated shapes");
    add("--co-activation-spread", "co_activation_spread", v.co_activation_spread, "Scales their standard deviation");
    add("--size-coupling", "size_coupling", v.size_coupling, "Share of a face's size that its motion follows");
    add("--field-length", "field_length_mm", v.field_length_mm,
        "Correlation length of the smooth random change of motion, mm");
    add("--field-magnitude", "field_magnitude", v.field_magnitude, "Its standard deviation in magnitude");
    add("--field-direction", "field_direction_deg", v.field_direction_deg, "Its turn of the direction, degrees rms");
    add("--micro-expression", "micro_expression", v.micro_expression,
        "Standard deviation of the weight of every shape, in every scan");
}

void add_scanner(CLI::App& command, synthesis::ScannerOptions& s, OptionOfField& option_of_field) {
    const auto add = adder(command, option_of_field, "Scanner");
    add("--spacing", "spacing_mm", s.spacing_mm, "Of the lattice in x and y, mm");
    add("--noise-z", "noise_z_mm", s.noise_z_mm, "Standard deviation of depth, mm");
    add("--smooth-noise-z", "smooth_noise_z_mm", s.smooth_noise_z_mm,
        "Standard deviation of a smooth error of depth, mm");
    add("--smooth-noise-length", "smooth_noise_length_mm", s.smooth_noise_length_mm, "Its correlation length, mm");
    add("--noise-xy", "noise_xy_mm", s.noise_xy_mm, "Standard deviation of x and y, mm");
    add("--min-normal-z", "min_normal_z", s.min_normal_z, "Surfaces that turn away further are lost");
    add("--pitch", "pitch_deg", s.pitch_deg, "Standard deviation of the nod, degrees");
    add("--yaw", "yaw_deg", s.yaw_deg, "Standard deviation of the turn, degrees");
    add("--roll", "roll_deg", s.roll_deg, "Standard deviation of the tilt, degrees");
    add("--translation", "translation_mm", s.translation_mm, "Standard deviation of where the head is, mm");
    add("--eye-holes", "eye_hole_share", s.eye_hole_share, "Share of the lids that is lost");
    add("--nostril-holes", "nostril_hole_share", s.nostril_hole_share, "Share of the nostrils that is lost");
    add("--brow-holes", "brow_hole_share", s.brow_hole_share, "Share of the brows that is lost");
    add("--spikes", "spikes", s.spikes, "Outliers per scan");
    add("--stray-parts", "stray_parts", s.stray_parts, "Patches of cloth or hair per scan");
    add("--jitter", "marking_jitter", s.marking_jitter, "Scales the error of marking (0.5 to 1 mm rms)");
    add("--texture-density", "texture_pixels_per_mm", s.texture_pixels_per_mm, "Pixels per mm of the photograph");
}

}  // namespace

void add_synthesize_command(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<SynthesizeArguments>();
    auto* command = app.add_subcommand("synthesize", "Make a database of synthetic scans with a known truth");
    auto& options = arguments->options;
    command->add_option("OUT", arguments->out, "New folder for the database")->required();
    command->add_option("--face-model", arguments->face_model,
                        "Folder of ICT-FaceKit (its FaceXModel or the parent); without it the built-in model");
    command->add_option("--subjects", options.subjects, "How many people")->capture_default_str();
    command
        ->add_option("--expressions", options.expressions,
                     "thesis, emotions, further, all, or codes such as 12,AU12_L,HAPPY; commas between")
        ->capture_default_str();
    command->add_option("--emotions", options.emotions, "What emotions are made of: emfacs, thesis (its Table 3-3)")
        ->capture_default_str();
    command->add_option("--neutrals", options.neutrals, "Neutral scans per person")->capture_default_str();
    command->add_flag("--repeat", options.repeat, "A second scan _1 of each expression");
    add_seed_option(*command, options.seed);
    for (const char* field : {"subjects", "expressions", "emotions", "neutrals"})
        arguments->option_of_field[field] = fmt::format("--{}", field);
    command->add_flag("--no-facs-codes", arguments->no_facs_codes, "Do not write facscodes.lst");
    command->add_flag("--dry-run", arguments->dry_run, "Say how much time and disk it takes, and stop");
    add_variances(*command, options.variances, arguments->option_of_field);
    add_scanner(*command, options.scanner, arguments->option_of_field);
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run_synthesize(*arguments); });
}

}  // namespace mimik::cli
