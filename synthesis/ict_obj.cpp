#include "synthesis/ict_obj.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "io/mesh_io.h"

namespace mimik::synthesis {
namespace {

void check_count(std::size_t vertices, std::size_t wanted, const std::string& name) {
    if (vertices < wanted)
        throw InputError(fmt::format("{}: {}, the face model needs {}; the file is cut off or of another topology",
                                     name, base::counted(vertices, "vertex", "vertices"), wanted));
}

}  // namespace

IctSkin decode_ict_skin(std::span<const std::uint8_t> bytes, const std::string& name, std::size_t wanted) {
    auto mesh = io::decode_mesh(io::MeshFormat::obj, bytes, name, io::LengthUnit::centimetre).mesh;
    check_count(mesh.vertices_mm.size(), wanted, name);
    IctSkin skin;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto corners = mesh.faces[f];
        if (*std::max_element(corners.begin(), corners.end()) < wanted) skin.faces.add(corners);
    }
    if (skin.faces.size() == 0)
        throw InputError(fmt::format("{}: no face of the skin; is it the ICT-FaceKit mesh?", name));
    mesh.vertices_mm.resize(wanted);
    skin.vertices_mm = std::move(mesh.vertices_mm);
    return skin;
}

std::vector<geometry::Point> decode_ict_vertices(std::string_view head, const std::string& name, std::size_t wanted) {
    // What follows the last line end may be half a line.
    base::LineReader lines(head.substr(0, head.rfind('\n') + 1), name);
    const double mm = io::millimetres_per(io::LengthUnit::centimetre);
    std::vector<geometry::Point> vertices_mm;
    while (vertices_mm.size() < wanted && lines.next()) {
        std::string_view rest = lines.line();
        if (base::next_word(rest) != "v") continue;
        geometry::Point point;
        for (int axis = 0; axis < 3; ++axis) {
            const auto word = base::next_word(rest);
            const auto value = base::parse_double(word);
            if (!value || !std::isfinite(*value))
                lines.fail(fmt::format("coordinate {} is {}, not a finite number", axis + 1, base::in_quotes(word)));
            point[axis] = *value;
        }
        vertices_mm.push_back(mm * point);
    }
    check_count(vertices_mm.size(), wanted, name);
    return vertices_mm;
}

}  // namespace mimik::synthesis
