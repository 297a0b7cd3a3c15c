#include "report/figure_description.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "database/bnt.h"
#include "database/hidden_subjects.h"
#include "io/json_values.h"
#include "io/landmark_io.h"
#include "io/texture_atlas.h"

namespace mimik::report {

using figures::ArrowSet;
using figures::Colour;
using figures::ColourMap;
using figures::Figure;
using figures::landmark_colour;
using figures::MarkerSet;
using figures::muscle_colour;
using figures::Panel;
using figures::Scalar;
using figures::View;
using figures::wrinkle_colour;

namespace {

using geometry::Point;
using io::shown;
using Json = nlohmann::json;
namespace fs = std::filesystem;

/// One JSON object whose keys are all asked for; finish() refuses the others.
class Keys {
public:
    Keys(const Json& object, std::string where) : object_(object), where_(std::move(where)) {
        if (!object.is_object()) fail("is not an object");
    }
    /// Stores the value of `key` if it is there.
    template <class T, class Convert>
    bool take(const char* key, T& target, const Convert& convert) {
        known_.insert(key);
        const auto found = object_.find(key);
        if (found == object_.end()) return false;
        const std::string place = where_ + (where_.ends_with(": ") ? "" : ".") + key;
        try {
            target = convert(*found, place);
        } catch (const Json::exception&) {
            throw InputError(fmt::format("{}: {} has the wrong type", place, shown(*found)));
        }
        return true;
    }
    template <class T>
    bool take(const char* key, T& target) {
        return take(key, target, [](const Json& value, const std::string& place) { return plain<T>(value, place); });
    }
    /// For values that a parser of ours reads; its message gets the place.
    template <class T, class Parse>
    bool take_parsed(const char* key, T& target, const Parse& parse) {
        return take(key, target, [&](const Json& value, const std::string& place) {
            try {
                return parse(value.get<std::string>());
            } catch (const InputError& e) {
                throw InputError(place + ": " + e.what());
            }
        });
    }
    void finish() const {
        for (const auto& [key, value] : object_.items())
            if (!known_.contains(key))
                fail(fmt::format("the key {} is not known; known are {}", base::in_quotes(key),
                                 fmt::join(known_, ", ")));
    }
    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(where_ + (where_.ends_with(": ") ? "" : ": ") + what);
    }

private:
    template <class T>
    static T plain(const Json& value, const std::string& place) {
        if constexpr (std::is_same_v<T, int>) {
            if (!value.is_number_integer())
                throw InputError(fmt::format("{}: {} is not a whole number", place, shown(value)));
            const auto number = value.get<std::int64_t>();
            if (std::abs(number) > 1'000'000'000)
                throw InputError(fmt::format("{}: {} is out of range", place, number));
            return static_cast<int>(number);
        } else {
            return value.get<T>();
        }
    }
    const Json& object_;
    std::string where_;
    std::set<std::string> known_;
};

template <std::size_t n>
std::array<double, n> numbers(const Json& value, const std::string& place) {
    if (!value.is_array() || value.size() != n)
        throw InputError(fmt::format("{}: {} is not a list of {} numbers", place, shown(value), n));
    return value.get<std::array<double, n>>();
}

View view_of(const Json& value, const std::string& place) {
    View view;
    if (value.is_string()) {
        try {
            return figures::parse_view(value.get<std::string>());
        } catch (const InputError& e) {
            throw InputError(place + ": " + e.what());
        }
    }
    Keys keys(value, place);
    keys.take("yaw_deg", view.yaw_deg);
    keys.take("pitch_deg", view.pitch_deg);
    keys.finish();
    return view;
}

Scalar scalar_of(const Json& value, const std::string& place) {
    Scalar scalar;
    Keys keys(value, place);
    if (!keys.take("attribute", scalar.attribute)) keys.fail("'attribute' is missing");
    keys.take("label", scalar.label);
    keys.take("range", scalar.range, numbers<2>);
    keys.take_parsed("colour_map", scalar.map, figures::parse_colour_map);
    keys.finish();
    return scalar;
}

MarkerFile marker_of(const Json& value, const std::string& place, const fs::path& folder) {
    MarkerFile marker;
    Keys keys(value, place);
    const auto path = [&](const Json& name, const std::string&) { return folder / name.get<std::string>(); };
    if (!keys.take("file", marker.file, path)) keys.fail("'file' is missing");
    keys.take("name", marker.name);
    keys.take_parsed("colour", marker.colour, figures::parse_colour);
    keys.take("radius_mm", marker.radius_mm);
    keys.take("numbered", marker.numbered);
    keys.finish();
    return marker;
}

PanelDescription panel_of(const Json& value, const std::string& place, const fs::path& folder, const View& usual_view) {
    PanelDescription panel;
    panel.view = usual_view;
    Keys keys(value, place);
    const auto path = [&](const Json& name, const std::string&) { return folder / name.get<std::string>(); };
    keys.take("mesh", panel.mesh, path);
    keys.take_parsed("unit", panel.unit, io::parse_length_unit);
    keys.take("texture", panel.texture, path);
    keys.take("textured", panel.textured);
    keys.take("landmarks", panel.landmarks, path);
    keys.take("controls", panel.controls, path);
    keys.take("arrows", panel.arrows, path);
    keys.take("markers", panel.markers, [&](const Json& list, const std::string& at) {
        if (!list.is_array()) throw InputError(at + ": is not a list");
        std::vector<MarkerFile> markers;
        for (std::size_t k = 0; k < list.size(); ++k)
            markers.push_back(marker_of(list[k], fmt::format("{}[{}]", at, k), folder));
        return markers;
    });
    keys.take("scalar", panel.scalar, scalar_of);
    keys.take("caption", panel.caption);
    keys.take("view", panel.view, view_of);
    keys.take("centre_mm", panel.centre_mm, [](const Json& list, const std::string& at) {
        const auto xyz = numbers<3>(list, at);
        return Point(xyz[0], xyz[1], xyz[2]);
    });
    keys.take("wire_frame", panel.wire_frame);
    keys.take("lit_as_skin", panel.lit_as_skin);
    keys.finish();
    return panel;
}

/// Neighbouring cells of a scanner's lattice joined to quads.
geometry::Mesh lattice_mesh(const geometry::RangeScan& scan) {
    // Scanner points lie about 1 mm apart; a longer edge joins the nose to the cheek behind it, or skin to a spike.
    constexpr double longest_edge_mm = 10.0;
    geometry::Mesh mesh;
    mesh.vertices_mm = scan.points_mm;
    mesh.texture_coordinates = scan.texture_coordinates;
    const auto index = [&](int row, int col) { return static_cast<std::uint32_t>(row * scan.cols + col); };
    for (int row = 0; row + 1 < scan.rows; ++row)
        for (int col = 0; col + 1 < scan.cols; ++col) {
            const std::array<std::uint32_t, 4> quad = {index(row, col), index(row, col + 1), index(row + 1, col + 1),
                                                       index(row + 1, col)};
            bool joined = true;
            for (std::size_t k = 0; k < 4; ++k) {
                // Written so that a NaN corner, whose distance is NaN, is not joined.
                const double edge_mm = (mesh.vertices_mm[quad[k]] - mesh.vertices_mm[quad[(k + 1) % 4]]).norm();
                joined = joined && edge_mm <= longest_edge_mm;
            }
            if (joined) mesh.faces.add(quad);
        }
    return mesh;
}

/// A texture that cannot be used is told: another image may take its place, or none be wanted.
io::MeshFile read_face(const fs::path& file, io::LengthUnit unit) {
    constexpr auto report = io::BadTexture::report;
    if (!database::is_bnt(file)) return io::read_mesh_file(file, unit, io::MeshParts::all, report);
    const auto scan = database::read_bnt_scan(file, unit, report);
    io::MeshFile face{.mesh = lattice_mesh(scan), .texture_file = scan.texture_file};
    if (!scan.texture_file.empty()) face.texture_files = {scan.texture_file};
    face.texture_error = scan.texture_error;
    return face;
}

std::vector<Point> positions(const fs::path& file, const geometry::Mesh& mesh, io::LengthUnit unit) {
    std::vector<Point> points_mm;
    const auto landmarks = io::read_landmarks(file, mesh.vertices_mm, unit);
    for (const auto& mark : landmarks.all()) points_mm.push_back(mark.position_mm);
    return points_mm;
}

// Each is drawn as a ball or an arrow of some hundred triangles.
constexpr std::size_t most_marks = 100'000;
constexpr std::uintmax_t most_table_bytes = std::uintmax_t{1} << 26;

Point point_at(const base::CsvReader& table, const std::array<std::size_t, 3>& columns, double scale) {
    return scale * Point(table.number(columns[0]), table.number(columns[1]), table.number(columns[2]));
}

void refuse_one_too_many(const base::CsvReader& table, std::size_t count) {
    if (count >= most_marks) table.fail(fmt::format("more than {} lines; draw fewer", most_marks));
}

/// The image that a mesh names; several become one, and the mesh's texture positions go along.
io::Image picture_of(const fs::path& file, const io::MeshFile& face, geometry::Mesh& mesh) {
    if (!face.texture_error.empty()) throw InputError(face.texture_error);
    if (face.texture_files.empty()) throw InputError(fmt::format("{}: names no texture; give one", file.string()));
    std::vector<std::optional<io::Image>> images;
    for (const auto& name : face.texture_files) {
        const auto image = file.parent_path() / name;
        database::refuse_hidden_file(image);
        images.emplace_back(io::read_image(image));
    }
    if (face.face_textures.empty() || mesh.texture_coordinates.empty()) return std::move(*images.front());
    return io::texture_atlas(mesh, images, face.face_textures);
}

Panel load_panel(const PanelDescription& description, std::vector<std::string>& remarks) {
    Panel panel;
    panel.caption = description.caption;
    panel.view = description.view;
    panel.scalar = description.scalar;
    panel.centre_mm = description.centre_mm;
    panel.wire_frame = description.wire_frame;
    panel.lit_as_skin = description.lit_as_skin;
    if (description.mesh.empty()) return panel;

    database::refuse_hidden_file(description.mesh);
    for (const auto* file : {&description.texture, &description.landmarks, &description.controls, &description.arrows})
        if (!file->empty()) database::refuse_hidden_file(*file);
    for (const auto& markers : description.markers) database::refuse_hidden_file(markers.file);
    auto face = read_face(description.mesh, description.unit);
    io::bring_to_lps(face, description.mesh.string());
    remarks.insert(remarks.end(), face.remarks.begin(), face.remarks.end());
    panel.mesh = std::move(face.mesh);
    if (panel.scalar) {
        try {
            (void)figures::scalar_values(panel.mesh, panel.scalar->attribute);
        } catch (const InputError& e) {  // drawn later, when nobody knows the file
            throw InputError(fmt::format("{}: {}", description.mesh.string(), e.what()));
        }
    }
    if (!description.texture.empty()) {
        panel.texture = io::read_image(description.texture);
    } else if (description.textured) {
        panel.texture = picture_of(description.mesh, face, panel.mesh);
    }
    if (!description.landmarks.empty())
        panel.markers.push_back({.name = "landmarks",
                                 .colour = landmark_colour,
                                 .positions_mm = positions(description.landmarks, panel.mesh, description.unit)});
    if (!description.controls.empty())
        for (auto& set : decode_controls(base::read_text(description.controls, most_table_bytes),
                                         description.controls.string(), description.unit))
            panel.markers.push_back(std::move(set));
    if (!description.arrows.empty())
        panel.arrows.push_back(decode_arrows(base::read_text(description.arrows, most_table_bytes),
                                             description.arrows.string(), description.unit));
    for (const auto& marker : description.markers)
        panel.markers.push_back({marker.name, marker.colour, marker.radius_mm,
                                 positions(marker.file, panel.mesh, description.unit), marker.numbered});
    return panel;
}

}  // namespace

std::vector<MarkerSet> decode_controls(std::string_view text, const std::string& name, io::LengthUnit unit) {
    base::CsvReader table(text, name);
    const double scale = io::millimetres_per(unit);
    const std::array<std::size_t, 3> xyz = {table.column("x"), table.column("y"), table.column("z")};
    const auto kind = table.column("kind");
    MarkerSet muscles{.name = "muscle controls", .colour = muscle_colour};
    MarkerSet wrinkles{.name = "wrinkle controls", .colour = wrinkle_colour};
    while (table.next()) {
        if (table.field(kind) != "muscle" && table.field(kind) != "wrinkle")
            table.fail(fmt::format("kind is {}; give muscle or wrinkle", base::in_quotes(table.field(kind))));
        refuse_one_too_many(table, muscles.positions_mm.size() + wrinkles.positions_mm.size());
        (table.field(kind) == "muscle" ? muscles : wrinkles).positions_mm.push_back(point_at(table, xyz, scale));
    }
    std::vector<MarkerSet> sets;
    for (auto* set : {&muscles, &wrinkles})
        if (!set->positions_mm.empty()) sets.push_back(std::move(*set));
    return sets;
}

ArrowSet decode_arrows(std::string_view text, const std::string& name, io::LengthUnit unit) {
    base::CsvReader table(text, name);
    const double scale = io::millimetres_per(unit);
    const std::array<std::size_t, 3> from = {table.column("x"), table.column("y"), table.column("z")};
    const std::array<std::size_t, 3> to = {table.column("to_x"), table.column("to_y"), table.column("to_z")};
    ArrowSet set{.name = "displacements"};
    while (table.next()) {
        refuse_one_too_many(table, set.arrows.size());
        set.arrows.push_back({point_at(table, from, scale), point_at(table, to, scale)});
    }
    return set;
}

FigureDescription decode_figure_description(const std::string& text, const std::string& name, const fs::path& folder) {
    const Json root = io::parse_json(text, name);
    FigureDescription description;
    Figure& page = description.page;
    Keys keys(root, name + ": ");
    int schema = 0;
    if (!keys.take("schema", schema)) keys.fail("'schema' is missing; give 1");
    if (schema != 1) keys.fail(fmt::format("schema is {}; this program knows 1", schema));
    keys.take("title", page.title);
    keys.take("columns", page.columns);
    keys.take("panel_width_px", page.panel_width_px);
    keys.take("panel_height_px", page.panel_height_px);
    keys.take("font_size_px", page.font_size_px);
    keys.take_parsed("background", page.background, figures::parse_colour);
    keys.take_parsed("framing", page.framing, figures::parse_framing);
    keys.take("height_mm", page.height_mm, [](const Json& value, const std::string&) { return value.get<double>(); });
    keys.take("scale_bar_mm", page.scale_bar_mm);
    keys.take("legend", page.legend);
    keys.take("supersampling", page.supersampling);
    keys.take("dots_per_inch", page.dots_per_inch);
    View view;
    keys.take("view", view, view_of);
    const bool has_panels = keys.take("panels", description.panels, [&](const Json& list, const std::string& place) {
        if (!list.is_array()) throw InputError(place + ": is not a list");
        std::vector<PanelDescription> panels;
        for (std::size_t p = 0; p < list.size(); ++p)
            panels.push_back(panel_of(list[p], fmt::format("{}[{}]", place, p), folder, view));
        return panels;
    });
    if (!has_panels) keys.fail("'panels' is missing");
    keys.finish();
    return description;
}

namespace {

using Ordered = nlohmann::ordered_json;

std::string colour_text(const Colour& colour) {
    return fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]);
}

