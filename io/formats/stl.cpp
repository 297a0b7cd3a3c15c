#include "io/formats/stl.h"

#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <unordered_map>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "geometry/polygon_triangles.h"
#include "io/formats/bytes.h"

namespace mimik::io::formats {

using geometry::Mesh;
using geometry::Point;
using geometry::Vector;

namespace {

constexpr std::size_t header_bytes = 84;
constexpr std::size_t triangle_bytes = 50;

/// One vertex per distinct position. ASCII files may hold more digits than a float, so doubles are compared.
class Welder {
public:
    explicit Welder(Mesh& mesh) : mesh_(mesh) {}

    void reserve(std::size_t triangles) {
        index_.reserve(triangles / 2 + 3);  // a closed mesh has half as many vertices as triangles
        mesh_.faces.corners.reserve(3 * triangles);
        mesh_.faces.first.reserve(triangles + 1);
    }
    void add_corner(const Point& position) {
        Key key;
        for (std::size_t axis = 0; axis < 3; ++axis)  // + 0.0: -0 and 0 are one position
            key[axis] = std::bit_cast<std::uint64_t>(position[static_cast<Eigen::Index>(axis)] + 0.0);
        const auto [it, added] = index_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices_mm.size()));
        if (added) mesh_.vertices_mm.push_back(position);
        mesh_.faces.corners.push_back(it->second);
        if (++corners_ % 3 == 0) mesh_.faces.first.push_back(static_cast<std::uint32_t>(mesh_.faces.corners.size()));
    }

private:
    using Key = std::array<std::uint64_t, 3>;
    struct Hash {
        std::size_t operator()(const Key& key) const {
            std::uint64_t h = 0;
            for (const auto part : key) {
                h = (h ^ part) * 0x9E3779B97F4A7C15U;
                h ^= h >> 29U;
            }
            return h;
        }
    };
    Mesh& mesh_;
    std::unordered_map<Key, std::uint32_t, Hash> index_;
    std::size_t corners_ = 0;
};

void decode_binary(std::span<const std::uint8_t> bytes, Mesh& mesh) {
    Welder welder(mesh);
    const std::size_t triangles = (bytes.size() - header_bytes) / triangle_bytes;
    welder.reserve(triangles);
    for (std::size_t t = 0; t < triangles; ++t)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const auto* at = bytes.data() + header_bytes + t * triangle_bytes + 12 + 12 * corner;
            welder.add_corner({load<float>(at), load<float>(at + 4), load<float>(at + 8)});
        }
}

/// Words of an ASCII file, whatever lines they stand on. Comments run to the end of their line.
class Words {
public:
    Words(std::string_view text, const std::string& name) : lines_(text, name) {}

    /// Lower case; empty at the end of the file.
    std::string next() {
        for (;;) {
            auto word = base::lower_case(base::next_word(rest_));
            if (word.starts_with('#') || word.starts_with("//") || word.starts_with(';')) {
                rest_ = {};
                word.clear();
            }
            if (!word.empty()) return word;
            if (!lines_.next()) return {};
            rest_ = lines_.line();
        }
    }
    [[nodiscard]] std::string_view rest_of_line() const { return rest_; }
    void skip_line() { rest_ = {}; }
    void skip_to(std::size_t at) { rest_.remove_prefix(at); }
    [[noreturn]] void fail(const std::string& what) const { lines_.fail(what); }

private:
    base::LineReader lines_;
    std::string_view rest_;
};

/// Behind "solid" or "endsolid" stands a name, which may be any words; in a file without lines the next facet or solid
/// follows on the same line. @return the name.
std::string_view skip_name(Words& words, std::string_view keyword) {
    constexpr std::size_t longest_name = 1000;
    const auto rest = words.rest_of_line().substr(0, longest_name);
    const auto lowered = base::lower_case(rest);
    std::string_view left = lowered;
    while (!left.empty()) {
        const auto word = base::next_word(left);
        if (word != keyword) continue;
        auto ahead = left;
        const bool facet = keyword != "facet" || base::next_word(ahead) == "normal";
        const auto at = static_cast<std::size_t>(word.data() - lowered.data());
        if (!facet || !base::parse_double_or_nan(base::next_word(ahead))) {
            if (keyword == "facet") continue;
            // "endsolid a solid b facet normal ..."
            if (lowered.find("facet normal", at) == std::string::npos) continue;
        }
        words.skip_to(at);
        return rest.substr(0, at);
    }
    words.skip_line();
    return rest;
}

/// The words of the many writers: "endloop", "end loop" and "endfacet", "end facet"; any case; normals of any text,
/// since they are not used.
class AsciiReader {
public:
    AsciiReader(std::string_view text, const std::string& name, MeshFile& file)
        : words_(text, name), name_(name), file_(file), welder_(file.mesh) {}

