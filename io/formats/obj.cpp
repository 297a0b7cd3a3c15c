#include "io/formats/obj.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "io/formats/bytes.h"

namespace mimik::io::formats {

using geometry::Mesh;

namespace {

constexpr std::uint32_t no_texture = std::numeric_limits<std::uint32_t>::max();
constexpr std::string_view material_name = "face", plain_material_name = "plain";
constexpr std::size_t most_materials = 10'000, most_material_files = 64;

/// "face", "face_2", ... as images are called.
std::string numbered_material(std::size_t texture) {
    return texture == 0 ? std::string(material_name) : fmt::format("{}_{}", material_name, texture + 1);
}
constexpr std::array<double, 3> no_colour = {-1, -1, -1};

class ObjReader {
public:
    ObjReader(std::span<const std::uint8_t> bytes, const std::string& name) : lines_(as_text(bytes), name) {}

    MeshFile read() {
        while (next_statement()) {
            const auto keyword = base::next_word(rest_);
            if (keyword.starts_with('#') && !file_.frame)
                file_.frame = frame_in_comment(lines_.line(), lines_.file_name());
            if (keyword == "v")
                read_vertex();
            else if (keyword == "vt")
                read_texture_coordinate();
            else if (keyword == "f")
                read_face();
            else if (keyword == "usemtl")
                use_material();
            else if (keyword == "mtllib")
                add_material_file();
        }
        finish_colours();
        finish_texture();
        if (file_.texture_files.empty()) file_.face_textures.clear();
        remark(small_faces_, "face has fewer than 3 corners; it is", "faces have fewer than 3 corners; they are",
               "left out");
        return std::move(file_);
    }

private:
    /// The next line, with those that a backslash at the end joins to it.
    bool next_statement() {
        if (!lines_.next()) return false;
        rest_ = lines_.line();
        if (!rest_.ends_with('\\')) return true;
        joined_.assign(rest_);
        while (joined_.ends_with('\\')) {
            joined_.back() = ' ';
            if (!lines_.next()) break;
            joined_ += lines_.line();
        }
        rest_ = joined_;
        return true;
    }

    void remark(std::size_t count, const char* one, const char* many, const char* done) {
        if (count > 0)
            file_.remarks.push_back(
                fmt::format("{}: {} {}", lines_.file_name(), base::counted(count, one, many), done));
    }

    /// NaN where it is written so: a point that was not measured, or what the surface does not need.
    double number_or_nan(std::string_view word, std::string_view what) {
        const auto value = base::parse_double_or_nan(word);
        if (!value)
            lines_.fail(fmt::format("{} is {}, not a number", what, word.empty() ? "missing" : base::in_quotes(word)));
        return *value;
    }

    void read_vertex() {
        std::array<double, 7> values{};
        std::size_t count = 0;
        for (auto word = base::next_word(rest_); !word.empty() && !word.starts_with('#');
             word = base::next_word(rest_)) {
            if (count == values.size()) lines_.fail("a vertex has more than 7 numbers (x y z w r g b)");
            constexpr std::array<std::string_view, 7> names = {"x",          "y",          "z",         "4th number",
                                                               "5th number", "6th number", "7th number"};
            values[count] = number_or_nan(word, names[count]);
            ++count;
        }
        if (count < 3 || count == 5)
            lines_.fail(fmt::format("a vertex has {}; it needs x y z, or x y z r g b", base::counted(count, "number")));
        file_.mesh.vertices_mm.emplace_back(values[0], values[1], values[2]);
        if (count >= 6) {
            const auto first = count == 6 ? 3U : 4U;
            colours_.resize(file_.mesh.vertices_mm.size() - 1, no_colour);
            colours_.push_back({values[first], values[first + 1], values[first + 2]});
        }
    }

    void read_texture_coordinate() {
        const double u = number_or_nan(base::next_word(rest_), "texture u");
        const auto word = base::next_word(rest_);
        file_.mesh.texture_coordinates.emplace_back(u, word.empty() ? 0.0 : number_or_nan(word, "texture v"));
    }

