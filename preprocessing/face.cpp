#include "preprocessing/face.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "io/image.h"
#include "io/json_values.h"
#include "io/mesh_io.h"
#include "preprocessing/workspace_json.h"

namespace mimik::preprocessing {

using geometry::VertexOrigin;
using io::read_field;
using nlohmann::json;

namespace {

// As many as gridding makes.
constexpr std::size_t most_grid_lines = 20000;

std::filesystem::path with_suffix(const std::filesystem::path& stem, const char* suffix) {
    auto file = stem;
    file += suffix;
    return file;
}

}  // namespace

base::FileDigest write_grid(const std::filesystem::path& file, const geometry::QuadGrid& grid) {
    geometry::Mesh mesh;
    mesh.vertices_mm = grid.vertices_mm;
    mesh.faces = geometry::quads(grid);
    mesh.texture_coordinates = grid.texture_coordinates;
    // A scan may have points without a place in the image; files of meshes hold finite numbers only.
    for (auto& uv : mesh.texture_coordinates)
        if (!uv.allFinite()) uv.setZero();
    // Viewers choke on NaN: cells outside the face get the depth of the lowest vertex, and no quad uses them.
    double lowest = std::numeric_limits<double>::infinity();
    for (std::size_t v = 0; v < grid.size(); ++v)
        if (grid.inside(v)) lowest = std::min(lowest, grid.vertices_mm[v].z());
    geometry::VertexAttribute origin{"origin", 1, {}};
    for (std::size_t v = 0; v < grid.size(); ++v) {
        if (!grid.inside(v)) mesh.vertices_mm[v].z() = lowest;
        origin.values.push_back(static_cast<double>(grid.origin[v]));
    }
    mesh.attributes.push_back(std::move(origin));
    const auto bytes = io::encode_ply(mesh, file.string());
    base::write_atomically(file, bytes);
    return base::digest_of(bytes);
}

geometry::QuadGrid to_grid(geometry::Mesh mesh, int rows, int cols, const std::string& name) {
    geometry::QuadGrid grid;
    grid.rows = rows;
    grid.cols = cols;
    const auto vertices = mesh.vertices_mm.size();
    if (rows < 2 || cols < 2 || vertices != static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols))
        throw InputError(fmt::format("{}: {} where its .json says {} x {}; run 'mimik preprocess' again", name,
                                     base::counted(vertices, "vertex", "vertices"), rows, cols));
    if (!mesh.texture_coordinates.empty() && mesh.texture_coordinates.size() != vertices)
        throw InputError(fmt::format("{}: {} texture coordinates for {} vertices; run 'mimik preprocess' again", name,
                                     mesh.texture_coordinates.size(), vertices));
    grid.vertices_mm = std::move(mesh.vertices_mm);
    grid.texture_coordinates = std::move(mesh.texture_coordinates);
    for (const auto& attribute : mesh.attributes)
        if (attribute.name == "origin")
            for (const double value : attribute.values) {
                if (!(value == 0 || value == 1 || value == 2))
                    throw InputError(fmt::format("{}: origin {} is none of 0, 1, 2", name, value));
                grid.origin.push_back(static_cast<VertexOrigin>(static_cast<int>(value)));
            }
    if (grid.origin.size() != grid.size())
        throw InputError(fmt::format("{}: property 'origin' is missing; run 'mimik preprocess' again", name));
    for (std::size_t v = 0; v < grid.size(); ++v)
        if (!grid.inside(v)) {  // as gridding leaves them
            grid.vertices_mm[v].z() = std::numeric_limits<double>::quiet_NaN();
            if (!grid.texture_coordinates.empty())
                grid.texture_coordinates[v].setConstant(std::numeric_limits<double>::quiet_NaN());
        }
    return grid;
}

geometry::QuadGrid read_grid(const std::filesystem::path& file, int rows, int cols) {
    return to_grid(io::read_mesh(file), rows, cols, file.string());
}

