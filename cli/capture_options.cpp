#include "cli/capture_options.h"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::cli {

void add_capture_options(CLI::App& command, CaptureArguments& arguments) {
    command.add_option("VIDEO", arguments.source, "Video file, or a camera: its number or /dev/videoN")->required();
    command.add_option("-o,--output", arguments.output, "Feature motion, .csv (docs/formats.md)")->required();
    command.add_option("--landmarks68", arguments.landmarks68, "The 68 usual points too, .csv, in pixels");
    command.add_option("--sheet", arguments.sheet, "Close-ups with the curves drawn on, .png");
    command.add_option("--video", arguments.video, "The frames with the curves drawn on, .mp4");
    command.add_option("--interocular-mm", arguments.interocular_mm,
                       "Distance of the performer's outer eye corners; else that of the mean face, 87.3");
    command.add_option("--neutral", arguments.neutral, "Frames A:B, B among them, in which the face is at rest")
        ->capture_default_str();
    command.add_option("--tracker", arguments.tracker, "What follows the face: paper or dlib")->capture_default_str();
    command.add_option("--colours", arguments.colours, "Colour network of the performer (mimik-video train)");
    command.add_flag("--smooth", arguments.smooth, "One-euro filter; what is still lags by 80 ms, what moves by less");
    command.add_option("--frames", arguments.frames, "Stops after so many; 0: at the end")->capture_default_str();
    add_common_options(command, arguments.common);
}

std::array<int, 2> neutral_frames(const std::string& text) {
    constexpr std::int64_t most = 1'000'000;
    const auto colon = text.find(':');
    const auto from = base::parse_integer(text.substr(0, colon)).value_or(-1);
    const auto to = colon == std::string::npos ? -1 : base::parse_integer(text.substr(colon + 1)).value_or(-1);
    if (from < 0 || to < from || to > most)
        throw InputError(fmt::format("--neutral is '{}'; give two frames A:B with A <= B, such as 0:9", text));
    return {static_cast<int>(from), static_cast<int>(to)};
}

namespace {

bool are_one_file(const std::string& a, const std::string& b) {
    std::error_code none;
    if (std::filesystem::equivalent(a, b, none)) return true;
    const auto from = std::filesystem::weakly_canonical(a, none), to = std::filesystem::weakly_canonical(b, none);
    return a == b || (!from.empty() && from == to);
}

/// Nothing is written over what is read, nor over what else is written.
void check_files_differ(const CaptureArguments& arguments) {
    struct Named {
        const char* option;
        const std::string& file;
    };
    const std::array<Named, 6> files = {{{"VIDEO", arguments.source},
                                         {"--colours", arguments.colours},
                                         {"--output", arguments.output},
                                         {"--landmarks68", arguments.landmarks68},
                                         {"--sheet", arguments.sheet},
                                         {"--video", arguments.video}}};
    for (std::size_t k = 2; k < files.size(); ++k)
        for (std::size_t other = 0; other < k; ++other)
            if (!files[k].file.empty() && !files[other].file.empty() && are_one_file(files[k].file, files[other].file))
                throw InputError(fmt::format("{} is '{}', the same file as {}; give it another name", files[k].option,
                                             files[k].file, files[other].option));
}

}  // namespace

void check_capture_options(const CaptureArguments& arguments) {
    const auto ends_with = [](const char* option, const std::string& file, const char* extension) {
        if (file.empty() || base::equal_ignoring_case(std::filesystem::path(file).extension().string(), extension))
            return;
        throw InputError(fmt::format("{} is '{}'; it is written as {}", option, file, extension));
    };
    if (arguments.output.empty()) throw InputError("--output is empty; name a .csv file");
    ends_with("--output", arguments.output, ".csv");
    ends_with("--landmarks68", arguments.landmarks68, ".csv");
    ends_with("--sheet", arguments.sheet, ".png");
    ends_with("--video", arguments.video, ".mp4");
    check_files_differ(arguments);
    (void)neutral_frames(arguments.neutral);
}

}  // namespace mimik::cli
