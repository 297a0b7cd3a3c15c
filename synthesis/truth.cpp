#include "synthesis/truth.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/errors.h"
#include "geometry/file.h"
#include "geometry/mesh_io.h"
#include "geometry/text.h"

namespace mimik::synthesis {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t max_vertices = 2'000'000;  // ICT-FaceKit's faces have 26,719

/// The library's own messages name neither file nor mend.
template <class Read>
auto reading(const std::string& text, const std::string& name, const Read& read) {
    try {
        const auto document = json::parse(text, nullptr, false);
        if (document.is_discarded())
            throw InputError(fmt::format("{}: not valid JSON; synthesize the database again", name));
        if (const auto schema = document.value("schema", 0); schema != 1)
            throw InputError(fmt::format("{}: schema is {}, this program reads 1", name, schema));
        return read(document);
    } catch (const json::exception& e) {
        throw InputError(fmt::format("{}: {}; synthesize the database again", name, e.what()));
    }
}

/// A whole number below `limit`: nothing is allocated or looked up by one that is not.
std::size_t number_below(std::size_t limit, const json& value, const std::string& name, const std::string& field) {
    if (value.is_number_unsigned() && value.get<std::uint64_t>() < limit) return value.get<std::size_t>();
    throw InputError(fmt::format("{}: {} is {}, not a whole number below {}; synthesize the database again", name,
                                 field, value.is_structured() ? "a list" : value.dump().substr(0, 40), limit));
}

}  // namespace

bool Truth::has(const database::ScanId& id) const { return std::find(scans.begin(), scans.end(), id) != scans.end(); }

std::vector<geometry::Point> TrueScan::head_vertices_mm() const {
    const auto head_from_scanner = scanner_from_head.inverse();
    std::vector<geometry::Point> head;
    head.reserve(vertices_mm.size());
    for (const auto& vertex : vertices_mm) head.emplace_back(head_from_scanner * vertex);
    return head;
}

Truth open_truth(const fs::path& database_root) {
    const fs::path file = database_root / "truth" / "truth.json";
    if (!fs::exists(file))
        throw InputError(
            fmt::format("{}: missing; only a database made by 'mimik synthesize' has a known truth", file.string()));
    auto truth = decode_truth(geometry::read_text(file), file.string());
    truth.root = database_root;
    return truth;
}

Truth decode_truth(const std::string& text, const std::string& name) {
    return reading(text, name, [&](const json& document) {
        Truth truth;
        truth.seed = document.at("seed").get<std::uint64_t>();
        const auto& model = document.at("face_model");
        truth.face_model = model.at("name").get<std::string>();
        const auto vertices = number_below(max_vertices + 1, model.at("vertices"), name, "face_model.vertices");
        const auto vertex = [&](const json& value, const char* field) {
            return static_cast<std::uint32_t>(number_below(vertices, value, name, field));
        };
        std::vector<std::uint32_t> corners;
        for (const auto& face : model.at("faces")) {
            corners.clear();
            for (const auto& corner : face) corners.push_back(vertex(corner, "a corner in face_model.faces"));
            if (corners.size() < 3)
                throw InputError(
                    fmt::format("{}: a face of face_model.faces has {} corners, not 3 or more; synthesize "
                                "the database again",
                                name, corners.size()));
            truth.faces.add(corners);
        }
        truth.vertex_regions.assign(vertices, "skin");
        for (const auto& [region, members] : model.at("regions").items())
            for (const auto& member : members)
                truth.vertex_regions[vertex(member, "a vertex in face_model.regions")] = region;
        for (const auto& [landmark, value] : model.at("landmark_vertices").items())
            truth.landmark_vertices[landmark] = vertex(value, "a vertex in face_model.landmark_vertices");
        for (const auto& entry : document.at("subjects"))
            truth.subjects.push_back({entry.at("name").get<std::string>(), entry.at("sex").get<std::string>(),
                                      entry.at("amplitude").get<double>(), entry.at("asymmetry").get<double>(),
                                      entry.at("measurements_mm").get<std::map<std::string, double>>()});
        for (const auto& entry : document.at("scans")) {
            const auto id = database::parse_scan_name(entry.get<std::string>());
            if (!id)
                throw InputError(fmt::format("{}: scans has {}, which is no scan name; synthesize the database again",
                                             name, geometry::in_quotes(entry.get<std::string>())));
            truth.scans.push_back(*id);
        }
        return truth;
    });
}

