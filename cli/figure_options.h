#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "report/figure_description.h"

namespace mimik::cli {

/// What is given once for each panel, or once for all of them.
struct PerPanel {
    std::vector<std::string> meshes, captions, landmarks, controls, arrows, textures, views;
    std::string unit = "mm";
    bool textured = false;
    std::string scalar, label, colour_map = "sequential";
    std::vector<double> range;
};

/// The words of 'mimik figure'. Both programs read them: `mimik` to help and to refuse, `mimik-figure` to draw.
struct FigureArguments {
    Common common;
    report::FigureDescription description;
    PerPanel given;
    std::string output, file, size, framing = "own";
    std::vector<const CLI::Option*> described;  ///< what a description says itself
};

void add_figure_options(CLI::App& command, FigureArguments& arguments);

/// @throws InputError for options that exclude one another.
void check_figure_options(const FigureArguments& arguments);

}  // namespace mimik::cli
