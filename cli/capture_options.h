#pragma once

#include <array>
#include <optional>
#include <string>

#include "cli/command.h"

namespace mimik::cli {

/// How a face is followed: of `capture` and of `live`.
struct TrackingArguments {
    std::string tracker = "paper", model, colours, face = "1", neutral = "0:9";
    std::optional<double> interocular_mm;
    bool smooth = false;
};
void add_tracking_options(CLI::App& command, TrackingArguments& arguments);
/// @throws InputError naming the option
void check_tracking_options(const TrackingArguments& arguments);

/// What `mimik capture` and `mimik-video track` are told: one list, so that help and programs cannot differ.
struct CaptureArguments {
    Common common;
    std::string source, output, landmarks68, sheet, video;
    TrackingArguments tracking;
    long frames = 0;
};
void add_capture_options(CLI::App& command, CaptureArguments& arguments);
/// @throws InputError naming the option
void check_capture_options(const CaptureArguments& arguments);
/// "A:B", B among them. @throws InputError naming --neutral
[[nodiscard]] std::array<int, 2> neutral_frames(const std::string& text);

/// "N", the N-th largest face, or "X,Y", the face at that pixel.
struct FaceChoice {
    int rank = 1;
    std::optional<std::array<double, 2>> pixel;
};
/// @throws InputError naming --face
[[nodiscard]] FaceChoice face_choice(const std::string& text);

/// What `mimik live` and `mimik-video live` are told.
struct LiveArguments {
    Common common;
    std::string source, output, examples, source_examples, weights;
    TrackingArguments tracking;
    double gain = 1;
    bool clamp = false;
    long frames = 0;
};
void add_live_options(CLI::App& command, LiveArguments& arguments);
/// @throws InputError naming the option
void check_live_options(const LiveArguments& arguments);

}  // namespace mimik::cli
