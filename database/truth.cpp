#include "database/truth.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "geometry/surface_index.h"
#include "io/json_values.h"
#include "io/mesh_io.h"

namespace mimik::database {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t max_vertices = 2'000'000;  // ICT-FaceKit's faces have 26,719

constexpr std::size_t longest_region_name = 64;
constexpr const char* mend = "synthesize the database again";

}  // namespace

bool Truth::has(const database::ScanId& id) const { return std::find(scans.begin(), scans.end(), id) != scans.end(); }

geometry::Vector MaterialPoints::at(std::span<const geometry::Vector> field, std::size_t k) const {
    geometry::Vector value = geometry::Vector::Zero();
    for (std::size_t c = 0; c < 3; ++c) value += barycentric[k][static_cast<Eigen::Index>(c)] * field[triangles[k][c]];
    return value;
}

MaterialPoints material_points(const TrueScan& scan, std::span<const geometry::Point> points_mm) {
    const geometry::SurfaceIndex surface(scan.vertices_mm, geometry::triangulate(scan.faces));
    const auto triangles = surface.triangles();
    MaterialPoints points;
    for (const auto& hit : surface.closest(points_mm)) {
        points.triangles.push_back(triangles[hit.triangle]);
        points.barycentric.push_back(hit.barycentric);
    }
    return points;
}

Truth open_truth(const fs::path& database_root) {
    const fs::path file = database_root / "truth" / "truth.json";
    if (!base::is_there(file))
        throw InputError(
            fmt::format("{}: missing; only a database made by 'mimik synthesize' has a known truth", file.string()));
    auto truth = decode_truth(base::read_text(file, io::most_json_bytes), file.string());
    truth.root = database_root;
    return truth;
}

Truth decode_truth(std::string_view text, const std::string& name) {
    return io::read_json_document(text, name, mend, [&](const json& document) {
        Truth truth;
        truth.seed = io::read_field(document, "seed", [](const json& value) {
            if (!value.is_number_unsigned()) throw InputError(io::shown(value) + " is no whole number of 0 or more");
            return value.get<std::uint64_t>();
        });
        // Older databases say less.
        if (document.contains("expressions")) truth.expressions = io::read_field<std::string>(document, "expressions");
        if (document.contains("scanner"))
            truth.scanner = io::read_field<std::map<std::string, double>>(document, "scanner");
        if (document.contains("variances"))
            truth.variances = io::read_field<std::map<std::string, double>>(document, "variances");
        const auto& model = document.at("face_model");
        truth.face_model = io::read_field<std::string>(model, "name");
        const auto vertices = io::whole_number_below(max_vertices + 1, model.at("vertices"), "face_model.vertices");
        const auto vertex = [&](const json& value, const char* field) {
            return static_cast<std::uint32_t>(io::whole_number_below(vertices, value, field));
        };
        std::vector<std::uint32_t> corners;
        for (const auto& face : model.at("faces")) {
            corners.clear();
            for (const auto& corner : face) corners.push_back(vertex(corner, "a corner in face_model.faces"));
            if (corners.size() < 3)
                throw InputError(fmt::format("a face of face_model.faces has {}, not 3 or more; {}",
                                             base::counted(corners.size(), "corner"), mend));
            truth.faces.add(corners);
        }
        truth.vertex_regions.assign(vertices, "skin");
        for (const auto& [region, members] : model.at("regions").items()) {
            if (region.size() > longest_region_name)  // every vertex may have a copy
                throw InputError(fmt::format("the name {} in face_model.regions has {} letters, more than {}; {}",
                                             base::in_quotes(region), region.size(), longest_region_name, mend));
            for (const auto& member : members)
                truth.vertex_regions[vertex(member, "a vertex in face_model.regions")] = region;
        }
        for (const auto& [landmark, value] : model.at("landmark_vertices").items())
            truth.landmark_vertices[landmark] = vertex(value, "a vertex in face_model.landmark_vertices");
        io::read_list(document, "subjects", [&](const json& entry) {
            truth.subjects.push_back(
                {io::read_field<std::string>(entry, "name"), io::read_field<std::string>(entry, "sex"),
                 io::read_field<double>(entry, "amplitude"), io::read_field<double>(entry, "asymmetry"),
                 io::read_field<std::map<std::string, double>>(entry, "measurements_mm")});
        });
        io::read_list(document, "scans", [&](const json& entry) {
            truth.scans.push_back(database::scan_id_from(entry.get<std::string>()));
        });
        return truth;
    });
}

