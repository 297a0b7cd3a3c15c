#include "io/formats/vtp.h"

#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <pugixml.hpp>
#include <zlib.h>

#include "base/errors.h"
#include "base/markup.h"
#include "base/text.h"
#include "io/formats/bytes.h"
#include "io/formats/xml.h"

namespace mimik::io::formats {

using geometry::Mesh;

namespace {

constexpr int most_components = 1000;
constexpr std::uint64_t best_deflate_ratio = 1032;
// Compressed arrays can hold 8000 times their bytes as numbers, and any number of them may name the same data.
constexpr std::uint64_t most_decoded_bytes = std::uint64_t{256} << 20;
// Whoever draws or warps the points takes ten times their memory: a small file shall not ask for gigabytes.
constexpr std::uint64_t free_point_bytes = std::uint64_t{64} << 20, point_bytes_per_byte = 16;
constexpr std::string_view texture_array = "TextureCoordinates";
constexpr std::string_view texture_corner_array = "TextureCorners";
constexpr std::string_view colour_array = "RGB";

std::optional<Scalar> parse_type(std::string_view word) {
    constexpr std::array<std::pair<std::string_view, Scalar>, 10> types = {{{"Int8", Scalar::int8},
                                                                            {"UInt8", Scalar::uint8},
                                                                            {"Int16", Scalar::int16},
                                                                            {"UInt16", Scalar::uint16},
                                                                            {"Int32", Scalar::int32},
                                                                            {"UInt32", Scalar::uint32},
                                                                            {"Int64", Scalar::int64},
                                                                            {"UInt64", Scalar::uint64},
                                                                            {"Float32", Scalar::float32},
                                                                            {"Float64", Scalar::float64}}};
    for (const auto& [name, type] : types)
        if (name == word) return type;
    return std::nullopt;
}

int base64_value(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+') return 62;
    if (c == '/') return 63;
    return -1;
}

/// At most `wanted` bytes; `text` is moved behind what was used (whole groups of four). Stops at padding.
std::vector<std::uint8_t> decode_base64(std::string_view& text, std::size_t wanted) {
    std::vector<std::uint8_t> out;
    out.reserve(std::min(wanted, text.size() / 4 * 3 + 3) + 3);
    std::size_t at = 0;
    while (out.size() < wanted) {
        std::uint32_t group = 0;
        int digits = 0, padding = 0;
        while (digits + padding < 4 && at < text.size()) {
            const char c = text[at++];
            if (c == '=') {
                group <<= 6U;
                ++padding;
            } else if (const int value = base64_value(c); value >= 0) {
                group = group << 6U | static_cast<std::uint32_t>(value);
                ++digits;
            }
        }
        if (digits + padding < 4) break;
        for (int k = 0; k < 3 - padding; ++k)
            out.push_back(static_cast<std::uint8_t>(group >> (16U - 8U * static_cast<unsigned>(k))));
        if (padding > 0) break;
    }
    text.remove_prefix(at);
    if (out.size() > wanted) out.resize(wanted);
    return out;
}

struct Values {
    std::string name;
    Scalar type = Scalar::float64;
    int components = 1;
    std::vector<double> values;
    [[nodiscard]] std::size_t tuples() const { return values.size() / static_cast<std::size_t>(components); }
};

class VtpReader {
public:
    VtpReader(std::span<const std::uint8_t> bytes, const std::string& name, MeshParts parts)
        : name_(name),
          parts_(parts),
          size_(bytes.size()),
          // Bytes that are not compressed become numbers of at most eight times their size.
          most_memory_(std::max<std::uint64_t>(most_decoded_bytes, sizeof(double) * bytes.size())),
          memory_left_(most_memory_) {
        const auto text = as_text(bytes);
        // Raw appended data is not XML: the document is read without it.
        const auto begin = text.find("<AppendedData");
        if (begin == std::string_view::npos) {
            document_ = parse_xml(text, name_);
            return;
        }
        const auto tag_end = text.find('>', begin);
        const auto mark = tag_end == std::string_view::npos ? tag_end : text.find('_', tag_end);
        if (mark == std::string_view::npos) fail("AppendedData has no data mark '_'; the file is truncated");
        appended_is_raw_ = text.substr(begin, tag_end - begin).find("raw") != std::string_view::npos;
        appended_ = bytes.subspan(mark + 1);
        document_ = parse_xml(std::string(text.substr(0, begin)) + "</VTKFile>", name_);
    }

