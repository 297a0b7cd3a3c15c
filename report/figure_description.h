#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "figures/figure.h"
#include "io/mesh_io.h"

namespace mimik::report {

/// A file of points and how its balls look.
struct MarkerFile {
    std::filesystem::path file{};  ///< any landmark file (io/landmark_io.h)
    std::string name{};            ///< for the legend
    figures::Colour colour = figures::landmark_colour;
    double radius_mm = figures::MarkerSet{}.radius_mm;
    bool numbered = false;
};

/// A panel as files hold it.
struct PanelDescription {
    std::filesystem::path mesh{};                      ///< PLY, OBJ, STL, PCD, VTP or .bnt; empty: a gap in the table
    io::LengthUnit unit = io::LengthUnit::millimetre;  ///< of the mesh and of the files that go with it
    std::filesystem::path texture{};                   ///< PNG; empty: none
    bool textured = false;                             ///< use the image that the mesh file itself names
    std::filesystem::path landmarks{};                 ///< drawn in blue; empty: none
    std::filesystem::path controls{};   ///< CSV name,x,y,z,kind; kind muscle (red) or wrinkle (orange); empty: none
    std::filesystem::path arrows{};     ///< CSV x,y,z,to_x,to_y,to_z; empty: none
    std::vector<MarkerFile> markers{};  ///< further points
    std::optional<figures::Scalar> scalar{};
    std::string caption{};
    figures::View view{};
    std::optional<geometry::Point> centre_mm{};
    bool wire_frame = false;
    bool lit_as_skin = false;
};

struct FigureDescription {
    figures::Figure page{};  ///< everything but the panels, which stay empty here
    std::vector<PanelDescription> panels{};
};

/// Reads a description (JSON, schema 1; docs/figures.md). Files in it are relative to the description's folder.
/// @throws InputError naming the file, the key and the value; a key that is not known is an error, too.
[[nodiscard]] FigureDescription read_figure_description(const std::filesystem::path& file);
/// The same from memory; `name` stands for the file in messages.
[[nodiscard]] FigureDescription decode_figure_description(const std::string& text, const std::string& name,
                                                          const std::filesystem::path& folder);

/// The same description as text: what is as a reader takes it anyway is left out. Files are written relative to
/// `folder`.
[[nodiscard]] std::string encode_figure_description(const FigureDescription& description,
                                                    const std::filesystem::path& folder);
void write_figure_description(const std::filesystem::path& file, const FigureDescription& description);

/// Reads every file the description names. @throws InputError naming the file.
[[nodiscard]] figures::Figure load_figure(const FigureDescription& description);

/// The tables that `controls` and `arrows` name, from memory. @throws InputError naming file, line, column and value.
[[nodiscard]] std::vector<figures::MarkerSet> decode_controls(std::string_view text, const std::string& name,
                                                              io::LengthUnit unit);
[[nodiscard]] figures::ArrowSet decode_arrows(std::string_view text, const std::string& name, io::LengthUnit unit);

}  // namespace mimik::report
