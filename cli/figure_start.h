#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mimik::cli {

/// `mimik-figure`, which stands beside this program or on the PATH: VTK's libraries are then loaded only by those who
/// draw. @throws InputError saying where it was looked for.
[[nodiscard]] std::filesystem::path find_figure_program();

/// Becomes it: what `mimik figure` does.
[[noreturn]] void become_figure_program(const std::vector<std::string>& arguments);

/// Draws a figure description to a PNG. Empty: done; else what went wrong and how to draw it again. From any thread.
[[nodiscard]] std::string draw_figure(const std::filesystem::path& description, const std::filesystem::path& picture);

/// A program that writes SVG as PDF and PNG, `rsvg-convert` (package librsvg2-bin). Empty: it is not installed.
[[nodiscard]] std::filesystem::path find_svg_program();

/// Converts a plot with it, by the ending of `file`: .pdf, or .png with 300 dots an inch. Empty: done; else what went
/// wrong. From any thread.
[[nodiscard]] std::string convert_svg(const std::filesystem::path& svg, const std::filesystem::path& file);

}  // namespace mimik::cli