    MeshFile read() {
        const auto root = document_->child("VTKFile");
        if (!root) fail("has no element VTKFile; it is not a VTK XML file");
        if (const std::string_view type = root.attribute("type").value(); type != "PolyData")
            fail(fmt::format("VTKFile type is {}; only PolyData is read", base::in_quotes(type)));
        swap_ = std::string_view(root.attribute("byte_order").value()) == "BigEndian";
        wide_header_ = std::string_view(root.attribute("header_type").value()) == "UInt64";
        if (const std::string_view compressor = root.attribute("compressor").value(); !compressor.empty()) {
            if (compressor != "vtkZLibDataCompressor")
                fail(fmt::format("compressor is {}; save without compression or with zlib",
                                 base::in_quotes(compressor)));
            compressed_ = true;
        }
        const auto data = root.child("PolyData");
        const auto piece = data.child("Piece");
        if (!piece) fail("PolyData has no Piece");
        if (piece.next_sibling("Piece")) fail("PolyData has more than one Piece; merge them into one");

        MeshFile file;
        auto& mesh = file.mesh;
        const std::string_view stated = piece.attribute("NumberOfPoints").value();
        const auto point_count = base::parse_integer(stated);
        if (!point_count || *point_count < 0)
            fail(fmt::format("NumberOfPoints is {}; it must be a whole number", base::in_quotes(stated)));
        if (static_cast<std::uint64_t>(*point_count) >
            (free_point_bytes + point_bytes_per_byte * size_) / sizeof(geometry::Point))
            fail(
                fmt::format("NumberOfPoints is {}, more than {} bytes should hold; thin the points out, or save them "
                            "without compression",
                            *point_count, size_));
        const auto points = read_array(piece.child("Points").child("DataArray"), "Points", *point_count);
        if (points.components != 3) fail(fmt::format("Points have {} components, not 3", points.components));
        for (std::size_t i = 0; i < points.tuples(); ++i)
            mesh.vertices_mm.emplace_back(points.values[3 * i], points.values[3 * i + 1], points.values[3 * i + 2]);
        read_frame(data.child("FieldData"), file);
        read_polygons(piece.child("Polys"), mesh);
        read_strips(piece.child("Strips"), mesh);
        read_point_data(piece.child("PointData"), mesh);
        read_corner_texture(data.child("FieldData"), file);
        if (small_cells_ > 0)
            file.remarks.push_back(fmt::format("{}: {} left out", name_,
                                               base::counted(small_cells_, "face has fewer than 3 corners; it is",
                                                             "faces have fewer than 3 corners; they are")));
        return file;
    }

private:
    [[noreturn]] void fail(const std::string& what) const { throw InputError(fmt::format("{}: {}", name_, what)); }

    std::uint64_t header_word(std::span<const std::uint8_t> bytes, std::size_t index) const {
        return wide_header_ ? load<std::uint64_t>(bytes.data() + 8 * index, swap_)
                            : load<std::uint32_t>(bytes.data() + 4 * index, swap_);
    }

    /// Called before the memory of an array is taken: does its size fit, and all arrays together into their limit?
    void admit(const Values& array, const std::string& what, std::uint64_t values, std::optional<std::int64_t> points) {
        const auto components = static_cast<std::uint64_t>(array.components);
        if (values % components != 0)
            fail(fmt::format("array {} has {}, not a multiple of its {} components", base::in_quotes(what),
                             base::counted(values, "value"), components));
        if (points && values / components != static_cast<std::uint64_t>(*points))
            fail(fmt::format("array {} has {}, but NumberOfPoints is {}", base::in_quotes(what),
                             base::counted(values / components, "entry", "entries"), *points));
        if (values > memory_left_ / sizeof(double))
            fail(
                fmt::format("array {} has {} values; with it all arrays take more than {} MB of memory; leave arrays "
                            "out or thin the mesh out",
                            base::in_quotes(what), values, most_memory_ >> 20));
        memory_left_ -= sizeof(double) * values;
    }