    void read() {
        for (auto word = words_.next(); !word.empty(); word = words_.next()) read_part(word);
        if (in_loop_)
            throw InputError(fmt::format("{}: the last facet has no 'endloop'; the file is truncated", name_));
    }

private:
    void read_part(std::string word) {
        if (word == "end") word += words_.next();
        if (word == "outer") word += words_.next();
        if (word == "vertex") {
            read_vertex();
        } else if (word == "outerloop" || word == "loop") {
            if (in_loop_) words_.fail("an 'outer loop' stands inside another; the 'endloop' is missing");
            in_loop_ = true;
            corners_ = 0;
        } else if (word == "endloop") {
            if (corners_ != 3)
                words_.fail(
                    fmt::format("a facet has {}; an STL facet has 3", base::counted(corners_, "vertex", "vertices")));
            in_loop_ = false;
        } else if (word == "normal") {
            for (int axis = 0; axis < 3; ++axis) {
                auto ahead = words_.rest_of_line();
                const auto value = base::lower_case(base::next_word(ahead));
                if (value.empty() || value == "outer" || value == "outerloop" || value == "loop") break;
                (void)words_.next();
            }
        } else if (word == "solid") {
            const auto solid_name = skip_name(words_, "facet");
            if (!file_.frame) file_.frame = frame_in_comment(solid_name, name_);
        } else if (word == "endsolid") {
            skip_name(words_, "solid");
        } else if (word != "facet" && word != "endfacet") {
            words_.fail(fmt::format("{} is no STL keyword; the file is damaged", base::in_quotes(word)));
        }
    }

    void read_vertex() {
        if (!in_loop_ || corners_ == 3) words_.fail("a vertex stands outside 'outer loop', or is the fourth of one");
        Point position;
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            const auto word = words_.next();
            const auto value = base::parse_double(word);
            if (!value || !std::isfinite(*value))
                words_.fail(fmt::format("{} is {}, not a finite number", "xyz"[axis],
                                        word.empty() ? "missing" : base::in_quotes(word)));
            position[axis] = *value;
        }
        welder_.add_corner(position);
        ++corners_;
    }

    Words words_;
    const std::string& name_;
    MeshFile& file_;
    Welder welder_;
    std::size_t corners_ = 0;
    bool in_loop_ = false;
};

/// The first word that is no comment.
std::string first_word(std::string_view text, const std::string& name) { return Words(text, name).next(); }

}  // namespace

MeshFile decode_stl(std::span<const std::uint8_t> bytes, const std::string& name) {
    MeshFile file;
    auto text = as_text(bytes);
    // Binary files may begin with "solid" too, so the size decides. In a text the four bytes of the count are letters,
    // which stand for more triangles than any file has.
    const auto promised = bytes.size() >= header_bytes ? std::uint64_t{load<std::uint32_t>(bytes.data() + 80)} : 0;
    const auto needed = header_bytes + triangle_bytes * promised;
    if (bytes.size() >= header_bytes && (bytes.size() == needed || (promised > 0 && bytes.size() > needed))) {
        decode_binary(bytes.first(needed), file.mesh);
        file.frame = frame_in_comment(text.substr(0, 80), name);
        if (bytes.size() > needed && text.find_first_not_of(std::string_view(" \t\r\n\0", 5), needed) != text.npos)
            file.remarks.push_back(
                fmt::format("{}: {} bytes behind the last triangle are passed over", name, bytes.size() - needed));
        return file;
    }
    const bool binary = text.find('\0') != std::string_view::npos;
    if (binary || first_word(text, name) != "solid")
        throw InputError(
            bytes.size() < header_bytes
                ? fmt::format("{}: has {} bytes and does not start with 'solid'; it is not an STL file", name,
                              bytes.size())
                : fmt::format(
                      "{}: has {} bytes, but the {} of its header (byte 80) need {}; it is truncated, or no STL file",
                      name, bytes.size(), base::counted(promised, "triangle"), needed));
    AsciiReader(text, name, file).read();
    return file;
}

void encode_stl(std::ostream& out, const Mesh& mesh, const MeshWriteOptions& options, const std::string& name) {
    const auto triangles = geometry::triangulate(mesh.faces, mesh.vertices_mm);
    if (triangles.empty())
        throw InputError(
            fmt::format("{}: not written: STL holds triangles only and there is no face; write PLY", name));
    for (const auto& p : mesh.vertices_mm)
        if (p.cwiseAbs().maxCoeff() > static_cast<double>(std::numeric_limits<float>::max()))
            throw InputError(fmt::format("{}: not written: coordinate {} is too large for STL; write PLY", name,
                                         p.cwiseAbs().maxCoeff()));
    std::string text;
    if (options.binary) {
        text = "binary STL, lengths in millimetres";
        if (options.frame) text += fmt::format("; SPACE={}", to_string(*options.frame));
        text.resize(80, ' ');
        append(text, static_cast<std::uint32_t>(triangles.size()));
    } else {
        text = fmt::format("solid millimetres{}\n",
                           options.frame ? fmt::format(" SPACE={}", to_string(*options.frame)) : std::string());
    }
    const auto into = std::back_inserter(text);
    for (const auto& t : triangles) {
        const auto corner = [&](std::size_t k) -> const Point& { return mesh.vertices_mm[t[k]]; };
        const Vector normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
        const auto floats = [](const Vector& v) { return Eigen::Vector3f(v.cast<float>()); };
        const std::array<Eigen::Vector3f, 4> values = {floats(normal.allFinite() ? normal : Vector(Vector::Zero())),
                                                       floats(corner(0)), floats(corner(1)), floats(corner(2))};
        if (options.binary) {
            for (const auto& v : values)
                for (const float x : v) append(text, x);
            append(text, std::uint16_t{0});
            continue;
        }
        fmt::format_to(into, "facet normal {:.9g} {:.9g} {:.9g}\nouter loop\n", values[0].x(), values[0].y(),
                       values[0].z());
        for (std::size_t k = 1; k < 4; ++k)
            fmt::format_to(into, "vertex {:.9g} {:.9g} {:.9g}\n", values[k].x(), values[k].y(), values[k].z());
        text += "endloop\nendfacet\n";
    }
    if (!options.binary) text += "endsolid millimetres\n";
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
}

}  // namespace mimik::io::formats