TrueScan decode_true_scan(std::string_view text, const std::string& name) {
    return io::read_json_document(text, name, mend, [&](const json& document) {
        TrueScan scan;
        scan.id = io::read_field(document, "scan",
                                 [](const json& value) { return database::scan_id_from(value.get<std::string>()); });
        scan.scanner_from_head = io::read_field(document, "scanner_from_head", io::transform_from_json);
        scan.landmarks = io::read_field(document, "landmarks", [](const json& positions) {
            std::vector<geometry::Landmark> marks;
            for (const auto name_of_mark : geometry::standard_landmark_names()) {
                const std::string mark(name_of_mark);
                if (positions.contains(mark))
                    marks.push_back({mark, io::read_field(positions, mark.c_str(), io::vector_from_json), ""});
            }
            return geometry::Landmarks(std::move(marks));
        });
        scan.shape_weights = io::read_field<std::map<std::string, double>>(document, "shape_weights");
        scan.amplitude = io::read_field<double>(document, "amplitude");
        scan.asymmetry = io::read_field<double>(document, "asymmetry");
        return scan;
    });
}

TrueScan load_true_scan(const Truth& truth, const database::ScanId& id) {
    if (!truth.has(id))
        throw InputError(
            fmt::format("{}: the truth has no scan {}", (truth.root / "truth" / "truth.json").string(), id.name()));
    const fs::path stem = truth.root / "truth" / id.subject / id.name();
    const fs::path mesh_file = fs::path(stem).concat(".ply"), file = fs::path(stem).concat(".json");
    auto scan = decode_true_scan(base::read_text(file, io::most_json_bytes), file.string());
    if (scan.id != id)
        throw InputError(fmt::format("{}: scan is {}, not {}; {}", file.string(), scan.id.name(), id.name(), mend));
    auto mesh = io::read_mesh(mesh_file);
    if (mesh.vertices_mm.size() != truth.vertex_regions.size())
        throw InputError(fmt::format("{}: {}, truth.json says {}; {}", mesh_file.string(),
                                     base::counted(mesh.vertices_mm.size(), "vertex", "vertices"),
                                     truth.vertex_regions.size(), mend));
    scan.vertices_mm = std::move(mesh.vertices_mm);
    scan.faces = std::move(mesh.faces);
    const auto attribute = std::find_if(mesh.attributes.begin(), mesh.attributes.end(),
                                        [](const auto& a) { return a.name == "displacement_mm" && a.components == 3; });
    if (attribute == mesh.attributes.end())
        throw InputError(fmt::format("{}: no vertex attribute displacement_mm with 3 components", mesh_file.string()));
    for (std::size_t i = 0; i < scan.vertices_mm.size(); ++i) {
        const double* d = attribute->values.data() + 3 * i;
        scan.displacement_mm.emplace_back(d[0], d[1], d[2]);
        if (!scan.displacement_mm.back().allFinite())
            throw InputError(
                fmt::format("{}: displacement_mm of vertex {} is not finite; {}", mesh_file.string(), i, mend));
    }
    return scan;
}

void write_true_scan(const fs::path& truth_folder, const TrueScan& scan) {
    const fs::path stem = truth_folder / scan.id.subject / scan.id.name();
    geometry::Mesh mesh;
    mesh.vertices_mm = scan.vertices_mm;
    mesh.faces = scan.faces;
    geometry::VertexAttribute displacement{"displacement_mm", 3, {}};
    for (const auto& d : scan.displacement_mm)
        displacement.values.insert(displacement.values.end(), {d.x(), d.y(), d.z()});
    mesh.attributes.push_back(std::move(displacement));
    io::write_mesh(fs::path(stem).concat(".ply"), mesh);

    json landmarks = json::object();
    for (const auto& mark : scan.landmarks.all()) landmarks[mark.name] = io::to_json(mark.position_mm);
    const json document = {{"schema", 1},
                           {"scan", scan.id.name()},
                           {"frame", "scanner; mm; +x subject's left, +y up, +z out of the face"},
                           {"scanner_from_head", io::to_json(scan.scanner_from_head)},
                           {"landmarks", landmarks},
                           {"shape_weights", scan.shape_weights},
                           {"amplitude", scan.amplitude},
                           {"asymmetry", scan.asymmetry}};
    base::write_atomically(fs::path(stem).concat(".json"), io::json_text(document));
}

}  // namespace mimik::database
