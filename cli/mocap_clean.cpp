#include <algorithm>
#include <iostream>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "capture/fill_gaps.h"
#include "capture/marker_set.h"
#include "capture/stabilise.h"
#include "cli/mocap_commands.h"
#include "cli/notes.h"
#include "cli/terminal.h"
#include "database/hidden_subjects.h"
#include "geometry/statistics.h"
#include "io/json_values.h"
#include "io/landmark_io.h"

namespace mimik::cli {
namespace {

struct CleanArguments {
    Common common;
    Recording recording;
    std::filesystem::path output, set, rest;
    capture::StabiliseOptions stabilise;
    capture::FillOptions fill;
    bool keep_jig = false;
};

/// The markers but for those of the jig: at rest they say nothing more.
capture::MarkerSequence without(const capture::MarkerSequence& markers, const std::vector<std::string>& jig) {
    std::vector<std::string> kept;
    for (const auto& name : markers.names())
        if (std::find(jig.begin(), jig.end(), name) == jig.end()) kept.push_back(name);
    if (kept.empty()) throw InputError("--jig: names every marker; there is no face left, name those of the jig alone");
    return capture::with_markers(markers, kept);
}

struct Residuals {
    std::optional<double> median_mm, largest_mm;
    std::size_t frames_without = 0;
};
Residuals residuals_of(const capture::Stabilised& stabilised) {
    std::vector<double> known;
    for (const auto& one : stabilised.residual_mm)
        if (one) known.push_back(*one);
    Residuals residuals;
    residuals.frames_without = stabilised.residual_mm.size() - known.size();
    if (known.empty()) return residuals;
    residuals.largest_mm = *std::max_element(known.begin(), known.end());
    residuals.median_mm = geometry::median(std::move(known));
    return residuals;
}

void print(const CleanArguments& arguments, const capture::MarkerSequence& markers,
           const capture::Stabilised& stabilised, const capture::Filled& filled,
           const std::vector<std::string>& derived, const std::vector<std::string>& remarks) {
    const auto residuals = residuals_of(stabilised);
    const auto in_all = [](const std::vector<std::size_t>& counts) {
        return std::accumulate(counts.begin(), counts.end(), std::size_t{0});
    };
    if (arguments.common.json) {
        auto by_marker = nlohmann::json::array();
        for (std::size_t k = 0; k < filled.filled.size(); ++k)
            if (filled.filled[k] + filled.left[k] > 0)
                by_marker.push_back(
                    {{"marker", filled.markers.names()[k]}, {"filled", filled.filled[k]}, {"missing", filled.left[k]}});
        const auto optional = [](const std::optional<double>& value) {
            return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
        };
        std::cout << io::json_text(nlohmann::json{
            {"schema", 1},
            {"output", arguments.output.string()},
            {"points", markers.markers()},
            {"frames", markers.frames()},
            {"rest_frame", markers.first_frame() + static_cast<std::int64_t>(stabilised.rest_frame)},
            {"residual_mm", {{"median", optional(residuals.median_mm)}, {"largest", optional(residuals.largest_mm)}}},
            {"frames_without_pose", residuals.frames_without},
            {"gaps", std::move(by_marker)},
            {"derived", derived},
            {"remarks", remarks}});
        return;
    }
    if (!arguments.common.quiet) say_notes(remarks);
    std::cout << fmt::format(
        "{}: {}, {}; head motion off by {} (residual {:.3f} mm in the median, {:.3f} at most); {} filled in, {} still "
        "missing; {} derived\n",
        arguments.output.string(), base::counted(markers.markers(), "marker"), base::counted(markers.frames(), "frame"),
        arguments.stabilise.jig.empty() ? "a robust fit" : "the jig", residuals.median_mm.value_or(0),
        residuals.largest_mm.value_or(0), base::counted(in_all(filled.filled), "sample"), in_all(filled.left),
        derived.size());
}

int run_clean(const CleanArguments& arguments) {
    (void)capture::motion_format(arguments.output);  // before the work
    refuse_as_output(arguments.output, {arguments.recording.file});
    const auto file = arguments.recording.read();
    auto remarks = file.remarks;
    const auto add = [&](const std::vector<std::string>& more) {
        remarks.insert(remarks.end(), more.begin(), more.end());
    };
    const auto set = arguments.set.empty() ? capture::builtin_marker_set() : capture::read_marker_set(arguments.set);
    check_by_option({{"jig", "--jig"}, {"by", "--by"}, {"noise_mm", "--noise"}}, [&] { arguments.stabilise.check(); });
    check_by_option({{"longest_gap_s", "--longest-gap"}, {"nearest", "--nearest"}}, [&] { arguments.fill.check(); });
    const auto stabilised = capture::stabilise(file.markers, arguments.stabilise);
    add(stabilised.remarks);
    const auto face = arguments.keep_jig ? stabilised.markers : without(stabilised.markers, arguments.stabilise.jig);
    const auto filled = capture::fill_gaps(face, set, arguments.fill);
    add(filled.remarks);
    auto markers = filled.markers;
    std::vector<std::string> derived;
    if (!arguments.rest.empty()) {
        database::refuse_hidden_file(arguments.rest);
        auto more = capture::derive_markers(markers, io::read_landmarks(arguments.rest), set);
        add(more.remarks);
        markers = std::move(more.markers);
        derived = std::move(more.derived);
    }
    capture::write_motion(arguments.output, markers);
    print(arguments, markers, stabilised, filled, derived, remarks);
    return exit_done;
}

struct MarkersArguments {
    Common common;
    std::filesystem::path lint;
};

int run_markers(const MarkersArguments& arguments) {
    const bool lints = !arguments.lint.empty();
    const auto findings = lints ? capture::lint_marker_set(base::read_text(arguments.lint, std::uintmax_t{4} << 20U))
                                : std::vector<facs::LintFinding>();
    const auto errors = std::count_if(findings.begin(), findings.end(), [](const auto& one) { return one.error; });
    if (arguments.common.json) {
        nlohmann::json document = {{"schema", 1}};
        if (lints) {
            auto list = nlohmann::json::array();
            for (const auto& one : findings)
                list.push_back({{"error", one.error}, {"line", one.line}, {"what", one.what}});
            document["errors"] = errors;
            document["findings"] = std::move(list);
        } else {
            const auto& set = capture::builtin_marker_set();
            auto markers = nlohmann::json::array(), derived = nlohmann::json::array();
            for (const auto& one : set.markers) markers.push_back({{"name", one.name}, {"group", one.group}});
            for (const auto& one : set.derived) derived.push_back(one.name);
            document["markers"] = std::move(markers);
            document["derived"] = std::move(derived);
        }
        std::cout << io::json_text(document);
    } else if (lints) {
        for (const auto& one : findings)
            std::cout << fmt::format("{}:{}: {}: {}\n", arguments.lint.string(), one.line,
                                     one.error ? "error" : "warning", one.what);
        if (findings.empty()) std::cout << fmt::format("{}: no findings\n", arguments.lint.string());
    } else {
        raw_output() << capture::builtin_marker_set_text();
    }
    return errors > 0 ? exit_done_with_failures : exit_done;
}

}  // namespace

void add_mocap_clean(CLI::App& group, int& exit_code) {
    auto* command = group.add_subcommand("clean", "Take the head's motion off, and fill in what is missing");
    auto arguments = std::make_shared<CleanArguments>();
    arguments->recording.add_options(*command);
    command->add_option("-o,--output", arguments->output, "File to write (.c3d .trc .csv)")->required();
    command->add_option("--jig", arguments->stabilise.jig, "Markers that move with the skull; they are left out then")
        ->delimiter(',');
    command
        ->add_option("--by", arguments->stabilise.by,
                     "Without a jig: markers of the robust fit (default: all; those that move lose their say)")
        ->delimiter(',');
    command->add_option("--noise", arguments->stabilise.noise_mm, "Of the recording, mm; the robust fit's finest scale")
        ->capture_default_str();
    command->add_flag("--keep-jig", arguments->keep_jig, "Write the markers of the jig, too");
    command
        ->add_option("--longest-gap", arguments->fill.longest_gap_s,
                     "Leave gaps that are longer, s; 0: none is too long")
        ->capture_default_str();
    command->add_option("--nearest", arguments->fill.nearest, "Markers that carry one which the set does not know")
        ->capture_default_str();
    command->add_option("--set", arguments->set, "Which marker hangs on which (.toml; default: 'mimik mocap markers')");
    command->add_option("--rest", arguments->rest,
                        "Where the markers are in one pose, and points that bear none: adds these (landmark file)");
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run_clean(*arguments); });
}

void add_mocap_markers(CLI::App& group, int& exit_code) {
    auto* command = group.add_subcommand("markers", "Print the built-in marker set, or check one of your own");
    auto arguments = std::make_shared<MarkersArguments>();
    command->add_option("--lint", arguments->lint, "Marker set to be checked (.toml)");
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run_markers(*arguments); });
}

}  // namespace mimik::cli