/// Sets a key unless the value is what a reader takes without it.
template <class T>
void put(Ordered& json, const char* key, const T& value, const T& usual) {
    if (value != usual) json[key] = value;
}

void put_file(Ordered& json, const char* key, const fs::path& file, const fs::path& folder) {
    if (!file.empty()) json[key] = file.lexically_proximate(folder).generic_string();
}

void put_view(Ordered& json, const View& view) {
    if (view.yaw_deg != View{}.yaw_deg || view.pitch_deg != View{}.pitch_deg)
        json["view"] = {{"yaw_deg", view.yaw_deg}, {"pitch_deg", view.pitch_deg}};
}

Ordered json_of(const Scalar& scalar) {
    Ordered json = {{"attribute", scalar.attribute}};
    put(json, "label", scalar.label, std::string());
    if (scalar.range) json["range"] = *scalar.range;
    if (scalar.map != ColourMap::sequential) json["colour_map"] = figures::to_string(scalar.map);
    return json;
}

Ordered json_of(const PanelDescription& panel, const fs::path& folder) {
    Ordered json = Ordered::object();
    put_file(json, "mesh", panel.mesh, folder);
    if (panel.unit != io::LengthUnit::millimetre) json["unit"] = io::to_string(panel.unit);
    put_file(json, "texture", panel.texture, folder);
    put(json, "textured", panel.textured, false);
    put_file(json, "landmarks", panel.landmarks, folder);
    put_file(json, "controls", panel.controls, folder);
    put_file(json, "arrows", panel.arrows, folder);
    for (const auto& marker : panel.markers) {
        Ordered one = Ordered::object();
        put_file(one, "file", marker.file, folder);
        put(one, "name", marker.name, std::string());
        one["colour"] = colour_text(marker.colour);
        one["radius_mm"] = marker.radius_mm;
        put(one, "numbered", marker.numbered, false);
        json["markers"].push_back(std::move(one));
    }
    if (panel.scalar) json["scalar"] = json_of(*panel.scalar);
    put(json, "caption", panel.caption, std::string());
    put_view(json, panel.view);
    if (panel.centre_mm) json["centre_mm"] = {panel.centre_mm->x(), panel.centre_mm->y(), panel.centre_mm->z()};
    put(json, "wire_frame", panel.wire_frame, false);
    put(json, "lit_as_skin", panel.lit_as_skin, false);
    return json;
}

}  // namespace