    /// The bytes of an array: a header with sizes, then the data, plain or in compressed blocks. A source gives the
    /// next n bytes or fewer; base64 starts afresh after the header of compressed data, as VTK writes it. `admit_bytes`
    /// is asked before memory is taken.
    template <class Admit>
    std::vector<std::uint8_t> block_bytes(std::span<const std::uint8_t> raw, std::string_view base64, bool is_raw,
                                          const std::string& array, Admit admit_bytes) const {
        const std::size_t word = wide_header_ ? 8 : 4;
        const auto truncated = [&] { fail(fmt::format("array {} is truncated", base::in_quotes(array))); };
        const auto take = [&](std::uint64_t size) {
            if (!is_raw) {
                auto out = decode_base64(base64, static_cast<std::size_t>(size));
                if (out.size() < size) truncated();
                return out;
            }
            if (size > raw.size()) truncated();
            std::vector<std::uint8_t> out(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size));
            raw = raw.subspan(static_cast<std::size_t>(size));
            return out;
        };
        const auto available = [&] { return is_raw ? raw.size() : base64.size() / 4 * 3 + 3; };
        if (!compressed_) {
            if (is_raw) {
                const auto size = header_word(take(word), 0);
                if (size > raw.size()) truncated();
                admit_bytes(size);
                return take(size);
            }
            // Length and data are one base64 stream.
            auto peek = base64;
            const auto head = decode_base64(peek, word);
            if (head.size() < word) truncated();
            const auto size = header_word(head, 0);
            if (size > available()) truncated();
            admit_bytes(size);
            auto all = take(word + size);
            all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(word));
            return all;
        }
        // Block count, block size, size of a last partial block, compressed size of every block.
        auto peek = base64;
        const auto head =
            is_raw ? std::vector<std::uint8_t>(
                         raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(std::min(raw.size(), 3 * word)))
                   : decode_base64(peek, 3 * word);
        if (head.size() < word) truncated();
        const auto blocks = header_word(head, 0);
        if (blocks == 0) {
            admit_bytes(0);
            return {};
        }
        if (head.size() < 3 * word || blocks > available() / word) truncated();
        const auto block_size = header_word(head, 1), last_size = header_word(head, 2);
        const auto sizes = take((3 + blocks) * word);
        const auto size_of_block = [&](std::uint64_t b) {
            return b + 1 == blocks && last_size > 0 ? last_size : block_size;
        };
        std::uint64_t packed_total = 0, total = 0;
        for (std::uint64_t b = 0; b < blocks; ++b) {
            const auto packed_size = header_word(sizes, 3 + b);
            if (packed_size > available() || packed_total + packed_size > available()) truncated();
            packed_total += packed_size;
            if (size_of_block(b) > best_deflate_ratio * packed_size + 64)
                fail(fmt::format("array {}: {} compressed bytes cannot hold {}; the file is damaged",
                                 base::in_quotes(array), packed_size, size_of_block(b)));
            total += size_of_block(b);
        }
        admit_bytes(total);
        const auto packed = take(packed_total);
        std::vector<std::uint8_t> out(total);
        std::size_t from = 0, to = 0;
        for (std::uint64_t b = 0; b < blocks; ++b) {
            const auto packed_size = static_cast<std::size_t>(header_word(sizes, 3 + b));
            const auto size = static_cast<std::size_t>(size_of_block(b));
            auto written = static_cast<uLongf>(size);
            if (uncompress(out.data() + to, &written, packed.data() + from, static_cast<uLong>(packed_size)) != Z_OK ||
                written != size)
                fail(fmt::format("array {}: block {} of its compressed data is damaged", base::in_quotes(array), b));
            from += packed_size;
            to += size;
        }
        return out;
    }

