#pragma once

#include <functional>
#include <string>
#include <vector>

#include "figures/figure.h"
#include "report/figure_cast.h"

// The figures of the thesis that show data, and some more, each by its name. A group of them is one file,
// report/thesis_figures/GROUP.cpp: CMake finds it, and nothing else names it.

namespace mimik::report {

struct FigureTable {
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;  ///< each as long as the header
};

/// A figure as a value, before anything is drawn. It has one of picture, plot and table.
struct FigurePlan {
    figures::Figure picture{};           ///< without panels: none
    std::string svg{};                   ///< a plot, written (svg_plot.h); empty: none
    FigureTable table{};                 ///< without columns: none
    std::string caption{};               ///< in full sentences, for the file of captions
    std::vector<std::string> remarks{};  ///< what is otherwise than in the thesis, and why
};

/// What a figure cannot be made without.
enum class FigureNeeds {
    faces,   ///< the workspace
    rows,    ///< a file of rows as well (NamedFigureOptions::rows_file)
    nothing  ///< it is the same for everybody
};

struct NamedFigure {
    std::string name;   ///< "6-4", "A-1", "table-3-2", "heat-map"
    std::string title;  ///< one line
    std::string needs;  ///< in words, for a list
    FigureNeeds kind = FigureNeeds::faces;
    std::function<FigurePlan(const FigureCast&)> build;  ///< @throws InputError saying what the workspace lacks
};

/// All of them: the figures by their numbers, then the tables, then what the thesis does not have.
[[nodiscard]] const std::vector<NamedFigure>& named_figures();

/// "6-4", "fig-6-4" and "FIG-6-4" are one. @throws InputError listing the names.
[[nodiscard]] const NamedFigure& named_figure(const std::string& name);

/// The name of its file, without extension: "fig-6-4", "table-3-2", "heat-map".
[[nodiscard]] std::string file_stem(const NamedFigure& figure);

/// A figure of the thesis that is not made, and why.
struct LeftOutFigure {
    std::string name, reason;
};
[[nodiscard]] const std::vector<LeftOutFigure>& left_out_figures();

}  // namespace mimik::report
