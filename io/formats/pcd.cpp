#include "io/formats/pcd.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <liblzf/lzf.h>

#include "base/errors.h"
#include "base/text.h"
#include "io/formats/bytes.h"

namespace mimik::io::formats {

using geometry::Mesh;

namespace {

constexpr std::size_t most_fields = 1000;
constexpr std::size_t largest_count = 10000;
// Compressed fields can hold 700 times their bytes as numbers; a scan of a million points with 12 fields has 96 MB.
constexpr std::uint64_t most_decoded_bytes = std::uint64_t{256} << 20;
// Whoever draws or warps the points takes ten times their memory: a small file shall not ask for gigabytes.
constexpr std::uint64_t free_decoded_bytes = std::uint64_t{64} << 20, decoded_per_byte = 16;
// Three bytes of LZF stand for at most 264.
constexpr std::uint64_t best_lzf_ratio = 88;

struct Field {
    std::string name;
    std::size_t size = 4;
    char kind = 'F';
    std::size_t count = 1;
    double* column = nullptr;  // of the first component; nullptr: skipped
    std::size_t stride = 1;
    bool packed_colour = false;

    [[nodiscard]] std::size_t bytes() const { return size * count; }
    [[nodiscard]] Scalar scalar() const {
        if (kind == 'F') return size == 4 ? Scalar::float32 : Scalar::float64;
        const bool is_signed = kind == 'I';
        switch (size) {
            case 1:
                return is_signed ? Scalar::int8 : Scalar::uint8;
            case 2:
                return is_signed ? Scalar::int16 : Scalar::uint16;
            case 4:
                return is_signed ? Scalar::int32 : Scalar::uint32;
            default:
                return is_signed ? Scalar::int64 : Scalar::uint64;
        }
    }
};

enum class Storage { ascii, binary, compressed };

struct Header {
    std::vector<Field> fields;
    std::size_t width = 0, height = 1;
    std::optional<std::size_t> points;
    Storage storage = Storage::ascii;
    [[nodiscard]] std::size_t point_bytes() const {
        std::size_t sum = 0;
        for (const auto& f : fields) sum += f.bytes();
        return sum;
    }
};

std::vector<std::string_view> words_of(std::string_view rest) {
    std::vector<std::string_view> words;
    for (auto word = base::next_word(rest); !word.empty() && words.size() <= most_fields; word = base::next_word(rest))
        words.push_back(word);
    return words;
}

std::size_t whole_number(const base::LineReader& lines, std::string_view what, std::string_view word,
                         std::size_t smallest, std::size_t largest) {
    const auto value = base::parse_integer(word);
    if (!value || *value < static_cast<std::int64_t>(smallest) || *value > static_cast<std::int64_t>(largest))
        lines.fail(fmt::format("{} is {}; it must be a whole number from {} to {}", what, base::in_quotes(word),
                               smallest, largest));
    return static_cast<std::size_t>(*value);
}

/// SIZE, TYPE and COUNT that stand before FIELDS.
using FieldLines = std::map<std::string, std::pair<base::LineReader, std::vector<std::string_view>>, std::less<>>;

void apply_field_lines(const FieldLines& field_lines, Header& header) {
    for (const auto& [key, line_and_words] : field_lines) {
        const auto& [line, words] = line_and_words;
        if (words.size() != header.fields.size())
            line.fail(fmt::format("{} has {} entries for {} fields", key, words.size(), header.fields.size()));
        for (std::size_t i = 0; i < words.size(); ++i) {
            auto& field = header.fields[i];
            if (key == "SIZE") {
                field.size = whole_number(line, "SIZE", words[i], 1, 8);
                if (field.size != 1 && field.size != 2 && field.size != 4 && field.size != 8)
                    line.fail(fmt::format("SIZE of field {} is {}; it must be 1, 2, 4 or 8",
                                          base::in_quotes(field.name), field.size));
            } else if (key == "TYPE") {
                const auto type = base::lower_case(words[i]);
                if (type != "f" && type != "i" && type != "u")
                    line.fail(fmt::format("TYPE of field {} is {}; it must be F, I or U", base::in_quotes(field.name),
                                          base::in_quotes(words[i])));
                field.kind = type == "f" ? 'F' : type == "i" ? 'I' : 'U';
            } else {
                field.count = whole_number(line, "COUNT", words[i], 1, largest_count);
            }
        }
    }
}

Storage storage_named(const base::LineReader& lines, std::string_view word) {
    const auto storage = base::lower_case(word);
    if (storage == "ascii") return Storage::ascii;
    if (storage == "binary") return Storage::binary;
    if (storage == "binary_compressed") return Storage::compressed;
    lines.fail(fmt::format("DATA is {}; it must be ascii, binary or binary_compressed", base::in_quotes(word)));
}

Header parse_header(base::LineReader& lines) {
    Header header;
    FieldLines field_lines;
    constexpr std::size_t most_points = std::numeric_limits<std::int32_t>::max();
    bool known = false;
    while (lines.next_not_blank()) {
        std::string_view rest = lines.line();
        const auto key = base::next_word(rest);
        if (key.starts_with('#') || key == "VERSION" || key == "VIEWPOINT") continue;
        const auto words = words_of(rest);
        if (key == "FIELDS" || key == "COLUMNS") {
            if (words.size() > most_fields) lines.fail(fmt::format("more than {} fields", most_fields));
            header.fields.resize(words.size());
            for (std::size_t i = 0; i < words.size(); ++i) header.fields[i].name = words[i];
        } else if (key == "SIZE" || key == "TYPE" || key == "COUNT") {
            FieldLines this_line = {{std::string(key), {lines, words}}};
            if (header.fields.empty())
                field_lines.merge(this_line);
            else
                apply_field_lines(this_line, header);
        } else if (key == "WIDTH") {
            header.width = whole_number(lines, key, base::trimmed(rest), 0, most_points);
        } else if (key == "HEIGHT") {
            header.height = whole_number(lines, key, base::trimmed(rest), 1, most_points);
        } else if (key == "POINTS") {
            header.points = whole_number(lines, key, base::trimmed(rest), 0, most_points);
        } else if (key == "DATA") {
            header.storage = storage_named(lines, base::trimmed(rest));
            apply_field_lines(field_lines, header);
            for (const auto& field : header.fields)
                if (field.kind == 'F' && field.size != 4 && field.size != 8)
                    lines.fail(fmt::format("field {} is a real number of {} bytes; it must have 4 or 8",
                                           base::in_quotes(field.name), field.size));
            return header;
        } else if (!known) {
            // Whoever writes the format may add lines of his own, but not at its beginning.
            lines.fail(fmt::format("{} is no PCD header keyword; is it a PCD file?", base::in_quotes(key)));
        }
        known = true;
    }
    throw InputError(
        fmt::format("{}: the header has no DATA line; it is truncated, or no PCD file", lines.file_name()));
}

Field* find_scalar(Header& header, std::string_view name) {
    for (auto& f : header.fields)
        if (f.name == name && f.count == 1) return &f;
    return nullptr;
}

/// Where colours go: packed in one field, or a byte each.
void direct_fields(Header& header, std::size_t count, Mesh& mesh, std::vector<double>& packed,
                   std::vector<double>& channels, MeshParts parts, const std::string& name) {
    mesh.vertices_mm.resize(count);
    constexpr std::array<std::string_view, 3> axes = {"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        auto* field = find_scalar(header, axes[axis]);
        if (!field) throw InputError(fmt::format("{}: FIELDS has no '{}'; it needs x, y and z", name, axes[axis]));
        field->column = count > 0 ? mesh.vertices_mm.front().data() + axis : nullptr;
        field->stride = 3;
    }
    auto* colour = find_scalar(header, "rgb");
    if (!colour) colour = find_scalar(header, "rgba");
    if (colour && colour->size == 4) {
        packed.resize(count);
        colour->column = packed.data();
        colour->packed_colour = true;
    }
    const auto is_byte = [&](std::string_view field) {
        const auto* found = find_scalar(header, field);
        return found && found->size == 1 && found->kind == 'U';
    };
    if (!colour && is_byte("r") && is_byte("g") && is_byte("b") && count > 0) {
        channels.resize(3 * count);
        constexpr std::array<std::string_view, 3> names = {"r", "g", "b"};
        for (std::size_t c = 0; c < 3; ++c) {
            find_scalar(header, names[c])->column = channels.data() + c;
            find_scalar(header, names[c])->stride = 3;
        }
    }
    auto* u = find_scalar(header, "u");
    auto* v = find_scalar(header, "v");
    if (u && v && count > 0) {
        mesh.texture_coordinates.resize(count);
        u->column = mesh.texture_coordinates.front().data();
        v->column = u->column + 1;
        u->stride = v->stride = 2;
    }
    for (auto& field : header.fields) {
        const bool normal = field.name == "normal_x" || field.name == "normal_y" || field.name == "normal_z";
        if (field.column || field.name == "_" || normal || count == 0 || parts == MeshParts::without_attributes)
            continue;
        auto& attribute = mesh.attributes.emplace_back();
        attribute.name = field.name;
        attribute.components = static_cast<int>(field.count);
        attribute.values.resize(field.count * count);
        field.column = attribute.values.data();
        field.stride = field.count;
    }
}

/// The column of `field` from values that stand `stride` bytes apart.
void load_field(const Field& field, const std::uint8_t* at, std::size_t stride, std::size_t count) {
    if (!field.column) return;
    const auto type = field.packed_colour ? Scalar::uint32 : field.scalar();
    for (std::size_t c = 0; c < field.count; ++c)
        load_column(type, false, at + c * field.size, stride, count, field.column + c, field.stride);
}

void read_ascii(const Header& header, std::size_t count, base::LineReader& lines) {
    for (std::size_t i = 0; i < count; ++i) {
        if (!lines.next_not_blank())
            throw InputError(fmt::format("{}: has {} of the {} that the header promises; it is truncated",
                                         lines.file_name(), i, base::counted(count, "point")));
        std::string_view rest = lines.line();
        for (const auto& field : header.fields)
            for (std::size_t c = 0; c < field.count; ++c) {
                const auto word = base::next_word(rest);
                auto value = base::parse_double_or_nan(word);
                if (!value && !word.empty() && !field.column) value = 0.0;
                if (!value)
                    lines.fail(fmt::format("{} is {}, not a number", base::in_quotes(field.name),
                                           word.empty() ? "missing" : base::in_quotes(word)));
                // A colour may be written as the real number that has its bits.
                if (field.packed_colour && field.kind == 'F')
                    value = std::bit_cast<std::uint32_t>(static_cast<float>(*value));
                if (field.column) field.column[i * field.stride + c] = *value;
            }
        if (const auto extra = base::next_word(rest); !extra.empty())
            lines.fail(fmt::format("{} stands after the last field", base::in_quotes(extra)));
    }
}

std::vector<std::uint8_t> decompress(std::span<const std::uint8_t> data, std::uint64_t wanted,
                                     const std::string& name) {
    if (data.size() < 8)
        throw InputError(fmt::format("{}: the sizes of the compressed data are missing; it is truncated", name));
    const std::uint64_t packed = load<std::uint32_t>(data.data()), unpacked = load<std::uint32_t>(data.data() + 4);
    if (packed > data.size() - 8)
        throw InputError(fmt::format("{}: the compressed data has {} bytes but only {} are left; it is truncated", name,
                                     packed, data.size() - 8));
    if (unpacked != wanted)
        throw InputError(fmt::format("{}: the compressed data promises {}, but WIDTH x HEIGHT points need {}", name,
                                     base::counted(unpacked, "byte"), wanted));
    if (unpacked > best_lzf_ratio * packed)
        throw InputError(
            fmt::format("{}: {} compressed bytes cannot hold {}; the file is damaged", name, packed, unpacked));
    std::vector<std::uint8_t> out(unpacked);
    const auto written =
        lzf_decompress(data.data() + 8, static_cast<unsigned>(packed), out.data(), static_cast<unsigned>(unpacked));
    if (written != unpacked)
        throw InputError(fmt::format("{}: the compressed data is damaged; write the file again", name));
    return out;
}

}  // namespace

MeshFile decode_pcd(std::span<const std::uint8_t> bytes, const std::string& name, MeshParts parts) {
    base::LineReader lines(as_text(bytes), name);
    auto header = parse_header(lines);
    const std::uint64_t count = std::uint64_t{header.width} * header.height;
    if (header.points && *header.points != count)
        throw InputError(fmt::format("{}: POINTS is {}, but WIDTH x HEIGHT is {} x {}", name, *header.points,
                                     header.width, header.height));
    const auto data = bytes.subspan(lines.offset());
    const std::uint64_t point_bytes = header.point_bytes();
    // The least that `count` points take on disk: two characters a value, or their bytes, or those compressed.
    std::uint64_t values = 0;
    for (const auto& field : header.fields) values += field.count;
    const bool fits = header.storage == Storage::ascii
                          ? count <= (data.size() + 1) / std::max<std::uint64_t>(2 * values, 1)
                      : header.storage == Storage::binary
                          ? count <= data.size() / std::max<std::uint64_t>(point_bytes, 1)
                          : count <= best_lzf_ratio * data.size() / std::max<std::uint64_t>(point_bytes, 1);
    if (!fits)
        throw InputError(
            fmt::format("{}: WIDTH x HEIGHT is {} x {}, but only {} bytes of data are left; the file is truncated or "
                        "its header wrong",
                        name, header.width, header.height, data.size()));
    const std::uint64_t decoded = count * std::max(8 * values, point_bytes);
    if (const auto most = std::min(most_decoded_bytes, free_decoded_bytes + decoded_per_byte * bytes.size());
        decoded > most)
        throw InputError(
            fmt::format("{}: {} points of {} values take {} bytes of memory, more than {}; thin the scan out or leave "
                        "fields out",
                        name, count, values, decoded, most));
    MeshFile file;
    std::vector<double> packed_colours, channels;
    std::vector<std::uint8_t> unpacked;
    if (header.storage == Storage::compressed) unpacked = decompress(data, count * point_bytes, name);
    direct_fields(header, count, file.mesh, packed_colours, channels, parts, name);
    if (header.storage == Storage::ascii) {
        read_ascii(header, count, lines);
    } else {
        // Binary: point after point. Compressed: field after field.
        const bool apart = header.storage == Storage::compressed;
        const auto* at = apart ? unpacked.data() : data.data();
        for (const auto& field : header.fields) {
            load_field(field, at, apart ? field.bytes() : point_bytes, count);
            at += apart ? field.bytes() * count : field.bytes();
        }
    }
    for (const double packed : packed_colours) {
        const auto rgb = packed >= 0 && packed < 4294967296.0 ? static_cast<std::uint32_t>(packed) : 0U;
        file.mesh.colours.push_back({static_cast<std::uint8_t>(rgb >> 16U), static_cast<std::uint8_t>(rgb >> 8U),
                                     static_cast<std::uint8_t>(rgb)});
    }
    for (std::size_t k = 0; k < channels.size(); k += 3)
        file.mesh.colours.push_back(
            {colour_byte(channels[k], 1), colour_byte(channels[k + 1], 1), colour_byte(channels[k + 2], 1)});
    for (auto& p : file.mesh.vertices_mm)
        if (!p.allFinite()) p.setConstant(std::numeric_limits<double>::quiet_NaN());
    if (header.height > 1) {
        file.rows = static_cast<int>(header.height);
        file.cols = static_cast<int>(header.width);
    }
    return file;
}

}  // namespace mimik::io::formats