    std::uint32_t index(std::string_view word, std::size_t count, std::string_view what) {
        const auto value = base::parse_integer(word);
        if (!value) lines_.fail(fmt::format("{} index is {}, not a whole number", what, base::in_quotes(word)));
        const auto there_are = static_cast<std::int64_t>(count);
        if (*value >= 1 && *value <= there_are) return static_cast<std::uint32_t>(*value - 1);
        if (*value < 0 && *value >= -there_are) return static_cast<std::uint32_t>(there_are + *value);
        // A file may name vertices before it gives them; that is checked when all are known.
        if (*value > there_are && *value < no_texture) return static_cast<std::uint32_t>(*value - 1);
        lines_.fail(fmt::format("{} index is {}; so far there are {} (indices count from 1, or backward from -1)", what,
                                *value, there_are));
    }

    void use_material() {
        std::string material(base::trimmed(rest_));
        if (materials_.size() == most_materials && !materials_.contains(material))
            lines_.fail(fmt::format("more than {} materials", most_materials));
        const auto [entry, added] =
            materials_.try_emplace(material, static_cast<std::uint32_t>(file_.texture_files.size()));
        material_ = entry->second;
        if (added) file_.texture_files.push_back(std::move(material));
    }

    void add_material_file() {
        auto& files = file_.material_files;
        std::string written(base::trimmed(rest_));
        if (written.empty() || std::find(files.begin(), files.end(), written) != files.end()) return;
        if (files.size() == most_material_files)
            lines_.fail(fmt::format("more than {} material files", most_material_files));
        files.push_back(std::move(written));
    }

    void read_face() {
        auto& faces = file_.mesh.faces;
        std::size_t corners = 0;
        for (auto word = base::next_word(rest_); !word.empty() && !word.starts_with('#');
             word = base::next_word(rest_)) {
            const auto slash = word.find('/');
            const auto vertex = index(word.substr(0, slash), file_.mesh.vertices_mm.size(), "vertex");
            if (vertex >= largest_vertex_) {
                largest_vertex_ = vertex;
                largest_vertex_line_ = lines_.number();
            }
            auto texture = no_texture;
            if (slash != std::string_view::npos) {
                auto second = word.substr(slash + 1);
                second = second.substr(0, second.find('/'));
                if (!second.empty()) {
                    texture = index(second, file_.mesh.texture_coordinates.size(), "texture");
                    if (texture >= largest_texture_) {
                        largest_texture_ = texture;
                        largest_texture_line_ = lines_.number();
                    }
                }
            }
            faces.corners.push_back(vertex);
            faces.texture_corners.push_back(texture);
            ++corners;
        }
        if (corners < 3) {
            faces.corners.resize(faces.corners.size() - corners);
            faces.texture_corners.resize(faces.corners.size());
            ++small_faces_;
            return;
        }
        faces.first.push_back(static_cast<std::uint32_t>(faces.corners.size()));
        file_.face_textures.push_back(material_);
    }

    void finish_colours() {
        if (colours_.empty()) return;
        colours_.resize(file_.mesh.vertices_mm.size(), no_colour);
        // The usual writers give reals in [0, 1]; some give bytes.
        double largest = 0;
        for (const auto& c : colours_) largest = std::max({largest, c[0], c[1], c[2]});
        const double scale = colour_scale(largest, false);
        std::size_t without = 0;
        for (const auto& c : colours_) {
            without += c == no_colour ? 1 : 0;
            file_.mesh.colours.push_back(c == no_colour ? std::array<std::uint8_t, 3>{255, 255, 255}
                                                        : std::array{colour_byte(c[0], scale), colour_byte(c[1], scale),
                                                                     colour_byte(c[2], scale)});
        }
        remark(without, "vertex has no colour and others have; it becomes",
               "vertices have no colour and others have; they become", "white");
    }

