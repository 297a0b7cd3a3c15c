#pragma once

#include <array>
#include <optional>
#include <string>

#include "cli/command.h"

namespace mimik::cli {

/// What `mimik capture` and `mimik-video track` are told: one list, so that help and programs cannot differ.
struct CaptureArguments {
    Common common;
    std::string source, output, landmarks68, sheet, video, neutral = "0:9", tracker = "paper", colours;
    std::optional<double> interocular_mm;
    bool smooth = false;
    long frames = 0;
};
void add_capture_options(CLI::App& command, CaptureArguments& arguments);
/// @throws InputError naming the option
void check_capture_options(const CaptureArguments& arguments);
/// "A:B", B among them. @throws InputError naming --neutral
[[nodiscard]] std::array<int, 2> neutral_frames(const std::string& text);

}  // namespace mimik::cli