    /// With `points` the array must have one entry for each.
    Values read_array(const pugi::xml_node& node, const std::string& what, std::optional<std::int64_t> points = {}) {
        if (!node) fail(fmt::format("array {} is missing", base::in_quotes(what)));
        Values array;
        array.name = node.attribute("Name").value();
        auto type = parse_type(node.attribute("type").value());
        if (std::string_view(node.attribute("type").value()) == "String") type = Scalar::uint8;
        if (!type)
            fail(fmt::format("array {}: type is {}, which is not read", base::in_quotes(what),
                             base::in_quotes(node.attribute("type").value())));
        array.type = *type;
        if (const auto components = node.attribute("NumberOfComponents")) {
            const auto value = base::parse_integer(components.value());
            if (!value || *value < 1 || *value > most_components)
                fail(fmt::format("array {}: NumberOfComponents is {}; it must be 1 to {}", base::in_quotes(what),
                                 base::in_quotes(components.value()), most_components));
            array.components = static_cast<int>(*value);
        }
        const std::string_view format = node.attribute("format").value();
        if (format == "ascii" || format.empty()) {
            base::LineReader lines(node.text().get(), name_);
            while (lines.next()) {
                std::string_view rest = lines.line();
                for (auto text = base::next_word(rest); !text.empty(); text = base::next_word(rest)) {
                    const auto value = base::parse_double_or_nan(text);
                    if (!value)
                        fail(fmt::format("array {}: value {} is {}, not a number", base::in_quotes(what),
                                         array.values.size(), base::in_quotes(text)));
                    array.values.push_back(*value);
                }
            }
            admit(array, what, array.values.size(), points);
        } else {
            std::vector<std::uint8_t> bytes;
            const auto size = size_of(array.type);
            const auto admit_bytes = [&](std::uint64_t count) {
                if (count % size != 0)
                    fail(fmt::format("array {} has {} bytes, not a multiple of the {} of a value; the file is damaged",
                                     base::in_quotes(what), count, size));
                admit(array, what, count / size, points);
            };
            if (format == "binary") {
                bytes = block_bytes({}, node.text().get(), false, what, admit_bytes);
            } else if (format == "appended") {
                const auto offset = base::parse_integer(node.attribute("offset").value());
                if (!offset || *offset < 0 || static_cast<std::uint64_t>(*offset) >= appended_.size())
                    fail(fmt::format("array {}: offset is {}, outside the {} bytes of appended data",
                                     base::in_quotes(what), base::in_quotes(node.attribute("offset").value()),
                                     appended_.size()));
                const auto data = appended_.subspan(static_cast<std::size_t>(*offset));
                const auto text = as_text(data);
                bytes = block_bytes(data, text.substr(0, text.find('<')), appended_is_raw_, what, admit_bytes);
            } else {
                fail(fmt::format("array {}: format is {}; it must be ascii, binary or appended", base::in_quotes(what),
                                 base::in_quotes(format)));
            }
            array.values.resize(bytes.size() / size);
            load_column(array.type, swap_, bytes.data(), size, array.values.size(), array.values.data(), 1);
        }
        return array;
    }

    Values cell_array(const pugi::xml_node& cells, const char* array) {
        for (const auto node : cells.children("DataArray"))
            if (std::string_view(node.attribute("Name").value()) == array)
                return read_array(node, fmt::format("{}/{}", cells.name(), array));
        return {};
    }

