#pragma once

#include <string>

#include "animation/animate.h"
#include "figures/figure.h"
#include "geometry/mesh.h"
#include "geometry/quad_grid.h"
#include "preprocessing/face.h"
#include "report/compared_people.h"
#include "report/hole_drawing.h"

// Faces as named figures show them: meshes with the colours of skin, of filled holes and of an open mouth.

namespace mimik::report {

/// The surface of a face in another frame, mm. Measured skin and bridged holes have colours of their own.
/// @param kept  grid index of every vertex of the mesh; may be null
[[nodiscard]] geometry::Mesh drawn_surface(const geometry::QuadGrid& grid, HoleDrawing holes,
                                           const geometry::Transform& drawn_from_grid = geometry::Transform::Identity(),
                                           std::vector<std::uint32_t>* kept = nullptr);

/// What hangs together with most vertices: where few of the people of an average face had data, scraps of it lie about.
/// @param mesh  of a grid: texture coordinates, if any, one per vertex
[[nodiscard]] geometry::Mesh largest_part(const geometry::Mesh& mesh);

/// A neutral face, moved. Where lips or lids part, the surface between them is drawn dark, as the inside of a mouth,
/// unless holes are gaps. Vertices of the mesh beyond `kept` are of that dark surface.
[[nodiscard]] geometry::Mesh drawn_animation(const animation::AnimatedFace& animated,
                                             const preprocessing::Face& neutral, HoleDrawing holes,
                                             std::vector<std::uint32_t>* kept = nullptr);

/// Middle of what is drawn of a neutral face: where all panels of that person look.
[[nodiscard]] geometry::Point middle_of(const preprocessing::Face& neutral);

/// A page of panels for print: 300 dots an inch, captions of about 8 points, 15 cm wide with `columns` panels.
[[nodiscard]] figures::Figure page_of(int columns, const std::string& title);

/// "(a) ", "(b) ", ... before the captions of all panels that show something.
void letter_panels(figures::Figure& page);

/// A panel of a surface; `caption` without its letter.
[[nodiscard]] figures::Panel face_panel(geometry::Mesh mesh, const geometry::Point& centre_mm, std::string caption);
[[nodiscard]] figures::Panel neutral_panel(const ShownPerson& person, HoleDrawing holes, std::string caption);
[[nodiscard]] figures::Panel animated_panel(const ShownPerson& person, HoleDrawing holes, std::string caption);
/// The real scan in the frame of the neutral one; an empty panel that says so, of somebody without.
[[nodiscard]] figures::Panel real_panel(const ShownPerson& person, HoleDrawing holes, std::string caption);

/// The face with its photograph, brought to the subject's neutral scan; plain where it has none. Empty: it has one;
/// else why it is shown without.
std::string add_photograph(figures::Panel& panel, const preprocessing::Face& face);

/// Makes a photograph dark where it shows an open mouth, that is a hole of the scan between the lips: there it holds
/// whatever lay behind the face. A face without the landmarks of a mouth, or with closed lips, is left as it is.
void darken_open_mouth(io::Image& photograph, const preprocessing::Face& face);

/// The landmarks as the thesis shows them, in blue.
[[nodiscard]] figures::MarkerSet landmark_markers(const geometry::Landmarks& landmarks);
/// The muscle points in red and the wrinkle points in orange, of those that there are.
[[nodiscard]] std::vector<figures::MarkerSet> control_markers(const std::vector<ShownControl>& controls);

}  // namespace mimik::report
