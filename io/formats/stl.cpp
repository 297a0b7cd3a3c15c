#include "io/formats/stl.h"

#include <cmath>
#include <iterator>
#include <unordered_map>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
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

void decode_ascii(std::span<const std::uint8_t> bytes, const std::string& name, Mesh& mesh) {
    Welder welder(mesh);
    base::LineReader lines(as_text(bytes), name);
    std::size_t corners = 0;
    bool in_loop = false;
    while (lines.next_not_blank()) {
        std::string_view rest = lines.line();
        const auto keyword = base::lower_case(base::next_word(rest));
        if (keyword == "vertex") {
            if (!in_loop || corners == 3) lines.fail("a vertex stands outside 'outer loop', or is the fourth of one");
            Point position;
            for (Eigen::Index axis = 0; axis < 3; ++axis) {
                const auto word = base::next_word(rest);
                const auto value = base::parse_double(word);
                if (!value || !std::isfinite(*value))
                    lines.fail(fmt::format("{} is {}, not a finite number", "xyz"[axis],
                                           word.empty() ? "missing" : base::in_quotes(word)));
                position[axis] = *value;
            }
            welder.add_corner(position);
            ++corners;
        } else if (keyword == "outer") {
            if (in_loop) lines.fail("an 'outer loop' stands inside another; the 'endloop' is missing");
            in_loop = true;
            corners = 0;
        } else if (keyword == "endloop") {
            if (corners != 3) lines.fail(fmt::format("a facet has {} vertices; an STL facet has 3", corners));
            in_loop = false;
        } else if (keyword != "solid" && keyword != "facet" && keyword != "endfacet" && keyword != "endsolid") {
            lines.fail(fmt::format("{} is no STL keyword; the file is damaged", base::in_quotes(keyword)));
        }
    }
    if (in_loop) throw InputError(fmt::format("{}: the last facet has no 'endloop'; the file is truncated", name));
}

}  // namespace

MeshFile decode_stl(std::span<const std::uint8_t> bytes, const std::string& name) {
    MeshFile file;
    // Binary files may begin with "solid" too, so the size decides.
    const auto promised = bytes.size() >= header_bytes ? std::uint64_t{load<std::uint32_t>(bytes.data() + 80)} : 0;
    if (bytes.size() >= header_bytes && bytes.size() == header_bytes + triangle_bytes * promised) {
        decode_binary(bytes, file.mesh);
        return file;
    }
    auto text = as_text(bytes);
    const bool binary = text.find('\0') != std::string_view::npos;
    if (binary || !base::equal_ignoring_case(base::next_word(text), "solid"))
        throw InputError(
            bytes.size() < header_bytes
                ? fmt::format("{}: has {} bytes and does not start with 'solid'; it is not an STL file", name,
                              bytes.size())
                : fmt::format(
                      "{}: has {} bytes, but the {} triangles of its header (byte 80) need {}; it is truncated, or no "
                      "STL file",
                      name, bytes.size(), promised, header_bytes + triangle_bytes * promised));
    decode_ascii(bytes, name, file.mesh);
    return file;
}

void encode_stl(std::ostream& out, const Mesh& mesh, const MeshWriteOptions& options, const std::string& name) {
    const auto triangles = geometry::triangulate(mesh.faces);
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
        text.resize(80, ' ');
        append(text, static_cast<std::uint32_t>(triangles.size()));
    } else {
        text = "solid millimetres\n";
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
