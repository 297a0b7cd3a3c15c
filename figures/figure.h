#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "figures/colour_map.h"
#include "geometry/mesh.h"
#include "geometry/types.h"
#include "io/image.h"

namespace mimik::figures {

/// Where the camera stands: turned about the face's +y axis and raised. Sides are the subject's own.
struct View {
    double yaw_deg = 0.0;    ///< 0 before the face, +90 at the subject's left ear, in [-180, 180]
    double pitch_deg = 0.0;  ///< above (+) or below (-) the face, in [-89, 89]
};

/// "front", "left", "right" (profiles from the subject's left and right), "three-quarter-left", "three-quarter-right"
/// (35 degrees), "three-quarter" (the left one). @throws InputError listing the names.
[[nodiscard]] View parse_view(const std::string& name);

inline constexpr Colour landmark_colour = {36, 84, 190};
inline constexpr Colour muscle_colour = {206, 38, 38};
inline constexpr Colour wrinkle_colour = {230, 150, 0};
/// Of a face without colours of its own.
inline constexpr Colour skin = {240, 212, 192};

/// Points drawn as small balls on the face.
struct MarkerSet {
    std::string name{};  ///< for the legend; sets of one name and colour share an entry
    Colour colour = landmark_colour;
    double radius_mm = 2.0;  ///< seen clearly where a face is 400 pixels high
    std::vector<geometry::Point> positions_mm{};
    bool numbered = false;  ///< 1, 2, ... beside the balls, in their order
};

/// Straight arrows on the face, such as displacements of control points.
struct Arrow {
    geometry::Point from_mm = geometry::Point::Zero();
    geometry::Point to_mm = geometry::Point::Zero();
};
struct ArrowSet {
    std::string name{};
    Colour colour = muscle_colour;
    double radius_mm = 0.5;
    std::vector<Arrow> arrows{};
};

/// Colours a face by an attribute of its mesh.
struct Scalar {
    std::string attribute{};  ///< of the mesh; of several components the length is shown
    std::string label{};      ///< beside the bar, with the unit; empty: the attribute's name
    /// Values at the ends of the colour map; without: the least and greatest finite value of all panels that show the
    /// attribute (0 and greatest if none is negative; symmetric about 0 for ColourMap::diverging).
    std::optional<std::array<double, 2>> range{};
    ColourMap map = ColourMap::sequential;
};

/// One face. A panel whose mesh has no vertices stays empty (a gap in the table, with its caption).
struct Panel {
    geometry::Mesh mesh{};  ///< mm; faces with a corner that is not finite are left out; no faces: drawn as dots
    std::optional<io::Image> texture{};  ///< needs texture coordinates; used where `scalar` is not
    std::vector<MarkerSet> markers{};
    std::vector<ArrowSet> arrows{};
    std::optional<Scalar> scalar{};
    std::string caption{};  ///< UTF-8 (Latin-1 letters); wrapped to the panel's width; '\n' breaks a line
    View view{};
    std::optional<geometry::Point> centre_mm{};  ///< what the camera looks at; without: as Figure::framing says
    bool wire_frame = false;                     ///< the edges of the faces are drawn over the surface
    bool lit_as_skin = false;  ///< the mesh's own colours are skin without light in it: lit as plain skin is
};

/// What the middle of a panel shows. The scale is one for all panels either way.
enum class Framing {
    own,    ///< each panel its own face: scans in frames of their own
    common  ///< one point of space for all panels: a motion in one frame stays visible as motion
};
[[nodiscard]] constexpr const char* to_string(Framing framing) { return framing == Framing::common ? "common" : "own"; }
[[nodiscard]] Framing parse_framing(const std::string& name);

struct Figure {
    std::vector<Panel> panels{};
    std::string title{};
    int columns = 0;  ///< 0: all in one row up to four, else near-square
    int panel_width_px = 400;
    int panel_height_px = 480;
    int font_size_px = 19;  ///< captions; the title is 1.3 times as large
    Colour background = {255, 255, 255};
    Framing framing = Framing::own;
    /// Millimetres from the lower to the upper edge of a panel; without: what shows every face whole.
    std::optional<double> height_mm{};
    double scale_bar_mm = 0.0;  ///< length of a bar below the first panel; 0: none
    bool legend = false;        ///< a line that names the marker and arrow sets
    /// Each pixel is the mean of supersampling^2 drawn ones, on top of the renderer's own multisampling; 1 to 4.
    int supersampling = 1;
    int dots_per_inch = 0;               ///< how large a pixel is in print: told in the PNG; 0: not said
    std::vector<std::string> remarks{};  ///< what readers left out or took otherwise than written

    void check() const;  ///< throws InputError naming field, panel and value
};

/// One value per vertex: the attribute itself, or the length of a vector. @throws InputError listing the attributes
/// there are.
[[nodiscard]] std::vector<double> scalar_values(const geometry::Mesh& mesh, const std::string& attribute);

/// Draws the figure: orthographic cameras, light from above on the image's left, smooth normals. Needs no display. The
/// same figure gives the same bytes on one machine. The first call of a process opens the renderer (see drawing_route).
/// From any thread; one figure is drawn at a time.
/// @throws InputError for a bad figure, or if the machine offers no way to draw.
[[nodiscard]] io::Image render(const Figure& figure);

/// Opens the renderer if it is not open yet and says which way was found: "EGL surfaceless", "X display :0" or
/// "Xvfb", with the name of the driver. The ways are tried in this order; the environment variable MIMIK_DRAWING (egl,
/// display, xvfb) allows only one of them. @throws InputError with the reason of every way that failed.
[[nodiscard]] std::string drawing_route();

}  // namespace mimik::figures
