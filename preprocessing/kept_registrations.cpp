#include "preprocessing/kept_registrations.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/content_hash.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/file_digest.h"
#include "io/mesh_io.h"
#include "preprocessing/workspace_json.h"

namespace mimik::preprocessing {

using geometry::Point;
using geometry::Vector;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// Part of every mark: raise it when a registration gives other numbers for the same faces and options.
constexpr int registration_version = 1;
constexpr const char* registration_kind = "mimik registration";

fs::path with_suffix(fs::path stem, const char* suffix) { return stem += suffix; }

/// Vertices and motion as a file holds them: in the scanner frame of the subject's first neutral scan.
struct StoredRegistration {
    std::vector<Point> vertices_mm;
    std::vector<Vector> displacement_mm;  ///< of an expression, else empty
    geometry::VertexMask matched;
    std::size_t still_controls = 0;
    double matched_share = 0.0, residual_rms_mm = 0.0;
};

void add(base::ContentHash& hash, const Point& point) {
    for (const double x : point) hash.add(x);
}

/// All of a face that a registration looks at.
void add(base::ContentHash& hash, const Face& face) {
    hash.add(fmt::format("{} {} {}\n", face.id.name(), face.grid.rows, face.grid.cols));
    for (std::size_t v = 0; v < face.grid.size(); ++v) {
        hash.add(static_cast<double>(face.grid.origin[v]));
        if (face.grid.inside(v)) add(hash, face.grid.vertices_mm[v]);
    }
    for (const auto& mark : face.landmarks.all()) {
        hash.add(mark.name + "\n");
        add(hash, mark.position_mm);
    }
    for (const double x : face.average_from_scan.matrix().reshaped()) hash.add(x);
}

std::string encode(const StoredRegistration& stored, std::span<const geometry::Triangle> triangles,
                   const std::string& name) {
    geometry::Mesh mesh;
    mesh.vertices_mm = stored.vertices_mm;
    for (const auto& triangle : triangles) mesh.faces.add(triangle);
    geometry::VertexAttribute matched{"matched", 1, {}};
    for (const auto lies_on : stored.matched) matched.values.push_back(lies_on ? 1.0 : 0.0);
    mesh.attributes.push_back(std::move(matched));
    if (!stored.displacement_mm.empty()) {
        geometry::VertexAttribute displacement{"displacement_mm", 3, {}};
        for (const auto& way : stored.displacement_mm)
            displacement.values.insert(displacement.values.end(), way.begin(), way.end());
        mesh.attributes.push_back(std::move(displacement));
    }
    return io::encode_ply(mesh, name);
}

void write(const fs::path& stem, const StoredRegistration& stored, std::span<const geometry::Triangle> triangles,
           const std::string& made_from) {
    const auto ply = with_suffix(stem, ".ply");
    const auto bytes = encode(stored, triangles, ply.string());
    base::write_atomically(ply, bytes);
    // The mark comes last: a run that ends in between leaves a registration that counts as missing.
    base::write_atomically(with_suffix(stem, ".json"), io::json_text(json{{"schema", 1},
                                                                          {"kind", registration_kind},
                                                                          {"made_from", made_from},
                                                                          {"ply", base::digest_of(bytes).text()},
                                                                          {"matched_share", stored.matched_share},
                                                                          {"residual_rms_mm", stored.residual_rms_mm},
                                                                          {"still_controls", stored.still_controls}}));
}

const geometry::VertexAttribute& attribute(const geometry::Mesh& mesh, const char* name, int components) {
    for (const auto& one : mesh.attributes)
        if (one.name == name && one.components == components &&
            one.values.size() == static_cast<std::size_t>(components) * mesh.vertices_mm.size())
            return one;
    throw InputError(fmt::format("vertex attribute '{}' is missing", name));
}

/// @throws InputError if it is damaged.
StoredRegistration read_stored(const fs::path& stem, const json& document, std::size_t vertices, bool moves) {
    StoredRegistration stored;
    stored.matched_share = io::read_field<double>(document, "matched_share");
    stored.residual_rms_mm = io::read_field<double>(document, "residual_rms_mm");
    stored.still_controls = io::read_field<std::size_t>(document, "still_controls");
    const auto ply = with_suffix(stem, ".ply");
    if (base::digest_of_file(ply).text() != io::read_field<std::string>(document, "ply"))
        throw InputError(fmt::format("{} is not as it was written", ply.string()));
    auto mesh = io::read_mesh(ply);
    if (mesh.vertices_mm.size() != vertices) throw InputError("it has other vertices than the template");
    for (const double value : attribute(mesh, "matched", 1).values) stored.matched.push_back(value != 0 ? 1 : 0);
    if (moves) {
        const auto& values = attribute(mesh, "displacement_mm", 3).values;
        for (std::size_t v = 0; v < vertices; ++v)
            stored.displacement_mm.emplace_back(values[3 * v], values[3 * v + 1], values[3 * v + 2]);
    }
    stored.vertices_mm = std::move(mesh.vertices_mm);
    return stored;
}

/// What an earlier run found, if it is whole and was made from the same.
std::optional<StoredRegistration> read(const fs::path& stem, const std::string& made_from, std::size_t vertices,
                                       bool moves) {
    const auto file = with_suffix(stem, ".json");
    if (stem.empty() || !base::is_there(file)) return std::nullopt;
    try {
        return io::read_json_document(base::read_text(file, io::most_json_bytes), file.string(), damaged_file_mend,
                                      [&](const json& document) -> std::optional<StoredRegistration> {
                                          if (io::read_field<std::string>(document, "made_from") != made_from)
                                              return std::nullopt;
                                          return read_stored(stem, document, vertices, moves);
                                      });
    } catch (const InputError&) {
        return std::nullopt;  // damaged: made again
    }
}

void keep(const fs::path& stem, const StoredRegistration& stored, std::span<const geometry::Triangle> triangles,
          const std::string& made_from) {
    if (stem.empty()) return;
    try {
        write(stem, stored, triangles, made_from);
    } catch (const InputError&) {
        // A workspace that may only be read, or a full disk: the next run registers again.
    }
}

/// Always by way of what a file holds: a registration that was just made and one that was read are equal to the bit.
RegisteredTemplate in_average_frame(StoredRegistration stored, const geometry::Transform& average_from_scan) {
    for (auto& p : stored.vertices_mm) p = average_from_scan * p;
    return {std::move(stored.vertices_mm), std::move(stored.matched), stored.matched_share, stored.residual_rms_mm};
}

}  // namespace

