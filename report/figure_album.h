#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "report/named_figure.h"
#include "report/quality_sheet.h"

namespace mimik::report {

/// What turns a plan into files. The layers that can do it supply it.
struct AlbumTools {
    DrawFigure draw;  ///< a description to a PNG; from several threads
    /// An SVG to a PDF or a PNG of 300 dots an inch, by the ending of the second file. Empty: done; else what went
    /// wrong. Not set: plots stay SVG.
    std::function<std::string(const std::filesystem::path& svg, const std::filesystem::path& file)> convert{};
    std::function<void(const std::string& name)> progress{};  ///< after each figure, from any thread; may be empty
};

struct AlbumEntry {
    std::string name, title, caption;
    FigureTable table;                         ///< of a table: shown on the page
    std::vector<std::filesystem::path> files;  ///< names within the folder
    std::vector<std::string> remarks;
    std::string failure;  ///< why it was not made; empty: it was
};

/// Makes figures, each by its name, in a folder: a PNG of a picture ("fig-6-4.png"), SVG (PDF and PNG where they can be
/// converted) of a plot, CSV and .tex (booktabs) of a table; captions.md with all captions; index.html, a page of all
/// of them that needs no network. A figure that cannot be made says why, and the others are made. Captions and page are
/// of this call's figures.
/// @param keep_parts  leave meshes and descriptions in FOLDER/parts/NAME, to change and to draw again
/// @throws InputError if the folder takes no files.
[[nodiscard]] std::vector<AlbumEntry> make_album(const FigureCast& cast, const std::vector<const NamedFigure*>& figures,
                                                 const std::filesystem::path& folder, const AlbumTools& tools,
                                                 bool keep_parts = false);

/// Writes the meshes, textures, points and the description of a picture. @return the description
std::filesystem::path write_picture_parts(const std::filesystem::path& folder, const figures::Figure& picture);

[[nodiscard]] std::string table_csv(const FigureTable& table);
/// A tabular for the package booktabs; long columns are paragraphs.
[[nodiscard]] std::string table_latex(const FigureTable& table);

}  // namespace mimik::report
