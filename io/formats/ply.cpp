#include "io/formats/ply.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "io/formats/bytes.h"

namespace mimik::io::formats {

using geometry::Mesh;
using geometry::TextureCoordinate;

namespace {

// A header beyond these is no mesh, and each entry costs memory before the data is looked at.
constexpr std::size_t most_elements = 100;
constexpr std::size_t most_properties = 1000;
constexpr std::size_t most_textures = 1000;

struct Property {
    std::string name;
    Scalar type = Scalar::float32;
    std::optional<Scalar> count_type;  // of a list

    // Where the values go; neither: they are skipped.
    double* column = nullptr;
    std::size_t column_stride = 0;
    std::function<void(std::size_t row, std::span<const double>)> list;
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;

    [[nodiscard]] Property* find(std::string_view property) {
        for (auto& p : properties)
            if (p.name == property) return &p;
        return nullptr;
    }
    [[nodiscard]] bool has_list() const {
        return std::any_of(properties.begin(), properties.end(),
                           [](const Property& p) { return p.count_type.has_value(); });
    }
};

enum class Encoding { ascii, little, big };

struct Header {
    Encoding encoding = Encoding::ascii;
    std::vector<Element> elements;
    std::vector<std::string> texture_files;
    std::optional<BodyFrame> frame;
};

std::optional<Scalar> parse_type(std::string_view word) {
    constexpr std::array<std::pair<std::string_view, Scalar>, 16> types = {{{"char", Scalar::int8},
                                                                            {"int8", Scalar::int8},
                                                                            {"uchar", Scalar::uint8},
                                                                            {"uint8", Scalar::uint8},
                                                                            {"short", Scalar::int16},
                                                                            {"int16", Scalar::int16},
                                                                            {"ushort", Scalar::uint16},
                                                                            {"uint16", Scalar::uint16},
                                                                            {"int", Scalar::int32},
                                                                            {"int32", Scalar::int32},
                                                                            {"uint", Scalar::uint32},
                                                                            {"uint32", Scalar::uint32},
                                                                            {"float", Scalar::float32},
                                                                            {"float32", Scalar::float32},
                                                                            {"double", Scalar::float64},
                                                                            {"float64", Scalar::float64}}};
    for (const auto& [name, type] : types)
        if (name == word) return type;
    return std::nullopt;
}

Scalar required_type(const base::LineReader& lines, std::string_view word) {
    if (const auto type = parse_type(word)) return *type;
    lines.fail(
        fmt::format("{} is no PLY number type (char uchar short ushort int uint float double)", base::in_quotes(word)));
}

void parse_property(const base::LineReader& lines, std::string_view rest, Header& header) {
    if (header.elements.empty()) lines.fail("a property stands before the first element; the header is damaged");
    auto& element = header.elements.back();
    Property property;
    auto word = base::next_word(rest);
    if (word == "list") {
        property.count_type = required_type(lines, base::next_word(rest));
        if (*property.count_type == Scalar::float32 || *property.count_type == Scalar::float64)
            lines.fail("the count of a list must be an integer type");
        word = base::next_word(rest);
    }
    property.type = required_type(lines, word);
    property.name = base::next_word(rest);
    if (property.name.empty()) lines.fail("the property has no name");
    if (element.find(property.name))
        lines.fail(fmt::format("element {} has two properties named {}", base::in_quotes(element.name),
                               base::in_quotes(property.name)));
    if (element.properties.size() == most_properties)
        lines.fail(fmt::format("more than {} properties", most_properties));
    element.properties.push_back(std::move(property));
}

Header parse_header(base::LineReader& lines) {
    if (!lines.next() || base::trimmed(lines.line()) != "ply")
        throw InputError(fmt::format("{}: does not start with 'ply'; it is not a PLY file", lines.file_name()));
    Header header;
    bool format_seen = false;
    while (lines.next()) {
        std::string_view rest = lines.line();
        const auto keyword = base::next_word(rest);
        if (keyword == "format") {
            const auto encoding = base::next_word(rest);
            if (encoding == "ascii")
                header.encoding = Encoding::ascii;
            else if (encoding == "binary_little_endian")
                header.encoding = Encoding::little;
            else if (encoding == "binary_big_endian")
                header.encoding = Encoding::big;
            else
                lines.fail(fmt::format("format is {}; it must be ascii, binary_little_endian or binary_big_endian",
                                       base::in_quotes(encoding)));
            format_seen = true;
        } else if (keyword == "comment" || keyword == "obj_info" || keyword.empty()) {
            if (!header.frame) header.frame = frame_in_comment(rest, lines.file_name());
            if (base::next_word(rest) != "TextureFile" || base::trimmed(rest).empty()) continue;
            if (header.texture_files.size() == most_textures)
                lines.fail(fmt::format("more than {} texture files", most_textures));
            header.texture_files.emplace_back(base::trimmed(rest));
        } else if (keyword == "element") {
            Element element;
            element.name = base::next_word(rest);
            const auto count = base::next_word(rest);
            const auto value = base::parse_integer(count);
            if (!value || *value < 0)
                lines.fail(fmt::format("the count of element {} is {}, not a whole number",
                                       base::in_quotes(element.name), base::in_quotes(count)));
            element.count = static_cast<std::size_t>(*value);
            if (header.elements.size() == most_elements)
                lines.fail(fmt::format("more than {} elements", most_elements));
            header.elements.push_back(std::move(element));
        } else if (keyword == "property") {
            parse_property(lines, rest, header);
        } else if (keyword == "end_header") {
            if (!format_seen) lines.fail("the header has no 'format' line");
            return header;
        } else {
            lines.fail(fmt::format("{} is no PLY header keyword; the header is damaged", base::in_quotes(keyword)));
        }
    }
    throw InputError(fmt::format("{}: the header has no 'end_header' line; the file is truncated", lines.file_name()));
}

/// The least number of bytes that one row can have.
std::size_t least_row_bytes(const Element& element, Encoding encoding) {
    std::size_t bytes = 0;
    for (const auto& p : element.properties)
        bytes += encoding == Encoding::ascii ? 2 : p.count_type ? size_of(*p.count_type) : size_of(p.type);
    return bytes;
}

void check_count(const Element& element, Encoding encoding, std::size_t bytes_left, const std::string& name) {
    // Rows without a byte could be any number.
    if (element.count > 0 && element.properties.empty())
        throw InputError(fmt::format("{}: element {}: the header promises {} but no property; its header is wrong",
                                     name, base::in_quotes(element.name), base::counted(element.count, "row")));
    const auto row = std::max<std::size_t>(1, least_row_bytes(element, encoding));
    // The last line of a text file may lack its end.
    const auto available = bytes_left + (encoding == Encoding::ascii ? 1 : 0);
    if (element.count > 0 && element.count > available / row)
        throw InputError(
            fmt::format("{}: element {}: the header promises {} of at least {} bytes but only {} bytes are left; the "
                        "file is truncated or its header wrong",
                        name, base::in_quotes(element.name), base::counted(element.count, "row"), row, bytes_left));
}

void read_ascii(Element& element, base::LineReader& lines) {
    std::vector<double> values;
    const auto number = [&](std::string_view& rest, const Property& p, bool used) {
        const auto word = base::next_word(rest);
        if (const auto value = base::parse_double_or_nan(word)) return *value;
        if (!used && !word.empty()) return 0.0;
        if (word.empty())
            lines.fail(fmt::format("row of element {} ends before {}", base::in_quotes(element.name),
                                   base::in_quotes(p.name)));
        lines.fail(fmt::format("{} is {}, not a number", base::in_quotes(p.name), base::in_quotes(word)));
    };
    for (std::size_t row = 0; row < element.count; ++row) {
        if (!lines.next_not_blank())
            throw InputError(fmt::format(
                "{}: element {} has {} of the {} that the header promises; the file is truncated", lines.file_name(),
                base::in_quotes(element.name), row, base::counted(element.count, "row")));
        std::string_view rest = lines.line();
        for (const auto& p : element.properties) {
            const double first = number(rest, p, p.column || p.count_type);
            if (!p.count_type) {
                if (p.column) p.column[row * p.column_stride] = first;
                continue;
            }
            // A value takes at least a blank and a digit.
            if (!(first >= 0 && first <= static_cast<double>(rest.size()) / 2 && first == std::floor(first)))
                lines.fail(fmt::format("list {} has count {}, but the line has {} left", base::in_quotes(p.name), first,
                                       base::counted(rest.size(), "character")));
            values.clear();
            for (std::size_t k = 0; k < static_cast<std::size_t>(first); ++k)
                values.push_back(number(rest, p, p.list != nullptr));
            if (p.list) p.list(row, values);
        }
        if (const auto extra = base::next_word(rest); !extra.empty())
            lines.fail(fmt::format("{} stands after the last property of element {}", base::in_quotes(extra),
                                   base::in_quotes(element.name)));
    }
}

/// Returns the offset behind the element.
std::size_t read_binary(Element& element, std::span<const std::uint8_t> bytes, std::size_t offset, bool swap,
                        const std::string& name) {
    if (!element.has_list()) {
        const auto stride = least_row_bytes(element, Encoding::little);
        std::size_t at = offset;
        for (const auto& p : element.properties) {
            if (p.column)
                load_column(p.type, swap, bytes.data() + at, stride, element.count, p.column, p.column_stride);
            at += size_of(p.type);
        }
        return offset + stride * element.count;
    }
    std::vector<double> values;
    const auto need = [&](std::size_t size, std::size_t row, const Property& p) {
        if (size > bytes.size() - offset)
            throw InputError(
                fmt::format("{}: byte {}: element {}, row {}, {}: {} bytes are needed but {} are left; the file "
                            "is truncated or a list count wrong",
                            name, offset, base::in_quotes(element.name), row, base::in_quotes(p.name), size,
                            bytes.size() - offset));
    };
    for (std::size_t row = 0; row < element.count; ++row) {
        for (const auto& p : element.properties) {
            const auto size = size_of(p.type);
            if (!p.count_type) {
                need(size, row, p);
                if (p.column)
                    load_column(p.type, swap, bytes.data() + offset, 0, 1, p.column + row * p.column_stride, 1);
                offset += size;
                continue;
            }
            need(size_of(*p.count_type), row, p);
            double count = 0;
            load_column(*p.count_type, swap, bytes.data() + offset, 0, 1, &count, 1);
            offset += size_of(*p.count_type);
            if (count < 0)
                throw InputError(fmt::format("{}: byte {}: element {}, row {}: list {} has the negative count {}", name,
                                             offset, base::in_quotes(element.name), row, base::in_quotes(p.name),
                                             count));
            const auto n = static_cast<std::size_t>(count);
            need(n * size, row, p);
            if (p.list) {
                values.resize(n);
                load_column(p.type, swap, bytes.data() + offset, size, n, values.data(), 1);
                p.list(row, values);
            }
            offset += n * size;
        }
    }
    return offset;
}

/// Joins name_x name_y name_z (or name_0 name_1 ...) that follow one another into one attribute.
struct AttributeGroup {
    std::string name;
    std::vector<Property*> parts;
};

std::vector<AttributeGroup> group_attributes(const std::vector<Property*>& loose) {
    constexpr std::array<std::string_view, 4> axes = {"_x", "_y", "_z", "_w"};
    const auto suffix = [&](std::size_t part, bool numbered) {
        return numbered ? fmt::format("_{}", part) : std::string(axes[part]);
    };
    std::vector<AttributeGroup> groups;
    for (std::size_t i = 0; i < loose.size();) {
        const std::string_view first = loose[i]->name;
        AttributeGroup group{loose[i]->name, {loose[i]}};
        for (const bool numbered : {false, true}) {
            if (!first.ends_with(suffix(0, numbered)) || first.size() == 2) continue;
            const auto stem = first.substr(0, first.size() - 2);
            std::size_t parts = 1;
            while (i + parts < loose.size() && (numbered || parts < axes.size()) &&
                   loose[i + parts]->name == std::string(stem) + suffix(parts, numbered))
                ++parts;
            if (parts > 1)
                group = {std::string(stem),
                         {loose.begin() + static_cast<std::ptrdiff_t>(i),
                          loose.begin() + static_cast<std::ptrdiff_t>(i + parts)}};
        }
        i += group.parts.size();
        groups.push_back(std::move(group));
    }
    return groups;
}

/// Colour channels while they are read.
struct ColourColumns {
    std::array<std::vector<double>, 3> channels;
    bool whole = true;  ///< integers