    /// Cells as lists of checked vertex indices.
    template <class Add>
    void for_each_cell(const pugi::xml_node& cells, std::size_t vertex_count, Add add) {
        const auto corners = cell_array(cells, "connectivity"), ends = cell_array(cells, "offsets");
        std::vector<std::uint32_t> cell;
        std::size_t at = 0;
        for (std::size_t c = 0; c < ends.values.size(); ++c) {
            const double end = ends.values[c];
            if (!(end >= static_cast<double>(at) && end <= static_cast<double>(corners.values.size())))
                fail(fmt::format("{}: offset of cell {} is {}; there are {} corners", cells.name(), c, end,
                                 corners.values.size()));
            cell.clear();
            for (; at < static_cast<std::size_t>(end); ++at) {
                const double corner = corners.values[at];
                if (!(corner >= 0 && corner < static_cast<double>(vertex_count) && corner == std::floor(corner)))
                    fail(fmt::format("{}: cell {} names vertex {}; there are vertices 0 to {}", cells.name(), c, corner,
                                     static_cast<std::int64_t>(vertex_count) - 1));
                cell.push_back(static_cast<std::uint32_t>(corner));
            }
            if (cell.size() < 3)
                ++small_cells_;
            else
                add(cell);
        }
    }

    /// Slicer's field data "SPACE": a text, as the codes of its bytes.
    void read_frame(const pugi::xml_node& data, MeshFile& file) {
        for (const auto node : data.children()) {
            if (!base::equal_ignoring_case(node.attribute("Name").value(), "SPACE")) continue;
            if (std::string_view(node.attribute("type").value()) != "String") continue;
            std::string text = "SPACE=";
            const auto codes = read_array(node, "SPACE");
            for (const double code : codes.values)
                if (code > 0 && code < 128) text += static_cast<char>(code);
            file.frame = frame_in_comment(text, name_);
        }
    }

    void read_polygons(const pugi::xml_node& cells, Mesh& mesh) {
        for_each_cell(cells, mesh.vertices_mm.size(), [&](const auto& cell) { mesh.faces.add(cell); });
    }

    void read_strips(const pugi::xml_node& cells, Mesh& mesh) {
        for_each_cell(cells, mesh.vertices_mm.size(), [&](const auto& strip) {
            for (std::size_t k = 2; k < strip.size(); ++k) {
                const bool odd = k % 2 == 1;  // every other triangle of a strip runs the other way round
                mesh.faces.add(std::array{strip[k - 2], strip[odd ? k : k - 1], strip[odd ? k - 1 : k]});
            }
        });
    }

    void read_point_data(const pugi::xml_node& data, Mesh& mesh) {
        const auto n = mesh.vertices_mm.size();
        const std::string_view texture_name = data.attribute("TCoords").value(),
                               normals_name = data.attribute("Normals").value();
        for (const auto node : data.children("DataArray")) {
            const std::string_view array_name = node.attribute("Name").value();
            if (array_name == "Normals" || (!normals_name.empty() && array_name == normals_name)) continue;
            if (!parse_type(node.attribute("type").value())) continue;  // text, bits: no numbers per vertex
            const bool texture = array_name == texture_array || (!texture_name.empty() && array_name == texture_name);
            const bool colour =
                base::equal_ignoring_case(array_name, colour_array) || base::equal_ignoring_case(array_name, "RGBA");
            if (parts_ == MeshParts::without_attributes && !texture && !colour) continue;
            auto array = read_array(node, std::string(array_name), static_cast<std::int64_t>(n));
            if (texture && array.components >= 2 && mesh.texture_coordinates.empty()) {
                for (std::size_t i = 0; i < n; ++i) {
                    const auto at = i * static_cast<std::size_t>(array.components);
                    mesh.texture_coordinates.emplace_back(array.values[at], array.values[at + 1]);
                }
            } else if (colour && (array.components == 3 || array.components == 4) && mesh.colours.empty()) {
                const auto step = static_cast<std::size_t>(array.components);
                double largest = 0;
                for (std::size_t k = 0; k < array.values.size(); ++k)
                    if (k % step < 3) largest = std::max(largest, array.values[k]);
                const bool whole = array.type != Scalar::float32 && array.type != Scalar::float64;
                const double scale = colour_scale(largest, whole);
                for (std::size_t i = 0; i < n; ++i)
                    mesh.colours.push_back({colour_byte(array.values[step * i], scale),
                                            colour_byte(array.values[step * i + 1], scale),
                                            colour_byte(array.values[step * i + 2], scale)});
            } else {
                mesh.attributes.push_back({std::move(array.name), array.components, std::move(array.values)});
            }
        }
    }

