#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "capture/motion_file.h"
#include "cli/command.h"
#include "cli/mocap_commands.h"
#include "cli/notes.h"
#include "database/hidden_subjects.h"
#include "io/json_values.h"

namespace mimik::cli {

void Recording::add_options(CLI::App& command) {
    command.add_option("TAKE", file, "Recording of markers: .c3d .trc .csv (docs/formats.md)")->required();
    command.add_option("--unit", unit, "Of the coordinates, whatever the file says: mm, cm, m or inch");
    command.add_option("--rate", rate_hz, "Frames a second, whatever the file says");
}

capture::MotionFile Recording::read() const {
    database::refuse_hidden_file(file);
    capture::MotionReadOptions options;
    if (!unit.empty()) options.unit = io::parse_length_unit(unit);
    options.rate_hz = rate_hz;
    check_by_option({{"rate_hz", "--rate"}}, [&] { options.check(); });
    return capture::read_motion(file, options);
}

void refuse_as_output(const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs) {
    for (const auto& input : inputs) {
        std::error_code none;
        if (!input.empty() && std::filesystem::equivalent(input, output, none))
            throw InputError(
                fmt::format("{}: is read by this very call; give the output another name", output.string()));
    }
}

namespace {

/// Gaps in words: their number, and the marker that is missing most.
std::string gaps_in_words(const capture::MarkerSequence& markers, const std::vector<capture::MarkerGap>& gaps) {
    if (gaps.empty()) return "no sample is missing";
    std::size_t missing = 0, most = 0, of = 0;
    for (std::size_t k = 0; k < markers.markers(); ++k) {
        const auto lacks = markers.frames() - markers.valid_count(k);
        missing += lacks;
        if (lacks > most) {
            most = lacks;
            of = k;
        }
    }
    return fmt::format("{} missing in {}, most of '{}' ({} of {} frames)",
                       base::counted(missing, "sample is", "samples are"), base::counted(gaps.size(), "gap"),
                       markers.names()[of], most, markers.frames());
}

nlohmann::json described(const capture::MotionFile& file) {
    const auto& markers = file.markers;
    auto valid = nlohmann::json::array(), list = nlohmann::json::array();
    for (std::size_t k = 0; k < markers.markers(); ++k) valid.push_back(markers.valid_count(k));
    for (const auto& gap : capture::gaps(markers))
        list.push_back({{"marker", markers.names()[gap.marker]},
                        {"first", markers.first_frame() + static_cast<std::int64_t>(gap.first)},
                        {"last", markers.first_frame() + static_cast<std::int64_t>(gap.last)}});
    return {{"schema", 1},
            {"format", file.format},
            {"points", markers.markers()},
            {"frames", markers.frames()},
            {"first_frame", markers.first_frame()},
            {"rate_hz", markers.rate_hz()},
            {"unit", file.unit},
            {"labels", std::vector<std::string>(markers.names().begin(), markers.names().end())},
            {"valid", std::move(valid)},
            {"gaps", std::move(list)},
            {"remarks", file.remarks}};
}

struct InfoArguments {
    Common common;
    Recording recording;
};

int run_info(const InfoArguments& arguments) {
    const auto file = arguments.recording.read();
    if (arguments.common.json) {
        std::cout << io::json_text(described(file));
        return exit_done;
    }
    const auto& markers = file.markers;
    if (!arguments.common.quiet) say_notes(file.remarks);
    std::cout << fmt::format("{}: {}; {}, {} from {} on, {} Hz ({:.2f} s), in {}\n", arguments.recording.file.string(),
                             file.format, base::counted(markers.markers(), "marker"),
                             base::counted(markers.frames(), "frame"), markers.first_frame(), markers.rate_hz(),
                             static_cast<double>(markers.frames()) / markers.rate_hz(), file.unit);
    for (std::size_t k = 0; k < markers.markers(); ++k)
        std::cout << fmt::format("  {:<24} {:>8} of {}\n", markers.names()[k], markers.valid_count(k),
                                 markers.frames());
    std::cout << gaps_in_words(markers, capture::gaps(markers)) << '\n';
    return exit_done;
}

struct ConvertArguments {
    Common common;
    Recording recording;
    std::filesystem::path output;
    std::string frames;
    std::vector<std::string> markers;
};

capture::MarkerSequence frames_named(const capture::MarkerSequence& markers, const std::string& text) {
    const auto colon = text.find(':');
    const auto first = base::parse_integer(std::string_view(text).substr(0, colon));
    const auto last =
        colon == std::string::npos ? first : base::parse_integer(std::string_view(text).substr(colon + 1));
    if (!first || !last)
        throw InputError(
            fmt::format("--frames is {}; give the first and the last, such as 1:120", base::in_quotes(text)));
    try {
        return capture::frames_between(markers, *first, *last);
    } catch (const InputError& e) {
        throw InputError(fmt::format("--frames: {}", e.what()));
    }
}

int run_convert(const ConvertArguments& arguments) {
    (void)capture::motion_format(arguments.output);  // before the work
    refuse_as_output(arguments.output, {arguments.recording.file});
    auto file = arguments.recording.read();
    auto markers = std::move(file.markers);
    if (!arguments.frames.empty()) markers = frames_named(markers, arguments.frames);
    if (!arguments.markers.empty()) {
        refuse_doubles("--markers", arguments.markers);
        try {
            markers = capture::with_markers(markers, arguments.markers);
        } catch (const InputError& e) {
            throw InputError(fmt::format("--markers: {}", e.what()));
        }
    }
    capture::write_motion(arguments.output, markers);
    if (arguments.common.json) {
        std::cout << io::json_text(nlohmann::json{{"schema", 1},
                                                  {"output", arguments.output.string()},
                                                  {"points", markers.markers()},
                                                  {"frames", markers.frames()},
                                                  {"rate_hz", markers.rate_hz()},
                                                  {"remarks", file.remarks}});
        return exit_done;
    }
    if (!arguments.common.quiet) say_notes(file.remarks);
    std::cout << fmt::format("{}: {}, {}, {} Hz, in mm\n", arguments.output.string(),
                             base::counted(markers.markers(), "marker"), base::counted(markers.frames(), "frame"),
                             markers.rate_hz());
    return exit_done;
}

void add_info(CLI::App& group, int& exit_code) {
    auto* command = group.add_subcommand("info", "Say what a recording holds: markers, frames, rate, gaps");
    auto arguments = std::make_shared<InfoArguments>();
    arguments->recording.add_options(*command);
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run_info(*arguments); });
}

