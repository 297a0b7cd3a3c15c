#include "cli/capture_options.h"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "cli/named_files.h"
#include "video/face_choice.h"
#include "video/track_video.h"

namespace mimik::cli {

void add_tracking_options(CLI::App& command, TrackingArguments& arguments) {
    command.add_option("--interocular-mm", arguments.interocular_mm,
                       "Distance of the performer's outer eye corners; else that of the mean face, 87.3");
    command.add_option("--neutral", arguments.neutral, "Frames A:B, B among them, in which the face is at rest")
        ->capture_default_str();
    command
        .add_option("--face", arguments.face,
                    "Which of several faces: N, the N-th largest (1: the largest), or X,Y, the face at that pixel")
        ->capture_default_str();
    command.add_option("--tracker", arguments.tracker, "What follows the face: paper, dlib, or onnx with --model")
        ->capture_default_str();
    command.add_option("--model", arguments.model, "Net of the 68 points, .onnx (docs/algorithms/video_capture.md)")
        ->check(named_file());
    command.add_option("--colours", arguments.colours, "Colour network of the performer (mimik-video train)")
        ->check(named_file());
    command.add_flag("--smooth", arguments.smooth, "One-euro filter; what is still lags by 80 ms, what moves by less");
}

void add_capture_options(CLI::App& command, CaptureArguments& arguments) {
    command.add_option("VIDEO", arguments.source, "Video file, or a camera: its number or /dev/videoN")->required();
    command.add_option("-o,--output", arguments.output, "Feature motion, .csv (docs/formats.md)")->required();
    command.add_option("--landmarks68", arguments.landmarks68, "The 68 usual points too, .csv, in pixels")
        ->check(named_file());
    command.add_option("--sheet", arguments.sheet, "Close-ups with the curves drawn on, .png")->check(named_file());
    command.add_option("--video", arguments.video, "The frames with the curves drawn on, .mp4")->check(named_file());
    add_tracking_options(command, arguments.tracking);
    command.add_option("--frames", arguments.frames, "Stops after so many; 0: at the end")->capture_default_str();
    add_common_options(command, arguments.common);
}

void add_live_options(CLI::App& command, LiveArguments& arguments) {
    command.add_option("VIDEO", arguments.source, "Camera: its number or /dev/videoN; or a video file in its place")
        ->required();
    command
        .add_option("--examples", arguments.examples,
                    "Folder of 'mimik examples', or your own with examples.toml: the face that is moved")
        ->required();
    command.add_option("-o,--output", arguments.output, "Performer and face, .mp4, in the place of a window")
        ->check(named_file());
    add_tracking_options(command, arguments.tracking);
    command
        .add_option("--source-examples", arguments.source_examples,
                    "Table of what features do in the examples (features.csv of 'mimik examples')")
        ->check(named_file());
    command.add_option("--weights", arguments.weights, "Write the weights as a table, too (.csv)")->check(named_file());
    command.add_option("--gain", arguments.gain, "Below 1 attenuates, above exaggerates")->capture_default_str();
    command.add_flag("--clamp", arguments.clamp, "Keep weights between 0 and 1, before the gain");
    command.add_option("--frames", arguments.frames, "Stops after so many; 0: at the end, or at the key q")
        ->capture_default_str();
    add_common_options(command, arguments.common);
}

FaceChoice face_choice(const std::string& text) {
    const auto fail = [&](const char* why) -> void {
        throw InputError(fmt::format(
            "--face is '{}'; {}: N of 1 (the largest) to {}, or X,Y in pixels of the frame, such as 320,240", text, why,
            video::most_faces));
    };
    FaceChoice choice;
    const auto comma = text.find(',');
    if (comma == std::string::npos) {
        const auto rank = base::parse_integer(text).value_or(0);
        if (rank < 1 || rank > video::most_faces) fail("give the number of a face or a pixel");
        choice.rank = static_cast<int>(rank);
        return choice;
    }
    const auto x = base::parse_double(text.substr(0, comma)), y = base::parse_double(text.substr(comma + 1));
    if (!x || !y || !video::may_be_pixel(*x, *y)) fail("a pixel has two numbers of 0 or more");
    choice.pixel = {*x, *y};
    return choice;
}

std::array<int, 2> neutral_frames(const std::string& text) {
    const auto colon = text.find(':');
    const auto from = base::parse_integer(text.substr(0, colon)).value_or(-1);
    const auto to = colon == std::string::npos ? -1 : base::parse_integer(text.substr(colon + 1)).value_or(-1);
    if (from < 0 || to < from || to >= video::most_waiting_frames)
        throw InputError(fmt::format("--neutral is '{}'; give two frames A:B with A <= B < {}, such as 0:9", text,
                                     video::most_waiting_frames));
    return {static_cast<int>(from), static_cast<int>(to)};
}

void check_tracking_options(const TrackingArguments& arguments) {
    (void)neutral_frames(arguments.neutral);
    (void)face_choice(arguments.face);
    const bool onnx = arguments.tracker == "onnx";
    if (!onnx && arguments.tracker != "paper" && arguments.tracker != "dlib")
        throw InputError(fmt::format("--tracker is '{}'; there are paper, dlib and onnx", arguments.tracker));
    if (onnx && arguments.model.empty())
        throw InputError("--tracker onnx: --model is missing; name the .onnx file of a net of the 68 points");
    if (!onnx && !arguments.model.empty())
        throw InputError(fmt::format("--model is '{}'; it goes with --tracker onnx", arguments.model));
    if (arguments.tracker != "paper" && !arguments.colours.empty())
        throw InputError(fmt::format("--colours is '{}'; it goes with --tracker paper", arguments.colours));
}

namespace {

std::vector<NamedFile> files_read(const std::string& source, const TrackingArguments& tracking) {
    return {{"VIDEO", source}, {"--colours", tracking.colours}, {"--model", tracking.model}};
}

}  // namespace

void check_capture_options(const CaptureArguments& arguments) {
    if (arguments.output.empty()) throw InputError("--output is empty; name a .csv file");
    check_ending("--output", arguments.output, ".csv");
    check_ending("--landmarks68", arguments.landmarks68, ".csv");
    check_ending("--sheet", arguments.sheet, ".png");
    check_ending("--video", arguments.video, ".mp4");
    auto files = files_read(arguments.source, arguments.tracking);
    const auto read = files.size();
    files.insert(files.end(), {{"--output", arguments.output},
                               {"--landmarks68", arguments.landmarks68},
                               {"--sheet", arguments.sheet},
                               {"--video", arguments.video}});
    check_files_differ(files, read);
    check_tracking_options(arguments.tracking);
}

void check_live_options(const LiveArguments& arguments) {
    check_ending("--output", arguments.output, ".mp4");
    check_ending("--weights", arguments.weights, ".csv");
    auto files = files_read(arguments.source, arguments.tracking);
    files.push_back({"--source-examples", arguments.source_examples});
    const auto read = files.size();
    files.insert(files.end(), {{"--output", arguments.output}, {"--weights", arguments.weights}});
    check_files_differ(files, read);
    check_tracking_options(arguments.tracking);
}

}  // namespace mimik::cli
