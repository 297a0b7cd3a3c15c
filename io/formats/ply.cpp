#include "io/formats/ply.h"

#include <cmath>
#include <functional>
#include <iterator>
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
using geometry::VertexAttribute;

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
        throw InputError(fmt::format("{}: element {}: the header promises {} rows but no property; its header is wrong",
                                     name, base::in_quotes(element.name), element.count));
    const auto row = std::max<std::size_t>(1, least_row_bytes(element, encoding));
    // The last line of a text file may lack its end.
    const auto available = bytes_left + (encoding == Encoding::ascii ? 1 : 0);
    if (element.count > 0 && element.count > available / row)
        throw InputError(
            fmt::format("{}: element {}: the header promises {} rows of at least {} bytes but only {} bytes are "
                        "left; the file is truncated or its header wrong",
                        name, base::in_quotes(element.name), element.count, row, bytes_left));
}

void read_ascii(Element& element, base::LineReader& lines) {
    std::vector<double> values;
    const auto number = [&](std::string_view& rest, const Property& p) {
        const auto word = base::next_word(rest);
        if (const auto value = base::parse_double(word)) return *value;
        if (word.empty())
            lines.fail(fmt::format("row of element {} ends before {}", base::in_quotes(element.name),
                                   base::in_quotes(p.name)));
        lines.fail(fmt::format("{} is {}, not a number", base::in_quotes(p.name), base::in_quotes(word)));
    };
    for (std::size_t row = 0; row < element.count; ++row) {
        if (!lines.next_not_blank())
            throw InputError(
                fmt::format("{}: element {} has {} of the {} rows that the header promises; the file is truncated",
                            lines.file_name(), base::in_quotes(element.name), row, element.count));
        std::string_view rest = lines.line();
        for (const auto& p : element.properties) {
            const double first = number(rest, p);
            if (!p.count_type) {
                if (p.column) p.column[row * p.column_stride] = first;
                continue;
            }
            // A value takes at least a blank and a digit.
            if (!(first >= 0 && first <= static_cast<double>(rest.size()) / 2 && first == std::floor(first)))
                lines.fail(fmt::format("list {} has count {}, but the line has {} characters left",
                                       base::in_quotes(p.name), first, rest.size()));
            values.clear();
            for (std::size_t k = 0; k < static_cast<std::size_t>(first); ++k) values.push_back(number(rest, p));
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
    double scale = 1.0;
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
    if (scalar("red") && scalar("green") && scalar("blue")) {
        const auto type = vertices.find("red")->type;
        colours.scale = type == Scalar::float32 || type == Scalar::float64 ? 255.0 : 1.0;
        constexpr std::array<std::string_view, 3> channels = {"red", "green", "blue"};
        for (std::size_t c = 0; c < 3; ++c) {
            colours.channels[c].resize(count);
            take(channels[c], colours.channels[c].data(), 1);
        }
    }
    std::set<std::string_view> known = {"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "alpha"};
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

void direct_faces(Element& element, std::size_t vertex_count, Mesh& mesh,
                  std::vector<TextureCoordinate>& corner_texture, TextureNumbers& textures, const std::string& name) {
    auto* indices = element.find("vertex_indices");
    if (!indices) indices = element.find("vertex_index");
    if (!indices || !indices->count_type) {
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
    indices->list = [&mesh, &textures, vertex_count, name](std::size_t row, std::span<const double> corners) {
        if (corners.size() < 3)
            throw InputError(
                fmt::format("{}: face {} has {} corners; a face needs at least 3", name, row, corners.size()));
        for (const double corner : corners) {
            if (!(corner >= 0 && corner < static_cast<double>(vertex_count) && corner == std::floor(corner)))
                throw InputError(fmt::format("{}: face {} names vertex {}; there are vertices 0 to {}", name, row,
                                             corner, static_cast<std::int64_t>(vertex_count) - 1));
            mesh.faces.corners.push_back(static_cast<std::uint32_t>(corner));
        }
        mesh.faces.first.push_back(static_cast<std::uint32_t>(mesh.faces.corners.size()));
        if (!textures.of_row.empty()) textures.row_of_face.push_back(row);
    };
    if (auto* texture = element.find("texcoord"); texture && texture->count_type)
        texture->list = [&corner_texture](std::size_t, std::span<const double> uv) {
            for (std::size_t k = 0; k + 1 < uv.size(); k += 2) corner_texture.emplace_back(uv[k], uv[k + 1]);
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
        const double number = numbers.of_row[row];
        const bool known = number >= 0 && number < static_cast<double>(count) && number == std::floor(number);
        file.face_textures.push_back(known ? static_cast<std::uint32_t>(number) : no_picture);
        without += known || number == -1 ? 0 : 1;
    }
    if (without > 0)
        file.remarks.push_back(
            fmt::format("{}: 'texnumber' of {} faces is that of no image (there are {}); they have no "
                        "picture",
                        name, without, count));
}

}  // namespace

MeshFile decode_ply(std::span<const std::uint8_t> bytes, const std::string& name) {
    base::LineReader lines(as_text(bytes), name);
    auto header = parse_header(lines);
    MeshFile file;
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
    std::vector<TextureCoordinate> corner_texture;
    TextureNumbers textures;
    std::size_t offset = lines.offset();
    for (auto& element : header.elements) {
        const bool ascii = header.encoding == Encoding::ascii;
        check_count(element, header.encoding, ascii ? lines.bytes_left() : bytes.size() - offset, name);
        if (element.name == "vertex") direct_vertices(element, file.mesh, colours, name);
        if (element.name == "face") direct_faces(element, vertex_count, file.mesh, corner_texture, textures, name);
        if (ascii)
            read_ascii(element, lines);
        else
            offset = read_binary(element, bytes, offset, header.encoding == Encoding::big, name);
    }

    take_textures(textures, std::move(header.texture_files), file, name);
    if (!colours.channels[0].empty()) {
        file.mesh.colours.resize(vertex_count);
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < vertex_count; ++i)
                file.mesh.colours[i][c] = colour_byte(colours.channels[c][i], colours.scale);
    }
    if (!corner_texture.empty()) {
        if (corner_texture.size() != file.mesh.faces.corners.size())
            throw InputError(
                fmt::format("{}: 'texcoord' gives {} texture positions for {} face corners; every corner needs one",
                            name, corner_texture.size(), file.mesh.faces.corners.size()));
        // Positions per corner are the finer ones where a file has both.
        file.mesh.texture_coordinates = std::move(corner_texture);
        file.mesh.faces.texture_corners.resize(file.mesh.faces.corners.size());
        for (std::uint32_t k = 0; k < file.mesh.faces.texture_corners.size(); ++k)
            file.mesh.faces.texture_corners[k] = k;
    }
    return file;
}

namespace {

std::vector<std::string> component_names(const VertexAttribute& attribute) {
    if (attribute.components == 1) return {attribute.name};
    std::vector<std::string> names;
    names.reserve(static_cast<std::size_t>(attribute.components));
    for (int c = 0; c < attribute.components; ++c)
        names.push_back(attribute.components <= 4 ? fmt::format("{}_{}", attribute.name, "xyzw"[c])
                                                  : fmt::format("{}_{}", attribute.name, c));
    return names;
}

void check_attribute_names(const Mesh& mesh) {
    std::set<std::string> taken = {"x",    "y",     "z",         "nx",        "ny", "nz", "red", "green",
                                   "blue", "alpha", "texture_u", "texture_v", "s",  "t",  "u",   "v"};
    for (const auto& attribute : mesh.attributes)
        for (const auto& component : component_names(attribute)) {
            if (component.empty() || component.find_first_of(" \t\r\n") != std::string::npos)
                throw InputError(fmt::format("attribute {} cannot be a PLY property: a name has no blanks",
                                             base::in_quotes(component)));
            if (!taken.insert(component).second)
                throw InputError(fmt::format("attribute {} cannot be a PLY property: that name is taken",
                                             base::in_quotes(component)));
        }
}

}  // namespace

void encode_ply(std::ostream& out, const Mesh& mesh, const MeshWriteOptions& options) {
    check_attribute_names(mesh);
    const bool corner_texture = !mesh.faces.texture_corners.empty();
    const bool vertex_texture = !mesh.texture_coordinates.empty() && !corner_texture;
    std::size_t longest = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) longest = std::max(longest, mesh.faces[f].size());
    // Lists are counted in bytes, as every reader expects, unless a polygon is too large for that.
    const bool wide = longest > 255, wide_texture = 2 * longest > 255;

    std::string text = fmt::format("ply\nformat {} 1.0\ncomment lengths in millimetres\n",
                                   options.binary ? "binary_little_endian" : "ascii");
    for (const auto& [key, value] : options.made_by) text += fmt::format("comment {}: {}\n", key, one_line(value));
    for (const auto& texture : options.texture_files) text += fmt::format("comment TextureFile {}\n", texture);
    text += fmt::format("element vertex {}\nproperty double x\nproperty double y\nproperty double z\n",
                        mesh.vertices_mm.size());
    if (!mesh.colours.empty()) text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    if (vertex_texture) text += "property double texture_u\nproperty double texture_v\n";
    for (const auto& attribute : mesh.attributes)
        for (const auto& component : component_names(attribute)) text += fmt::format("property double {}\n", component);
    if (mesh.faces.size() > 0) {
        text += fmt::format("element face {}\nproperty list {} int vertex_indices\n", mesh.faces.size(),
                            wide ? "int" : "uchar");
        if (corner_texture) text += fmt::format("property list {} double texcoord\n", wide_texture ? "int" : "uchar");
        if (!options.face_textures.empty()) text += "property int texnumber\n";
    }
    text += "end_header\n";

    const auto number = [&](double value, bool last = false) {
        if (options.binary)
            append(text, value);
        else
            fmt::format_to(std::back_inserter(text), "{:.17g}{}", value, last ? '\n' : ' ');
    };
    const auto integer = [&](std::size_t value, bool one_byte) {
        if (!options.binary)
            fmt::format_to(std::back_inserter(text), "{} ", value);
        else if (one_byte)
            append(text, static_cast<std::uint8_t>(value));
        else
            append(text, static_cast<std::int32_t>(value));
    };
    const auto number_of_texture = [&](std::uint32_t texture) {
        const auto value = texture == no_picture ? -1 : static_cast<std::int32_t>(texture);
        if (options.binary)
            append(text, value);
        else
            fmt::format_to(std::back_inserter(text), "{} ", value);
    };
    const auto end_row = [&] {
        if (!options.binary) text.back() = '\n';
    };
    for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) {
        for (const double coordinate : mesh.vertices_mm[i]) number(coordinate);
        if (!mesh.colours.empty())
            for (const auto channel : mesh.colours[i]) integer(channel, true);
        if (vertex_texture)
            for (const double coordinate : mesh.texture_coordinates[i]) number(coordinate);
        for (const auto& attribute : mesh.attributes)
            for (int c = 0; c < attribute.components; ++c)
                number(
                    attribute.values[i * static_cast<std::size_t>(attribute.components) + static_cast<std::size_t>(c)]);
        end_row();
    }
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto face = mesh.faces[f];
        integer(face.size(), !wide);
        for (const auto corner : face) integer(corner, false);
        if (corner_texture) {
            integer(2 * face.size(), !wide_texture);
            for (std::size_t k = 0; k < face.size(); ++k)
                for (const double coordinate :
                     mesh.texture_coordinates[mesh.faces.texture_corners[mesh.faces.first[f] + k]])
                    number(coordinate);
        }
        if (!options.face_textures.empty()) number_of_texture(options.face_textures[f]);
        end_row();
    }
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
}

}  // namespace mimik::io::formats