    void store(std::vector<std::array<std::uint8_t, 3>>& colours) const {
        if (channels[0].empty()) return;
        double largest = 0;
        for (const auto& channel : channels)
            for (const double value : channel) largest = std::max(largest, value);
        const double scale = colour_scale(largest, whole);
        colours.resize(channels[0].size());
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < colours.size(); ++i) colours[i][c] = colour_byte(channels[c][i], scale);
    }
};

/// Texture positions per corner while they are read: one list a row of the element 'face', perhaps an empty one.
struct CornerTexture {
    std::vector<TextureCoordinate> positions;
    std::vector<std::size_t> first_of_row = {0};
    std::vector<std::size_t> row_of_face;  ///< faces that are dropped have none

    /// A face with a list of another length than its corners has no picture: (0, 0). @return the number of such faces.
    std::size_t store(Mesh& mesh) const {
        if (positions.empty()) return 0;
        auto& faces = mesh.faces;
        std::vector<TextureCoordinate> used;
        used.reserve(faces.corners.size() + 1);
        faces.texture_corners.clear();
        std::size_t bare = 0;
        constexpr auto none = std::numeric_limits<std::uint32_t>::max();
        for (std::size_t f = 0; f < faces.size(); ++f) {
            const bool has_row = f < row_of_face.size() && row_of_face[f] + 1 < first_of_row.size();
            const auto first = has_row ? first_of_row[row_of_face[f]] : 0;
            const auto size = faces[f].size();
            const bool fits = has_row && first_of_row[row_of_face[f] + 1] - first == size;
            bare += fits ? 0 : 1;
            for (std::size_t k = 0; k < size; ++k) {
                faces.texture_corners.push_back(fits ? static_cast<std::uint32_t>(used.size()) : none);
                if (fits) used.push_back(positions[first + k]);
            }
        }
        if (bare > 0) {
            std::replace(faces.texture_corners.begin(), faces.texture_corners.end(), none,
                         static_cast<std::uint32_t>(used.size()));
            used.emplace_back(0.0, 0.0);
        }
        // Positions per corner are the finer ones where a file has both.
        mesh.texture_coordinates = std::move(used);
        return bare;
    }
};

void direct_vertices(Element& vertices, Mesh& mesh, ColourColumns& colours, const std::string& name) {
    const auto count = vertices.count;
    const auto take = [&](std::string_view property, double* column, std::size_t stride) {
        auto* p = vertices.find(property);
        if (!p || p->count_type) return false;
        p->column = column;
        p->column_stride = stride;
        return true;
    };
    mesh.vertices_mm.resize(count);
    for (int axis = 0; axis < 3; ++axis) {
        constexpr std::array<std::string_view, 3> axes = {"x", "y", "z"};
        auto* column = count > 0 ? mesh.vertices_mm.front().data() + axis : nullptr;
        if (!take(axes[static_cast<std::size_t>(axis)], column, 3))
            throw InputError(fmt::format("{}: element 'vertex' has no property '{}'; it needs x, y and z", name,
                                         axes[static_cast<std::size_t>(axis)]));
    }
    const auto scalar = [&](std::string_view property) {
        const auto* p = vertices.find(property);
        return p && !p->count_type;
    };
    std::set<std::string_view> known = {"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "alpha"};
    constexpr std::array<std::array<std::string_view, 3>, 3> colour_names = {
        {{"red", "green", "blue"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}, {"r", "g", "b"}}};
    for (const auto& channels : colour_names) {
        if (!std::all_of(channels.begin(), channels.end(), scalar)) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            const auto type = vertices.find(channels[c])->type;
            colours.whole = colours.whole && type != Scalar::float32 && type != Scalar::float64;
            colours.channels[c].resize(count);
            take(channels[c], colours.channels[c].data(), 1);
            known.insert(channels[c]);
        }
        break;
    }
    constexpr std::array<std::array<std::string_view, 2>, 3> texture_names = {
        {{"texture_u", "texture_v"}, {"s", "t"}, {"u", "v"}}};
    for (const auto& [u, v] : texture_names) {
        if (!scalar(u) || !scalar(v)) continue;
        mesh.texture_coordinates.resize(count);
        auto* column = count > 0 ? mesh.texture_coordinates.front().data() : nullptr;
        take(u, column, 2);
        take(v, column ? column + 1 : nullptr, 2);
        known.insert({u, v});
        break;
    }
    std::vector<Property*> loose;
    for (auto& p : vertices.properties)
        if (!p.count_type && !known.contains(p.name)) loose.push_back(&p);
    for (auto& group : group_attributes(loose)) {
        const auto components = group.parts.size();
        auto& attribute = mesh.attributes.emplace_back();
        attribute.name = std::move(group.name);
        attribute.components = static_cast<int>(components);
        attribute.values.resize(components * count);
        for (std::size_t c = 0; c < components; ++c) {
            group.parts[c]->column = count > 0 ? attribute.values.data() + c : nullptr;
            group.parts[c]->column_stride = components;
        }
    }
}

/// Which image each face has, while it is read.
struct TextureNumbers {
    std::vector<double> of_row;
    std::vector<std::size_t> row_of_face;
};

/// What the lists of corners were, beside faces.
struct FaceCounts {
    std::size_t too_small = 0;  ///< of 0 to 2 corners: dropped
};

Property* corner_list(Element& element) {
    for (const char* name : {"vertex_indices", "vertex_index"})
        if (auto* list = element.find(name); list && list->count_type) return list;
    return nullptr;
}

std::uint32_t checked_corner(double corner, std::size_t vertex_count, const char* what, std::size_t row,
                             const std::string& name) {
    if (!(corner >= 0 && corner < static_cast<double>(vertex_count) && corner == std::floor(corner)))
        throw InputError(fmt::format("{}: {} {} names vertex {}; there are vertices 0 to {}", name, what, row, corner,
                                     static_cast<std::int64_t>(vertex_count) - 1));
    return static_cast<std::uint32_t>(corner);
}

void direct_faces(Element& element, std::size_t vertex_count, Mesh& mesh, CornerTexture& corner_texture,
                  TextureNumbers& textures, FaceCounts& counts, const std::string& name) {
    auto* indices = corner_list(element);
    if (!indices) {
        if (element.count == 0) return;
        throw InputError(fmt::format("{}: element 'face' has no list 'vertex_indices'", name));
    }
    mesh.faces.first.reserve(element.count + 1);
    mesh.faces.corners.reserve(3 * element.count);
    if (auto* number = element.find("texnumber"); number && !number->count_type) {
        textures.of_row.resize(element.count);
        number->column = textures.of_row.data();
        number->column_stride = 1;
    }
    auto* texture = element.find("texcoord");
    if (texture && !texture->count_type) texture = nullptr;
    if (texture) corner_texture.row_of_face.resize(mesh.faces.size(), std::numeric_limits<std::size_t>::max() - 1);
    constexpr auto no_row = std::numeric_limits<std::size_t>::max() - 1;
    if (!textures.of_row.empty()) textures.row_of_face.resize(mesh.faces.size(), no_row);
    indices->list = [&mesh, &corner_texture, &textures, &counts, has_texture = texture != nullptr, vertex_count, name](
                        std::size_t row, std::span<const double> corners) {
        counts.too_small += corners.size() < 3 ? 1 : 0;
        if (corners.size() < 3) return;
        for (const double corner : corners)
            mesh.faces.corners.push_back(checked_corner(corner, vertex_count, "face", row, name));
        mesh.faces.first.push_back(static_cast<std::uint32_t>(mesh.faces.corners.size()));
        if (has_texture) corner_texture.row_of_face.push_back(row);
        if (!textures.of_row.empty()) textures.row_of_face.push_back(row);
    };
    if (texture)
        texture->list = [&corner_texture](std::size_t, std::span<const double> uv) {
            for (std::size_t k = 0; k + 1 < uv.size(); k += 2) corner_texture.positions.emplace_back(uv[k], uv[k + 1]);
            corner_texture.first_of_row.push_back(corner_texture.positions.size());
        };
}

/// Faces whose number is that of no image have no picture.
void take_textures(const TextureNumbers& numbers, std::vector<std::string> images, MeshFile& file,
                   const std::string& name) {
    file.texture_files = std::move(images);
    const auto count = file.texture_files.size();
    if (count == 1 && numbers.of_row.empty()) file.texture_file = file.texture_files.front();
    if (count > 1 && numbers.of_row.empty())
        file.remarks.push_back(
            fmt::format("{}: names {} images and no 'texnumber' says which face has which; the first is taken for all",
                        name, count));
    if (count == 0 || numbers.of_row.empty()) return;
    std::size_t without = 0;
    for (const auto row : numbers.row_of_face) {
        const double number = row < numbers.of_row.size() ? numbers.of_row[row] : -1;
        const bool known = number >= 0 && number < static_cast<double>(count) && number == std::floor(number);
        file.face_textures.push_back(known ? static_cast<std::uint32_t>(number) : no_picture);
        without += known || number == -1 ? 0 : 1;
    }
    file.face_textures.resize(file.mesh.faces.size(), no_picture);  // those of strips
    if (without > 0)
        file.remarks.push_back(
            fmt::format("{}: 'texnumber' of {} that of no image (there are {}), so there is no picture on {}", name,
                        base::counted(without, "face is", "faces is"), count, without == 1 ? "it" : "them"));
}

/// Stanford's way: strips of triangles one after another, each ended by -1. Triangles that repeat a corner only turn a
/// strip.
void direct_strips(Element& element, std::size_t vertex_count, Mesh& mesh, const std::string& name) {
    auto* indices = corner_list(element);
    if (!indices) {
        if (element.count == 0) return;
        throw InputError(fmt::format("{}: element 'tristrips' has no list 'vertex_indices'", name));
    }
    indices->list = [&mesh, vertex_count, name](std::size_t row, std::span<const double> corners) {
        std::vector<std::uint32_t> strip;
        for (const double corner : corners) {
            if (corner == -1 || corner == std::numeric_limits<std::uint32_t>::max()) {
                strip.clear();
                continue;
            }
            strip.push_back(checked_corner(corner, vertex_count, "strip", row, name));
            if (strip.size() < 3) continue;
            // Every other triangle of a strip runs the other way round.
            const bool odd = strip.size() % 2 == 0;
            const auto a = strip[strip.size() - 3], b = strip[strip.size() - 2], c = strip.back();
            if (a != b && b != c && c != a) mesh.faces.add(std::array{a, odd ? c : b, odd ? b : c});
        }
    };
}

/// What follows the last element, unless it is blank: a file that was overwritten by a shorter one, or a foreign end.
std::size_t trailing_bytes(std::string_view rest) {
    const auto last = rest.find_last_not_of(std::string_view(" \t\r\n\0\x1A", 6));
    return last == std::string_view::npos ? 0 : last + 1;
}

}  // namespace

