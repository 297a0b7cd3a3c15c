#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mimik::cli {

/// A program of Mimik's that stands beside this one or on the PATH; empty: none.
[[nodiscard]] std::filesystem::path find_own_program(const std::string& name);

/// Runs it and waits; `words` begin with its name. Empty: done; else what went wrong. From any thread.
[[nodiscard]] std::string run_program(const std::filesystem::path& program, std::vector<std::string> words);

/// `mimik-figure`, which stands beside this program or on the PATH: VTK's libraries are then loaded only by those who
/// draw. @throws InputError saying where it was looked for.
[[nodiscard]] std::filesystem::path find_figure_program();

/// Becomes it: what `mimik figure` does.
[[noreturn]] void become_figure_program(const std::vector<std::string>& arguments);

/// Draws a figure description to a PNG. Empty: done; else what went wrong and how to draw it again. From any thread.
[[nodiscard]] std::string draw_figure(const std::filesystem::path& description, const std::filesystem::path& picture);

/// `mimik-video`, likewise. @throws InputError saying where it was looked for.
[[nodiscard]] std::filesystem::path find_video_program();
/// Makes a video of the pictures in a folder. Empty: done; else what went wrong. @throws as find_video_program.
[[nodiscard]] std::string write_video(const std::filesystem::path& frames, const std::filesystem::path& video,
                                      double rate_hz);
/// A program that writes SVG as PDF and PNG, `rsvg-convert` (package librsvg2-bin). Empty: it is not installed.
[[nodiscard]] std::filesystem::path find_svg_program();

/// Converts a plot with it, by the ending of `file`: .pdf, or .png with 300 dots an inch. Empty: done; else what went
/// wrong. From any thread.
[[nodiscard]] std::string convert_svg(const std::filesystem::path& svg, const std::filesystem::path& file);

}  // namespace mimik::cli