geometry::QuadGrid grid_size_from_json(const json& document) {
    geometry::QuadGrid grid;
    grid.rows = static_cast<int>(io::whole_number_below(most_grid_lines + 1, document.at("rows"), "rows"));
    grid.cols = static_cast<int>(io::whole_number_below(most_grid_lines + 1, document.at("cols"), "cols"));
    return grid;
}

namespace {

/// A face's own picture is written beside it; the .json names it without a folder, so that a workspace can be moved.
std::string write_picture(const std::filesystem::path& stem, const Face& face, FaceDigests& digests) {
    const auto own = with_suffix(stem, ".png");
    if (face.picture) {
        const auto bytes = io::encode_png(*face.picture);
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        base::write_atomically(own, text);
        digests.png = base::digest_of(text);
    } else if (face.texture_file != own) {
        std::error_code ignored;
        std::filesystem::remove(own, ignored);  // of another scan of this name
        return face.texture_file.string();
    } else {
        digests.png = base::digest_of_file(own);  // written when the face was made
    }
    return own.filename().string();
}

}  // namespace

FaceDigests write_face(const std::filesystem::path& stem, const Face& face) {
    FaceDigests digests;
    const auto texture_file = write_picture(stem, face, digests);
    digests.ply = write_grid(with_suffix(stem, ".ply"), face.grid);
    const json document = {
        {"schema", 1},
        {"kind", "mimik face"},
        {"scan", face.id.name()},
        {"subject", face.id.subject},
        {"sex", face.sex},
        {"rows", face.grid.rows},
        {"cols", face.grid.cols},
        {"units", "mm"},
        {"frame", "scanner: +x subject's left, +y up, +z out of the face"},
        {"landmarks", io::to_json(face.landmarks)},
        {"snapped_landmarks", io::to_json(face.snapped_landmarks)},
        {"texture_file", texture_file},
        {"neutral_from_scan", io::to_json(face.neutral_from_scan)},
        {"average_from_scan", io::to_json(face.average_from_scan)},
        {"average_from_scan_affine", io::to_json(face.average_from_scan_affine)},
        {"alignment_rms_mm", face.alignment_rms_mm},
        {"remarks", face.remarks},
    };
    const auto text = io::json_text(document);
    base::write_atomically(with_suffix(stem, ".json"), text);
    digests.json = base::digest_of(text);
    return digests;
}

Face decode_face(std::string_view text, const std::string& name) {
    return io::read_json_document(text, name, damaged_file_mend, [](const json& document) {
        Face face;
        face.id = read_field(document, "scan",
                             [](const json& value) { return database::scan_id_from(value.get<std::string>()); });
        face.sex = read_field<std::string>(document, "sex");
        face.landmarks = io::landmarks_from_json(document, "landmarks");
        face.snapped_landmarks = io::landmarks_from_json(document, "snapped_landmarks");
        face.texture_file = read_field<std::string>(document, "texture_file");
        face.neutral_from_scan = read_field(document, "neutral_from_scan", io::transform_from_json);
        face.average_from_scan = read_field(document, "average_from_scan", io::transform_from_json);
        face.average_from_scan_affine = read_field(document, "average_from_scan_affine", io::transform_from_json);
        face.alignment_rms_mm = read_field<double>(document, "alignment_rms_mm");
        face.remarks = read_field<std::vector<std::string>>(document, "remarks");
        face.grid = grid_size_from_json(document);
        return face;
    });
}

Face read_face(const std::filesystem::path& stem) {
    const auto file = with_suffix(stem, ".json");
    auto face = decode_face(base::read_text(file, io::most_json_bytes), file.string());
    face.grid = read_grid(with_suffix(stem, ".ply"), face.grid.rows, face.grid.cols);
    if (face.texture_file == with_suffix(stem, ".png").filename()) face.texture_file = with_suffix(stem, ".png");
    return face;
}

}  // namespace mimik::preprocessing