MeshFile decode_ply(std::span<const std::uint8_t> bytes, const std::string& name) {
    base::LineReader lines(as_text(bytes), name);
    auto header = parse_header(lines);
    MeshFile file;
    file.frame = header.frame;
    std::size_t vertex_count = 0;
    bool vertices_seen = false;
    std::set<std::string> names;
    for (const auto& element : header.elements) {
        if (!names.insert(element.name).second)
            throw InputError(
                fmt::format("{}: the header has two elements named {}", name, base::in_quotes(element.name)));
        if (element.name != "vertex") continue;
        vertices_seen = true;
        vertex_count = element.count;
    }
    if (!vertices_seen) throw InputError(fmt::format("{}: the header has no element 'vertex'", name));

    ColourColumns colours;
    CornerTexture corner_texture;
    TextureNumbers textures;
    FaceCounts counts;
    std::size_t offset = lines.offset();
    for (auto& element : header.elements) {
        const bool ascii = header.encoding == Encoding::ascii;
        check_count(element, header.encoding, ascii ? lines.bytes_left() : bytes.size() - offset, name);
        if (element.name == "vertex") direct_vertices(element, file.mesh, colours, name);
        if (element.name == "face")
            direct_faces(element, vertex_count, file.mesh, corner_texture, textures, counts, name);
        if (element.name == "tristrips") direct_strips(element, vertex_count, file.mesh, name);
        if (ascii)
            read_ascii(element, lines);
        else
            offset = read_binary(element, bytes, offset, header.encoding == Encoding::big, name);
    }

    take_textures(textures, std::move(header.texture_files), file, name);
    colours.store(file.mesh.colours);
    const auto remark = [&](std::size_t count, const char* one, const char* many, const char* done) {
        if (count > 0) file.remarks.push_back(fmt::format("{}: {} {}", name, base::counted(count, one, many), done));
    };
    remark(corner_texture.store(file.mesh), "face has no texture position for each corner; it gets",
           "faces have no texture position for each corner; they get", "(0, 0)");
    remark(counts.too_small, "face has fewer than 3 corners; it is", "faces have fewer than 3 corners; they are",
           "left out");
    const bool ascii = header.encoding == Encoding::ascii;
    const auto rest = as_text(bytes).substr(ascii ? lines.offset() : offset);
    remark(trailing_bytes(rest), "byte behind the last element is", "bytes behind the last element are", "passed over");
    return file;
}

}  // namespace mimik::io::formats