    void read_corner_texture(const pugi::xml_node& data, MeshFile& file) {
        auto& mesh = file.mesh;
        const auto positions = cell_array(data, texture_array.data()),
                   corners = cell_array(data, texture_corner_array.data());
        if (positions.values.empty() || corners.values.empty()) return;
        if (small_cells_ > 0) {
            file.remarks.push_back(fmt::format(
                "{}: texture positions per corner are left out, since faces of fewer than 3 corners are", name_));
            return;
        }
        if (positions.components != 2 || corners.values.size() != mesh.faces.corners.size())
            fail(fmt::format("FieldData: {} texture corners of {} components for {} face corners",
                             corners.values.size(), positions.components, mesh.faces.corners.size()));
        mesh.texture_coordinates.clear();
        for (std::size_t i = 0; i < positions.tuples(); ++i)
            mesh.texture_coordinates.emplace_back(positions.values[2 * i], positions.values[2 * i + 1]);
        for (const double corner : corners.values) {
            if (!(corner >= 0 && corner < static_cast<double>(positions.tuples()) && corner == std::floor(corner)))
                fail(fmt::format("FieldData: a texture corner is {}; there are {} positions", corner,
                                 positions.tuples()));
            mesh.faces.texture_corners.push_back(static_cast<std::uint32_t>(corner));
        }
    }

    std::string name_;
    MeshParts parts_;
    std::uint64_t size_;         ///< of the file in bytes
    std::uint64_t most_memory_;  ///< that all arrays may take
    std::uint64_t memory_left_;  ///< for the arrays still to be read
    std::shared_ptr<const pugi::xml_document> document_;
    std::span<const std::uint8_t> appended_;
    std::size_t small_cells_ = 0;
    bool appended_is_raw_ = false, swap_ = false, wide_header_ = false, compressed_ = false;
};

/// A text as VTK has it in a file: the codes of its bytes, closed by a zero.
std::string string_array(const std::string& name, const std::string& text) {
    auto xml = fmt::format(
        "<Array type=\"String\" Name=\"{}\" NumberOfComponents=\"1\" NumberOfTuples=\"1\" "
        "format=\"ascii\">\n",
        base::markup_text(name));
    for (const char c : text) xml += fmt::format("{} ", static_cast<int>(static_cast<unsigned char>(c)));
    return xml + "0\n</Array>\n";
}

/// Builds the XML and the appended bytes side by side.
class Appender {
public:
    template <class T, class Range>
    void add(std::string_view name, std::string_view type, int components, const Range& values,
             std::optional<std::size_t> tuples = {}) {
        xml += fmt::format(
            "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{} format=\"appended\" offset=\"{}\"/>\n",
            type, base::markup_text(std::string(name)), components,
            tuples ? fmt::format(" NumberOfTuples=\"{}\"", *tuples) : std::string(), data.size());
        std::string bytes;
        bytes.reserve(values.size() * sizeof(T));
        for (const auto& value : values) append(bytes, static_cast<T>(value));
        append(data, static_cast<std::uint64_t>(bytes.size()));
        data += bytes;
    }
    std::string xml, data;
};

template <class Coordinates>
std::vector<double> flattened(const Coordinates& coordinates) {
    std::vector<double> values;
    for (const auto& p : coordinates) values.insert(values.end(), p.data(), p.data() + p.size());
    return values;
}

}  // namespace

MeshFile decode_vtp(std::span<const std::uint8_t> bytes, const std::string& name, MeshParts parts) {
    return VtpReader(bytes, name, parts).read();
}