TrueScan load_true_scan(const Truth& truth, const database::ScanId& id) {
    if (!truth.has(id))
        throw InputError(
            fmt::format("{}: the truth has no scan {}", (truth.root / "truth" / "truth.json").string(), id.name()));
    const fs::path stem = truth.root / "truth" / id.subject / id.name();
    const fs::path mesh_file = fs::path(stem).concat(".ply"), file = fs::path(stem).concat(".json");
    TrueScan scan;
    scan.id = id;
    auto mesh = geometry::read_mesh(mesh_file);
    if (mesh.vertices_mm.size() != truth.vertex_regions.size())
        throw InputError(fmt::format("{}: {} vertices, truth.json says {}; synthesize the database again",
                                     mesh_file.string(), mesh.vertices_mm.size(), truth.vertex_regions.size()));
    scan.vertices_mm = std::move(mesh.vertices_mm);
    scan.faces = std::move(mesh.faces);
    const auto attribute = std::find_if(mesh.attributes.begin(), mesh.attributes.end(),
                                        [](const auto& a) { return a.name == "displacement_mm" && a.components == 3; });
    if (attribute == mesh.attributes.end())
        throw InputError(fmt::format("{}: no vertex attribute displacement_mm with 3 components", mesh_file.string()));
    for (std::size_t i = 0; i < scan.vertices_mm.size(); ++i)
        scan.displacement_mm.emplace_back(attribute->values[3 * i], attribute->values[3 * i + 1],
                                          attribute->values[3 * i + 2]);

    reading(geometry::read_text(file), file.string(), [&](const json& document) {
        const auto pose = document.at("scanner_from_head").get<std::vector<std::vector<double>>>();
        if (pose.size() != 4 || std::any_of(pose.begin(), pose.end(), [](const auto& row) { return row.size() != 4; }))
            throw InputError(fmt::format("{}: scanner_from_head is not a 4x4 matrix", file.string()));
        for (int r = 0; r < 4; ++r)
            for (int c = 0; c < 4; ++c)
                scan.scanner_from_head.matrix()(r, c) = pose[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
        std::vector<geometry::Landmark> marks;
        for (const auto name : geometry::standard_landmark_names()) {
            const auto found = document.at("landmarks").find(std::string(name));
            if (found == document.at("landmarks").end()) continue;
            const auto p = found->get<std::array<double, 3>>();
            marks.push_back({std::string(name), {p[0], p[1], p[2]}, ""});
        }
        scan.landmarks = geometry::Landmarks(std::move(marks));
        scan.shape_weights = document.at("shape_weights").get<std::map<std::string, double>>();
        scan.amplitude = document.at("amplitude").get<double>();
        scan.asymmetry = document.at("asymmetry").get<double>();
        return 0;
    });
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
    geometry::write_mesh(fs::path(stem).concat(".ply"), mesh);

    json pose = json::array();
    for (int r = 0; r < 4; ++r) {
        json row = json::array();
        for (int c = 0; c < 4; ++c) row.push_back(scan.scanner_from_head.matrix()(r, c));
        pose.push_back(row);
    }
    json landmarks = json::object();
    for (const auto& mark : scan.landmarks.all())
        landmarks[mark.name] = {mark.position_mm.x(), mark.position_mm.y(), mark.position_mm.z()};
    const json document = {{"schema", 1},
                           {"scan", scan.id.name()},
                           {"frame", "scanner; mm; +x subject's left, +y up, +z out of the face"},
                           {"scanner_from_head", pose},
                           {"landmarks", landmarks},
                           {"shape_weights", scan.shape_weights},
                           {"amplitude", scan.amplitude},
                           {"asymmetry", scan.asymmetry}};
    geometry::write_atomically(fs::path(stem).concat(".json"), document.dump(1) + "\n");
}

}  // namespace mimik::synthesis
