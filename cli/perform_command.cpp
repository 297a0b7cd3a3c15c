#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "animation/expression_mapping.h"
#include "animation/facial_examples.h"
#include "animation/shape_performance.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/output_folder.h"
#include "base/text.h"
#include "base/version.h"
#include "capture/landmark_tables.h"
#include "capture/live_link.h"
#include "cli/command.h"
#include "cli/error_report.h"
#include "cli/named_files.h"
#include "cli/notes.h"
#include "cli/performance_commands.h"
#include "cli/performance_output.h"
#include "cli/performer_examples.h"
#include "database/hidden_subjects.h"
#include "io/json_values.h"

namespace mimik::cli {
namespace {

struct Arguments {
    Common common;
    std::filesystem::path motion, examples, output, source_examples, weights;
    std::vector<std::filesystem::path> beside;
    std::filesystem::path clip;
    std::vector<std::string> keys;
    std::string rest;
    std::optional<double> rate_hz;
    std::optional<double> outer_eye_mm;
    bool wires = false;
    std::optional<int> picture_size;
    animation::ExpressionMappingOptions options;
};

/// A table of motion, whichever it is.
struct MotionTable {
    std::optional<capture::FeatureMotion> features;
    std::optional<capture::ShapeMotion> shapes;
    std::string format;
    std::vector<std::string> remarks;
};

/// What a table says itself is not said by an option. @throws InputError
void refuse_unread_options(const Arguments& arguments, const MotionTable& table, capture::MotionTableFormat format) {
    using enum capture::MotionTableFormat;
    if (arguments.rate_hz && format == features)
        throw InputError(fmt::format("--rate is {}: {} says its rate, {:g} a second; leave --rate out",
                                     *arguments.rate_hz, arguments.motion.string(), table.features->rate_hz));
    const auto has_depth = [&] {
        for (const auto& frame : table.features->frames)
            for (const auto& sample : frame.features)
                if (sample.valid && sample.head_mm.z() != 0) return true;
        return false;
    };
    if (arguments.outer_eye_mm && format != points68 && !(format == openface && !has_depth()))
        throw InputError(fmt::format("--outer-eye-mm is {}: it is for tables of pixels, and {} is {}; leave it out",
                                     *arguments.outer_eye_mm, arguments.motion.string(),
                                     format == live_link ? "one of weights" : "in millimetres"));
}

MotionTable read_motion(const Arguments& arguments) {
    const auto text = base::read_text(arguments.motion);
    const auto name = arguments.motion.string();
    capture::LandmarkTableOptions options;
    options.rate_hz = arguments.rate_hz;
    options.outer_eye_mm = arguments.outer_eye_mm.value_or(options.outer_eye_mm);
    check_by_option({{"rate_hz", "--rate"}, {"outer_eye_mm", "--outer-eye-mm"}}, [&] { options.check(); });
    MotionTable table;
    const auto take = [&](capture::LandmarkTable read, const char* format) {
        table.features = std::move(read.motion);
        table.remarks = std::move(read.remarks);
        table.format = format;
    };
    const auto format = capture::motion_table_format(text, name);
    switch (format) {
        case capture::MotionTableFormat::features:
            table.features = capture::decode_feature_motion(text, name);
            table.format = "feature motion";
            break;
        case capture::MotionTableFormat::points68:
            take(capture::decode_points68_csv(text, name, options), "68 points");
            break;
        case capture::MotionTableFormat::openface:
            take(capture::decode_openface_csv(text, name, options), "OpenFace");
            break;
        case capture::MotionTableFormat::live_link:
            table.shapes = capture::decode_live_link_csv(text, name, arguments.rate_hz);
            table.remarks = table.shapes->remarks;
            table.format = "Live Link Face";
            break;
    }
    refuse_unread_options(arguments, table, format);
    return table;
}

std::size_t frame_number(const std::string& typed, std::string_view text, const char* option) {
    const auto number = base::parse_integer(text);
    if (!number || *number < 0)
        throw InputError(fmt::format("{} {}: {} is no frame; give whole numbers from 0 on", option,
                                     base::in_quotes(typed), base::in_quotes(text)));
    return static_cast<std::size_t>(*number);
}

/// --neutral A:B, B among them; without it the first half second.
animation::PerformerRest rest_of(const Arguments& arguments, const capture::FeatureMotion& motion) {
    if (motion.frames.empty()) throw InputError(fmt::format("{}: there is no frame", arguments.motion.string()));
    if (!arguments.rest.empty()) {
        const auto colon = arguments.rest.find(':');
        const auto first = frame_number(arguments.rest, std::string_view(arguments.rest).substr(0, colon), "--neutral");
        const auto last =
            colon == std::string::npos
                ? first
                : frame_number(arguments.rest, std::string_view(arguments.rest).substr(colon + 1), "--neutral");
        return animation::performer_rest(motion, first, last);
    }
    // Half a second of frames in which the face is seen, from the first of them on.
    std::size_t first = 0;
    while (first + 1 < motion.frames.size() && motion.frames[first].state == capture::TrackState::lost) ++first;
    const auto count = static_cast<std::size_t>(std::max(1.0, std::round(0.5 * motion.rate_hz)));
    return animation::performer_rest(motion, first, std::min(first + count, motion.frames.size()) - 1);
}

std::vector<animation::KeyFrame> key_frames(const std::vector<std::string>& typed) {
    std::vector<animation::KeyFrame> keys;
    for (const auto& text : typed) {
        const auto sign = text.find('=');
        if (sign == std::string::npos || sign == 0)
            throw InputError(fmt::format("--key {}: give EXAMPLE=FRAME, such as smile=120", base::in_quotes(text)));
        keys.push_back({text.substr(0, sign), frame_number(text, std::string_view(text).substr(sign + 1), "--key")});
    }
    return keys;
}

/// What the performer does in the examples that the character has.
modeling::SourceExamples source_of(const Arguments& arguments, const capture::FeatureMotion& motion,
                                   const animation::PerformerRest& rest, const animation::FacialExamples& character,
                                   const std::filesystem::path& folder, std::vector<std::string>& remarks) {
    modeling::SourceExamples source;
    if (!arguments.keys.empty()) {
        source = animation::performer_examples(motion, rest, key_frames(arguments.keys));
    } else {
        double factor = 1;
        const auto table = arguments.source_examples.empty()
                               ? modeling::standard_source_examples()
                               : modeling::read_source_examples(arguments.source_examples);
        source = animation::fitted_examples(table, motion, rest, &factor);
        remarks.push_back(fmt::format("the performer's face is {:.2f} times as wide at the eyes as that of {}", factor,
                                      arguments.source_examples.empty() ? std::string("the built-in examples")
                                                                        : arguments.source_examples.string()));
    }
    return examples_of_character(source, character, folder, remarks);
}

struct Outcome {
    animation::MappedPerformance mapped;
    std::vector<std::string> remarks;
    nlohmann::json details = nlohmann::json::object();
};

Outcome map_features(const Arguments& arguments, const capture::FeatureMotion& motion,
                     const animation::FacialExamples& character, const std::filesystem::path& folder) {
    Outcome outcome;
    const auto rest = naming(arguments.motion, [&] { return rest_of(arguments, motion); });
    const animation::ExpressionMapping mapping(source_of(arguments, motion, rest, character, folder, outcome.remarks),
                                               arguments.options);
    outcome.mapped = animation::map_performance(motion, rest, mapping);
    const auto& parameters = mapping.parameters();
    outcome.details = {{"features", mapping.source().features.size()},
                       {"coordinates", 3 * mapping.source().features.size()},
                       {"dimensions", parameters.dimensions()},
                       {"kept_variance", parameters.kept_share},
                       {"loss_rms_mm", parameters.loss_rms_mm},
                       {"largest_loss_rms_mm", parameters.largest_loss_rms_mm},
                       {"linear_residual", mapping.basis().largest_residual()},
                       {"unexplained_mm", outcome.mapped.median_unexplained_mm}};
    outcome.remarks.push_back(
        fmt::format("{} coordinates of features became {} parameters, which keep {:.3f} % of the variance; examples "
                    "lose {:.3f} mm rms",
                    3 * mapping.source().features.size(), parameters.dimensions(), 100 * parameters.kept_share,
                    parameters.loss_rms_mm));
    return outcome;
}

void say_overshoot(const Arguments& arguments, Outcome& outcome) {
    const auto& mapped = outcome.mapped;
    if (mapped.overshoots + mapped.negatives == 0) return;
    outcome.remarks.push_back(fmt::format(
        "weights go from {:.2f} to {:.2f}: above 1 in {}, below 0 in {} of {} frames{}", mapped.least_weight,
        mapped.largest_weight, mapped.overshoots, mapped.negatives, mapped.times_s.size(),
        arguments.options.clamp ? ", clamped" : "; --clamp keeps them between 0 and 1"));
}

void report(const Arguments& arguments, const MotionTable& table, Outcome& outcome) {
    const auto& mapped = outcome.mapped;
    if (arguments.common.json) {
        outcome.details.update({{"schema", 1},
                                {"output", arguments.output.string()},
                                {"format", table.format},
                                {"frames", mapped.times_s.size()},
                                {"lost", mapped.lost},
                                {"rate_hz", mapped.rate_hz},
                                {"examples", mapped.examples},
                                {"least_weight", mapped.least_weight},
                                {"largest_weight", mapped.largest_weight},
                                {"overshoots", mapped.overshoots},
                                {"negatives", mapped.negatives},
                                {"remarks", outcome.remarks}});
        std::cout << io::json_text(outcome.details);
        return;
    }
    if (!arguments.common.quiet) say_notes(outcome.remarks);
    std::cout << fmt::format("{}: {} at {:g} a second, {} lost, by {}\n", arguments.output.string(),
                             base::counted(mapped.times_s.size(), "frame"), mapped.rate_hz, mapped.lost,
                             base::counted(mapped.examples.size(), "example"));
}

/// Everything that is read, then everything that is written. @throws InputError if one is the other
void check_files(const Arguments& arguments) {
    std::vector<NamedFile> files = {{"MOTION", arguments.motion.string()},
                                    {"--source-examples", arguments.source_examples.string()},
                                    {"--video", arguments.clip.string()}};
    auto folders = arguments.beside;
    folders.push_back(arguments.examples);
    for (const auto& folder : folders) {
        const auto list_file = folder / animation::example_list_name;
        if (!base::is_there(list_file)) continue;  // said when it is read
        const auto list = animation::decode_example_list(base::read_text(list_file), list_file.string());
        const auto add = [&](const std::string& name) {
            if (!name.empty()) files.push_back({"a file of " + folder.string(), (folder / name).string()});
        };
        for (const auto& name : {list.neutral, list.texture, list.features}) add(name);
        for (const auto& entry : list.entries) add(entry.file);
    }
    const auto read = files.size();
    files.insert(files.end(), {{"--output", arguments.output.string()}, {"--weights", arguments.weights.string()}});
    check_files_differ(files, read);
}

void check(const Arguments& arguments) {
    check_by_option(
        {{"gain", "--gain"}, {"least_eigenvalue_share", "--least-eigenvalue-share"}, {"ridge_share", "--ridge"}},
        [&] { arguments.options.check(); });
    if (!arguments.keys.empty() && !arguments.source_examples.empty())
        throw InputError("--key: --source-examples says what the performer does, too; give one of them");
    const bool is_video = base::lower_case(arguments.output.extension().string()) == ".mp4";
    if (!is_video && !arguments.clip.empty())
        throw InputError(
            fmt::format("--video {}: the performer stands beside the face in an .mp4 alone", arguments.clip.string()));
    if (!is_video && !arguments.beside.empty())
        throw InputError(
            fmt::format("--beside {}: several faces stand in an .mp4 alone", arguments.beside.front().string()));
    check_ending("--weights", arguments.weights.string(), ".csv");
    check_files(arguments);
    check_performance_output(arguments.output);
    for (const auto& file : {arguments.motion, arguments.source_examples})
        if (!file.empty()) database::refuse_hidden_file(file);
}

/// One character, and what the table makes it do.
struct Act {
    Performance performance;
    std::optional<animation::WireExamples> wires;
    Outcome outcome;
};

void take_wires(Act& act) {
    const auto& wires = act.wires.emplace(animation::extract_wires(act.performance.character));
    act.outcome.remarks.push_back(
        fmt::format("{} in the place of {}: they are {:.2f} mm rms off the examples, where "
                    "these move by {:.2f} mm rms",
                    base::counted(wires.wires().size(), "wire"), base::counted(wires.vertices(), "vertex", "vertices"),
                    wires.error().rms_mm, wires.error().motion_rms_mm));
    act.outcome.details["wire_error_rms_mm"] = wires.error().rms_mm;
    act.outcome.details["motion_rms_mm"] = wires.error().motion_rms_mm;
}

Act act_of(const Arguments& arguments, const MotionTable& table, const std::filesystem::path& folder,
           int picture_size) {
    Act act;
    auto& performance = act.performance;
    const auto neutral_file = folder / "neutral.ply";
    if (std::filesystem::exists(neutral_file)) database::refuse_hidden_file(neutral_file);
    performance.character = animation::read_facial_examples(folder);
    if (table.shapes)
        act.outcome.mapped = animation::map_shapes(*table.shapes, performance.character, arguments.options);
    else
        act.outcome = map_features(arguments, *table.features, performance.character, folder);
    say_overshoot(arguments, act.outcome);
    const auto& mapped = act.outcome.mapped;
    performance.weights = columns_of(performance.character, mapped.examples, mapped.weights, act.outcome.remarks);
    performance.times_s = mapped.times_s;
    performance.rate_hz = mapped.rate_hz;
    performance.picture_size = picture_size;
    performance.made_by = {{"made_by", fmt::format("Mimik {} perform", base::version())},
                           {"motion", arguments.motion.filename().string()}};
    for (auto& said : database::said_in_files(database::origin_to_carry(std::vector{neutral_file})))
        performance.made_by.push_back(std::move(said));
    if (arguments.wires) take_wires(act);
    return act;
}

/// Of the first face, and of those beside it what was not said of that one, behind their folders.
std::vector<std::string> remarks_of(const Arguments& arguments, const MotionTable& table,
                                    const std::vector<Act>& acts) {
    auto remarks = table.remarks;
    const auto& first = acts.front().outcome.remarks;
    remarks.insert(remarks.end(), first.begin(), first.end());
    for (std::size_t k = 1; k < acts.size(); ++k) {
        const auto folder = arguments.beside[k - 1].string() + ": ";
        for (const auto& remark : acts[k].outcome.remarks)
            if (std::find(first.begin(), first.end(), remark) == first.end())
                remarks.push_back(remark.starts_with(folder) ? remark : folder + remark);
    }
    if (acts.size() > 1 && !arguments.weights.empty())
        remarks.push_back(fmt::format("{}: the weights of {}, not of the faces beside it", arguments.weights.string(),
                                      arguments.examples.string()));
    return remarks;
}

/// Pixels. Beside a performer faces are as high as the clip, unless --size says otherwise.
int picture_size_of(const Arguments& arguments, const MotionTable& table) {
    constexpr int usual = 480;
    if (arguments.clip.empty()) return arguments.picture_size.value_or(usual);
    if (!table.features)
        throw InputError(fmt::format("--video {}: {} says weights and no pixels; nothing can be drawn on the video",
                                     arguments.clip.string(), arguments.motion.string()));
    const int of_clip = check_clip(arguments.clip, arguments.output, table.features->frames.size());
    return arguments.picture_size.value_or(of_clip);
}

int run(const Arguments& arguments) {
    check(arguments);
    auto table = read_motion(arguments);
    const int picture_size = picture_size_of(arguments, table);
    std::vector<std::filesystem::path> folders = {arguments.examples};
    folders.insert(folders.end(), arguments.beside.begin(), arguments.beside.end());
    std::vector<Act> acts;
    acts.reserve(folders.size());
    for (const auto& folder : folders) acts.push_back(act_of(arguments, table, folder, picture_size));
    auto remarks = remarks_of(arguments, table, acts);
    auto& outcome = acts.front().outcome;
    std::vector<Performance> performances;
    for (auto& act : acts) {
        performances.push_back(std::move(act.performance));
        performances.back().wires = act.wires ? &*act.wires : nullptr;
    }
    if (!arguments.weights.empty())
        base::write_atomically(arguments.weights, animation::encode_weights(outcome.mapped));
    const PerformerVideo performer{arguments.clip, table.features ? &*table.features : nullptr};
    for (auto& remark : write_performance(arguments.output, performances, performer, arguments.common))
        remarks.push_back(std::move(remark));
    outcome.remarks = std::move(remarks);
    report(arguments, table, outcome);
    return exit_done;
}

}  // namespace

void add_perform_command(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<Arguments>();
    auto* command = app.add_subcommand("perform", "Let a performer's motion move a character by its examples");
    command
        ->add_option("MOTION", arguments->motion,
                     "Table of feature motion, 68 points, OpenFace or Live Link Face (.csv; docs/formats.md)")
        ->required();
    command->add_option("--examples", arguments->examples, "Folder of 'mimik examples', or your own with examples.toml")
        ->required();
    command->add_option("--beside", arguments->beside, "Further folders, whose faces stand beside in an .mp4; repeat")
        ->allow_extra_args(false);
    command
        ->add_option("--video", arguments->clip,
                     "Video that the motion was captured from: it stands before the faces in an .mp4, curves drawn on")
        ->check(named_file());
    command->add_option("-o,--output", arguments->output, ".glb, .mp4, or a folder for pictures")->required();
    command->add_option("--key", arguments->keys,
                        "EXAMPLE=FRAME of the motion that shows it, such as smile=120; repeat");
    command
        ->add_option("--source-examples", arguments->source_examples,
                     "Or a table of what features do in the examples (features.csv of 'mimik examples')")
        ->check(named_file());
    command->add_option(
        "--neutral", arguments->rest,
        "Frames A:B, B among them, in which the performer is at rest (default: the first half second seen)");
    command->add_option("--gain", arguments->options.gain, "Below 1 attenuates, above exaggerates")
        ->capture_default_str();
    command->add_flag("--clamp", arguments->options.clamp, "Keep weights between 0 and 1, before the gain");
    command
        ->add_option("--least-eigenvalue-share", arguments->options.parameters.least_eigenvalue_share,
                     "Axes of less of the variance are dropped")
        ->capture_default_str();
    command
        ->add_option("--ridge", arguments->options.basis.ridge_share,
                     "Of the linear part; 0: the paper's plain least squares, which noise upsets more")
        ->capture_default_str();
    command->add_flag("--wires", arguments->wires, "Blend wires along feature lines instead of vertices");
    command->add_option("--weights", arguments->weights, "Write the weights of --examples as a table, too (.csv)")
        ->check(named_file());
    command->add_option("--rate", arguments->rate_hz, "Frames a second of tables that do not say it");
    command->add_option("--outer-eye-mm", arguments->outer_eye_mm,
                        "Between the performer's outer eye corners, of tables of pixels (default: 88)");
    command
        ->add_option("--size", arguments->picture_size,
                     "Height of pictures and video, pixels (default: 480; with --video the clip's, up to 720)")
        ->check(CLI::Range(16, 4096));
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