std::vector<std::string> vtp_attribute_names(const Mesh& mesh) {
    std::set<std::string> taken = {std::string(texture_array), std::string(colour_array), "RGBA", "Normals"};
    std::vector<std::string> names;
    for (const auto& attribute : mesh.attributes) {
        auto stem = attribute.name;
        for (char& c : stem)
            if (static_cast<unsigned char>(c) < 0x20) c = ' ';
        if (stem.empty()) stem = "unnamed";
        auto name = stem;
        for (int number = 2; !taken.insert(name).second; ++number) name = fmt::format("{}_{}", stem, number);
        names.push_back(std::move(name));
    }
    return names;
}

void encode_vtp(std::ostream& out, const Mesh& mesh, const MadeBy& made_by, std::optional<BodyFrame> frame) {
    const auto n = mesh.vertices_mm.size();
    const bool corner_texture = !mesh.faces.texture_corners.empty();
    const bool vertex_texture = !mesh.texture_coordinates.empty() && !corner_texture;
    const bool cloud = mesh.faces.size() == 0;  // drawn as dots: one cell that holds every point
    Appender arrays;
    auto& xml = arrays.xml;
    xml =
        "<?xml version=\"1.0\"?>\n<!-- lengths in millimetres -->\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n";
    const bool field_data = corner_texture || frame || !made_by.empty();
    if (field_data) xml += "<FieldData>\n";
    if (frame) xml += string_array("SPACE", to_string(*frame));
    for (const auto& [key, value] : made_by) xml += string_array(key, value);
    if (corner_texture) {
        arrays.add<double>(texture_array, "Float64", 2, flattened(mesh.texture_coordinates),
                           mesh.texture_coordinates.size());
        arrays.add<std::int64_t>(texture_corner_array, "Int64", 1, mesh.faces.texture_corners,
                                 mesh.faces.texture_corners.size());
    }
    if (field_data) xml += "</FieldData>\n";
    xml += fmt::format(
        "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
        "NumberOfPolys=\"{}\">\n",
        n, cloud ? 1 : 0, mesh.faces.size());
    xml += vertex_texture ? fmt::format("<PointData TCoords=\"{}\">\n", texture_array) : "<PointData>\n";
    if (vertex_texture) arrays.add<double>(texture_array, "Float64", 2, flattened(mesh.texture_coordinates));
    if (!mesh.colours.empty()) {
        std::vector<std::uint8_t> channels;
        for (const auto& c : mesh.colours) channels.insert(channels.end(), c.begin(), c.end());
        arrays.add<std::uint8_t>(colour_array, "UInt8", 3, channels);
    }
    const auto names = vtp_attribute_names(mesh);
    for (std::size_t k = 0; k < names.size(); ++k)
        arrays.add<double>(names[k], "Float64", mesh.attributes[k].components, mesh.attributes[k].values);
    xml += "</PointData>\n<Points>\n";
    arrays.add<double>("Points", "Float64", 3, flattened(mesh.vertices_mm));
    xml += "</Points>\n";
    if (cloud) {
        std::vector<std::int64_t> every(n);
        for (std::size_t i = 0; i < n; ++i) every[i] = static_cast<std::int64_t>(i);
        xml += "<Verts>\n";
        arrays.add<std::int64_t>("connectivity", "Int64", 1, every);
        arrays.add<std::int64_t>("offsets", "Int64", 1, std::vector<std::int64_t>{static_cast<std::int64_t>(n)});
        xml += "</Verts>\n";
    }
    xml += "<Polys>\n";
    arrays.add<std::int64_t>("connectivity", "Int64", 1, mesh.faces.corners);
    arrays.add<std::int64_t>("offsets", "Int64", 1, std::span(mesh.faces.first).subspan(1));
    xml += "</Polys>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
    out.write(xml.data(), static_cast<std::streamsize>(xml.size()));
    out.write(arrays.data.data(), static_cast<std::streamsize>(arrays.data.size()));
    out << "\n</AppendedData>\n</VTKFile>\n";
}

}  // namespace mimik::io::formats