std::string encode_figure_description(const FigureDescription& description, const fs::path& folder) {
    const auto& page = description.page;
    const Figure usual;
    Ordered json = {{"schema", 1}};
    put(json, "title", page.title, usual.title);
    put(json, "columns", page.columns, usual.columns);
    put(json, "panel_width_px", page.panel_width_px, usual.panel_width_px);
    put(json, "panel_height_px", page.panel_height_px, usual.panel_height_px);
    put(json, "font_size_px", page.font_size_px, usual.font_size_px);
    if (page.background != usual.background) json["background"] = colour_text(page.background);
    if (page.framing != usual.framing) json["framing"] = figures::to_string(page.framing);
    if (page.height_mm) json["height_mm"] = *page.height_mm;
    put(json, "scale_bar_mm", page.scale_bar_mm, usual.scale_bar_mm);
    put(json, "legend", page.legend, usual.legend);
    put(json, "supersampling", page.supersampling, usual.supersampling);
    put(json, "dots_per_inch", page.dots_per_inch, usual.dots_per_inch);
    json["panels"] = Ordered::array();
    for (const auto& panel : description.panels) json["panels"].push_back(json_of(panel, folder));
    return io::json_text(json);
}

void write_figure_description(const fs::path& file, const FigureDescription& description) {
    base::write_atomically(file, encode_figure_description(description, file.parent_path()));
}

FigureDescription read_figure_description(const fs::path& file) {
    return decode_figure_description(base::read_text(file, io::most_json_bytes), file.string(), file.parent_path());
}

Figure load_figure(const FigureDescription& description) {
    Figure figure = description.page;
    figure.panels.clear();
    for (const auto& panel : description.panels) figure.panels.push_back(load_panel(panel, figure.remarks));
    return figure;
}

}  // namespace mimik::report