    void finish_texture() {
        auto& mesh = file_.mesh;
        const auto check = [&](std::uint32_t largest, std::size_t line, std::size_t count, std::string_view what) {
            if (line > 0 && largest >= count)
                throw InputError(
                    fmt::format("{}: line {}: {} index is {}, but the file has {}; it is truncated or damaged",
                                lines_.file_name(), line, what, std::size_t{largest} + 1, count));
        };
        check(largest_vertex_, largest_vertex_line_, mesh.vertices_mm.size(), "vertex");
        auto& texture = mesh.faces.texture_corners;
        // Of the faces that are kept: one of two corners may have been the only one with a texture.
        bool any_texture = std::any_of(texture.begin(), texture.end(), [](auto t) { return t != no_texture; });
        if (any_texture && mesh.texture_coordinates.empty()) {
            file_.remarks.push_back(
                fmt::format("{}: faces name texture positions and there is no 'vt' line; the texture is left out",
                            lines_.file_name()));
            any_texture = false;
        }
        if (any_texture) check(largest_texture_, largest_texture_line_, mesh.texture_coordinates.size(), "texture");
        if (!any_texture) {
            texture.clear();
            if (mesh.texture_coordinates.size() != mesh.vertices_mm.size()) mesh.texture_coordinates.clear();
            return;
        }
        if (const auto bare = std::count(texture.begin(), texture.end(), no_texture); bare > 0) {
            remark(static_cast<std::size_t>(bare), "corner of a face has no texture position; it gets",
                   "corners of faces have no texture position; they get", "(0, 0)");
            std::replace(texture.begin(), texture.end(), no_texture,
                         static_cast<std::uint32_t>(mesh.texture_coordinates.size()));
            mesh.texture_coordinates.emplace_back(0.0, 0.0);
        }
        if (mesh.texture_coordinates.size() == mesh.vertices_mm.size() && texture == mesh.faces.corners)
            texture.clear();
    }

    base::LineReader lines_;
    std::string_view rest_;
    std::string joined_;
    MeshFile file_;
    std::vector<std::array<double, 3>> colours_;
    std::uint32_t largest_vertex_ = 0, largest_texture_ = 0;
    std::size_t largest_vertex_line_ = 0, largest_texture_line_ = 0;
    std::map<std::string, std::uint32_t> materials_;
    std::uint32_t material_ = no_picture;  // of the faces that follow
    std::size_t small_faces_ = 0;
};

}  // namespace

MeshFile decode_obj(std::span<const std::uint8_t> bytes, const std::string& name) {
    return ObjReader(bytes, name).read();
}

void encode_obj(std::ostream& out, const Mesh& mesh, const MeshWriteOptions& options,
                const std::string& material_file) {
    std::string text = "# lengths in millimetres\n";
    if (options.frame) text += fmt::format("# SPACE={}\n", to_string(*options.frame));
    const auto into = std::back_inserter(text);
    for (const auto& [key, value] : options.made_by) fmt::format_to(into, "# {}: {}\n", key, one_line(value));
    const auto& pictures = options.face_textures;
    if (!material_file.empty()) text += fmt::format("mtllib {}\n", material_file);
    if (!material_file.empty() && pictures.empty()) text += fmt::format("usemtl {}\n", material_name);
    for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) {
        const auto& p = mesh.vertices_mm[i];
        fmt::format_to(into, "v {:.17g} {:.17g} {:.17g}", p.x(), p.y(), p.z());
        if (!mesh.colours.empty()) {
            const auto& c = mesh.colours[i];
            fmt::format_to(into, " {:.6f} {:.6f} {:.6f}", c[0] / 255.0, c[1] / 255.0, c[2] / 255.0);
        }
        text += '\n';
    }
    for (const auto& t : mesh.texture_coordinates) fmt::format_to(into, "vt {:.17g} {:.17g}\n", t.x(), t.y());
    const auto& texture = mesh.faces.texture_corners.empty() ? mesh.faces.corners : mesh.faces.texture_corners;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        if (!pictures.empty() && (f == 0 || pictures[f] != pictures[f - 1]))
            fmt::format_to(
                into, "usemtl {}\n",
                pictures[f] == no_picture ? std::string(plain_material_name) : numbered_material(pictures[f]));
        text += 'f';
        for (auto k = mesh.faces.first[f]; k < mesh.faces.first[f + 1]; ++k) {
            if (mesh.texture_coordinates.empty())
                fmt::format_to(into, " {}", mesh.faces.corners[k] + 1);
            else
                fmt::format_to(into, " {}/{}", mesh.faces.corners[k] + 1, texture[k] + 1);
        }
        text += '\n';
    }
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
}

std::string encode_materials(const MeshWriteOptions& options) {
    std::string text;
    for (std::size_t k = 0; k < options.texture_files.size(); ++k)
        text += fmt::format("newmtl {}\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd {}\n", numbered_material(k),
                            options.texture_files[k]);
    if (std::find(options.face_textures.begin(), options.face_textures.end(), no_picture) !=
        options.face_textures.end())
        text += fmt::format("newmtl {}\nKd 0.8 0.62 0.53\nKs 0 0 0\nillum 1\n", plain_material_name);
    return text;
}

}  // namespace mimik::io::formats