void add_convert(CLI::App& group, int& exit_code) {
    auto* command = group.add_subcommand("convert", "Write a recording, or a part of it, in another format, in mm");
    auto arguments = std::make_shared<ConvertArguments>();
    arguments->recording.add_options(*command);
    command->add_option("OUT", arguments->output, "File to write (.c3d .trc .csv)")->required();
    command->add_option("--frames", arguments->frames, "First and last frame, as the file numbers them: 1:120");
    command->add_option("--markers", arguments->markers, "Only these, in this order: LBRO,RBRO")->delimiter(',');
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run_convert(*arguments); });
}

}  // namespace

void add_mocap_command(CLI::App& app, int& exit_code) {
    auto* group = app.add_subcommand("mocap", "Recordings of markers: what is in them, other formats, other faces");
    group->require_subcommand(1);
    group->footer("All of them take --json, --quiet and --threads; 'mimik mocap COMMAND --help' says what else.");
    add_info(*group, exit_code);
    add_convert(*group, exit_code);
    add_mocap_clean(*group, exit_code);
    add_mocap_retarget(*group, exit_code);
    add_mocap_fit(*group, exit_code);
    add_mocap_animate(*group, exit_code);
    add_mocap_synthesize(*group, exit_code);
    add_mocap_markers(*group, exit_code);
}

}  // namespace mimik::cli