std::string template_fingerprint(const FaceTemplate& face_template) {
    base::ContentHash hash;
    const auto add_line = [&](std::span<const std::uint32_t> line) {
        hash.add(fmt::format("{}\n", line.size()));
        for (const auto v : line) hash.add(static_cast<double>(v));
    };
    for (const auto& p : face_template.surface.vertices_mm) add(hash, p);
    for (const auto& triangle : face_template.surface.triangles) add_line(triangle);
    for (const auto& mark : face_template.surface.landmarks.all()) {
        hash.add(mark.name + "\n");
        add(hash, mark.position_mm);
    }
    add_line(face_template.mirror);
    add_line(face_template.upper_lip_line);
    add_line(face_template.lower_lip_line);
    for (const auto& mark : face_template.landmarks) {
        hash.add(mark.name + "\n");
        add_line(mark.corners);
        add(hash, mark.weights);
    }
    return hash.text();
}

KeptRegistrations::KeptRegistrations(AverageFace average, fs::path folder)
    : average_(std::move(average)), folder_(std::move(folder)) {}

KeptRegistrations::KeptRegistrations(FaceTemplate face_template) : given_(std::move(face_template)) {}

const TemplateRegistration& KeptRegistrations::registration() const {
    std::call_once(making_, [&] {
        const TemplateRegistrationOptions options;
        registration_ =
            std::make_unique<const TemplateRegistration>(given_ ? *given_ : build_face_template(average_), options);
        fingerprint_ = fmt::format("version {} template {} {}", registration_version,
                                   template_fingerprint(registration_->face_template()), base::field_text(options));
    });
    return *registration_;
}

fs::path KeptRegistrations::stem(const Face& face) const {
    if (folder_.empty() || face.id.subject.empty()) return {};
    return folder_ / face.id.subject / face.id.name();
}

std::string KeptRegistrations::made_from(const Face& neutral, const Face* expressive) const {
    base::ContentHash hash;
    hash.add(fingerprint_);
    add(hash, neutral);
    if (expressive) add(hash, *expressive);
    return hash.text();
}

RegisteredTemplate KeptRegistrations::neutral(const Face& face) const {
    const auto& made = registration();
    const auto files = stem(face);
    const auto mark = files.empty() ? std::string() : made_from(face, nullptr);
    auto stored = read(files, mark, made.face_template().size(), false);
    if (!stored) {
        auto found = made.neutral(face);
        const geometry::Transform scan_from_average = face.average_from_scan.inverse();
        for (auto& p : found.vertices_mm) p = scan_from_average * p;
        stored = {std::move(found.vertices_mm), {}, std::move(found.matched), 0, found.matched_share,
                  found.residual_rms_mm};
        keep(files, *stored, made.face_template().surface.triangles, mark);
    }
    return in_average_frame(std::move(*stored), face.average_from_scan);
}

RegisteredMotion KeptRegistrations::motion(const Face& neutral_face, const Face& expressive) const {
    const auto& made = registration();
    const auto files = stem(expressive);
    const auto mark = files.empty() ? std::string() : made_from(neutral_face, &expressive);
    auto stored = read(files, mark, made.face_template().size(), true);
    if (!stored) {
        const auto rest = neutral(neutral_face);
        auto found = made.motion(neutral_face, rest, expressive);
        const geometry::Transform scan_from_average = neutral_face.average_from_scan.inverse();
        stored = {{},
                  std::move(found.motion_mm),
                  std::move(found.matched),
                  found.still_controls,
                  found.matched_share,
                  found.residual_rms_mm};
        for (std::size_t v = 0; v < rest.vertices_mm.size(); ++v) {
            auto& way = stored->displacement_mm[v];
            way = scan_from_average.linear() * way;
            stored->vertices_mm.emplace_back(scan_from_average * rest.vertices_mm[v] + way);
        }
        keep(files, *stored, made.face_template().surface.triangles, mark);
    }
    for (auto& way : stored->displacement_mm) way = neutral_face.average_from_scan.linear() * way;
    return {std::move(stored->displacement_mm), std::move(stored->matched), stored->still_controls,
            stored->matched_share, stored->residual_rms_mm};
}

}  // namespace mimik::preprocessing
