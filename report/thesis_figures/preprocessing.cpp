#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/errors.h"
#include "database/scan_database.h"
#include "io/image.h"
#include "report/drawn_face.h"
#include "report/named_figure.h"

// Chapter 5.4 of the thesis: from a scan to a grid, and on to the pose of the average face.

namespace mimik::report::thesis_figures {
namespace {

using geometry::Mesh;
using geometry::Point;

/// A scan as it was measured: its own faces, or neighbours of the scanner's lattice joined.
Mesh measured_mesh(const geometry::RangeScan& scan) {
    constexpr double longest_edge_mm = 10.0;  // as mimik figure joins a .bnt
    Mesh mesh;
    mesh.vertices_mm = scan.points_mm;
    mesh.faces = scan.faces;
    if (mesh.faces.size() > 0 || !scan.organised()) return mesh;
    const auto index = [&](int row, int col) { return static_cast<std::uint32_t>(row * scan.cols + col); };
    for (int row = 0; row + 1 < scan.rows; ++row)
        for (int col = 0; col + 1 < scan.cols; ++col) {
            const std::array quad = {index(row, col), index(row, col + 1), index(row + 1, col + 1),
                                     index(row + 1, col)};
            bool joined = true;
            for (std::size_t k = 0; k < 4; ++k)  // false of a NaN corner, too
                joined = joined &&
                         (mesh.vertices_mm[quad[k]] - mesh.vertices_mm[quad[(k + 1) % 4]]).norm() <= longest_edge_mm;
            if (joined) mesh.faces.add(quad);
        }
    return mesh;
}

/// The vertices that faces use, in their order: a file of a mesh may hold no vertex that is not finite.
Mesh used_part(const Mesh& mesh) {
    Mesh used;
    std::vector<std::uint32_t> place(mesh.vertices_mm.size(), ~std::uint32_t{0});
    std::vector<std::uint32_t> corners;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        corners.clear();
        for (const auto v : mesh.faces[f]) {
            if (place[v] == ~std::uint32_t{0}) {
                place[v] = static_cast<std::uint32_t>(used.vertices_mm.size());
                used.vertices_mm.push_back(mesh.vertices_mm[v]);
            }
            corners.push_back(place[v]);
        }
        used.faces.add(corners);
    }
    return used;
}

/// A picture as a flat panel, as high as a face.
figures::Panel flat_picture(io::Image image, double height_mm, std::string caption) {
    figures::Panel panel;
    const double half_height = height_mm / 2, half_width = half_height * image.width / image.height;
    panel.mesh.vertices_mm = {Point(-half_width, -half_height, 0), Point(half_width, -half_height, 0),
                              Point(half_width, half_height, 0), Point(-half_width, half_height, 0)};
    panel.mesh.texture_coordinates = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    panel.mesh.faces.add(std::array<std::uint32_t, 4>{0, 1, 2, 3});
    panel.texture = std::move(image);
    panel.centre_mm = Point::Zero();
    panel.caption = std::move(caption);
    return panel;
}

/// The scan that a face was made from, in its database. @throws InputError saying why it cannot be had.
Mesh scan_before(const FigureCast& cast, const database::ScanId& id) {
    const auto database = database::open_database(cast.workspace().database_root());
    const auto* entry = database.find(id);
    if (!entry) throw InputError(fmt::format("{} is not in the database any more", id.name()));
    return used_part(measured_mesh(database::load(*entry).scan));
}

FigurePlan steps_of_a_face(const FigureCast& cast) {
    const auto face = cast.neutral(cast.female());
    const auto centre_mm = middle_of(face);
    const auto holes = cast.options().holes;
    FigurePlan plan;
    plan.picture = page_of(3, fmt::format("Preprocessing of {}", cast.words(cast.female())));
    auto& panels = plan.picture.panels;
    figures::Panel before;
    try {
        before = face_panel(scan_before(cast, face.id), centre_mm, "mesh before preprocessing");
        before.wire_frame = true;
    } catch (const InputError& e) {
        before.caption = "the scan is not at hand";
        plan.remarks.push_back(fmt::format("the scan before preprocessing is left out: {}", e.what()));
    }
    panels.push_back(std::move(before));
    panels.push_back(face_panel(drawn_surface(face.grid, holes), centre_mm,
                                fmt::format("mesh of {} x {} vertices after it", face.grid.rows, face.grid.cols)));
    panels.back().wire_frame = true;
    panels.push_back(face_panel(drawn_surface(face.grid, holes), centre_mm, "surface without texture"));
    auto textured = face_panel(drawn_surface(face.grid, holes), centre_mm, "surface with texture");
    const auto reason = add_photograph(textured, face);
    if (reason.empty()) {
        panels.push_back(flat_picture(*textured.texture, 200, "texture of the face"));
        panels.push_back(std::move(textured));
    } else {
        plan.remarks.push_back(reason + "; (d) and (e) are left out");
    }
    letter_panels(plan.picture);
    plan.caption = fmt::format(
        "{}: face mesh before (a) and after (b) preprocessing, the surface without texture (c), "
        "the texture of the face (d), and the surface with it (e).",
        cast.words(cast.female()));
    return plan;
}

/// Who has an expressive scan to show beside the neutral one: the thesis's AUs, then anything.
std::optional<database::ScanId> expressive_scan(const FigureCast& cast, const std::string& subject) {
    for (const auto* code : {"12", "20", "15"})
        if (const auto id = cast.workspace().scan_of(subject, cast.expression(code))) return id;
    for (const auto& id : cast.workspace().scans())
        if (id.subject == subject && !id.neutral()) return id;
    return std::nullopt;
}

FigurePlan normalisation(const FigureCast& cast) {
    const auto& average = cast.workspace().average();
    const auto holes = cast.options().holes;
    const auto& subject = cast.female();
    const auto neutral = cast.neutral(subject);
    std::vector<std::pair<std::string, preprocessing::Face>> faces = {{"neutral", neutral}};
    FigurePlan plan;
    if (const auto id = expressive_scan(cast, subject))
        faces.emplace_back(id->expression().name(), cast.workspace().face(*id));
    else
        plan.remarks.push_back(subject + " has no expressive scan to normalise");
    constexpr int columns = 4;
    plan.picture = page_of(columns, "Normalisation to the average face");
    auto& panels = plan.picture.panels;
    const Point nose_mm = average.landmarks.position_mm("nose_tip");
    const auto add = [&](const Mesh& mesh, const std::string& caption) {
        for (const auto* view : {"front", "left"}) {
            const bool profile = std::string(view) == "left";
            auto panel = face_panel(mesh, nose_mm + Point(0, -8, profile ? -45 : 0),
                                    caption + (profile ? ",\nprofile" : ",\nfront"));
            panel.view = figures::parse_view(view);
            panels.push_back(std::move(panel));
        }
    };
    add(largest_part(drawn_surface(average.grid, HoleDrawing::fill)), "average face model");
    for (int k = 2; k < columns; ++k) panels.emplace_back();
    for (const bool after : {false, true})
        for (const auto& [what, face] : faces) {
            geometry::Transform place = face.average_from_scan;
            if (!after) {  // as the scanner saw it, its nose tip where the average face has its own
                place = geometry::Transform::Identity();
                place.translation() = nose_mm - face.landmarks.position_mm("nose_tip");
            } else if (cast.options().method == "thesis") {
                place = face.average_from_scan_affine;
            }
            add(drawn_surface(face.grid, holes, place), fmt::format("{} {}", what, after ? "after" : "before"));
        }
    if (faces.size() == 1) plan.picture.columns = 2;
    if (faces.size() == 1) panels.erase(panels.begin() + 2, panels.begin() + columns);
    plan.caption = fmt::format(
        "Normalisation of {}: the average face model (top); its faces before (middle), with the nose tip at that of "
        "the model, and after normalisation (bottom){}.",
        cast.words(subject),
        cast.options().method == "thesis" ? ", by the affine map of Eqs 5.1 to 5.4"
                                          : ", by a similarity that was fitted on the neutral face and serves the "
                                            "expressive one as well");
    return plan;
}

}  // namespace

std::vector<NamedFigure> preprocessing_figures() {
    return {{"5-5", "A face before and after preprocessing, and its texture",
             "a neutral scan; the database and a photograph, if any", FigureNeeds::faces, steps_of_a_face},
            {"5-6", "Normalisation: average face, a face before and after, neutral and expressive",
             "a neutral scan; an expressive one, if any", FigureNeeds::faces, normalisation}};
}

}  // namespace mimik::report::thesis_figures
