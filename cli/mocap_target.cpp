#include "cli/mocap_target.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "animation/lid_field.h"
#include "animation/part_masks.h"
#include "base/errors.h"
#include "base/quantile.h"
#include "base/text.h"
#include "builtin/unit_fields.h"
#include "capture/control_surface.h"
#include "capture/stick_markers.h"
#include "cli/command.h"
#include "cli/error_report.h"
#include "cli/subject_names.h"
#include "database/file_origin.h"
#include "database/hidden_subjects.h"
#include "database/known_databases.h"
#include "facs/facs_catalogue.h"
#include "geometry/face_surface.h"
#include "io/landmark_io.h"
#include "preprocessing/kept_registrations.h"
#include "preprocessing/workspace.h"
#include "report/shaded_face.h"

namespace mimik::cli {

using animation::MarkerMethod;
using geometry::Point;
using geometry::Vector;

namespace {

/// WORK:subject, where WORK is a folder.
std::optional<std::pair<std::string, std::string>> in_workspace(const std::string& target) {
    const auto colon = target.rfind(':');
    std::error_code ignored;
    if (colon == std::string::npos || !std::filesystem::is_directory(target.substr(0, colon), ignored))
        return std::nullopt;
    return std::pair(target.substr(0, colon), target.substr(colon + 1));
}

MocapTarget of_workspace(const std::string& folder, const std::string& typed) {
    const preprocessing::Workspace workspace(folder);
    const auto subject = subject_named(workspace, typed);
    workspace.refuse_hidden(subject);
    const auto face = workspace.face(workspace.neutral(subject));
    auto surface = geometry::face_surface(face.grid, face.landmarks);
    MocapTarget target;
    target.name = face.id.name();
    target.is_scan = true;
    target.landmarks = face.landmarks;
    std::vector<std::uint32_t> place(surface.size(), 0);
    for (std::size_t v = 0; v < surface.size(); ++v) {
        if (!surface.present[v]) continue;
        place[v] = static_cast<std::uint32_t>(target.mesh.vertices_mm.size());
        target.mesh.vertices_mm.push_back(surface.vertices_mm[v]);
    }
    for (const auto& t : surface.triangles) {
        target.triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
        target.mesh.faces.add(target.triangles.back());
    }
    target.made_by = {{"subjects", subject}, {"database", database::remember_database(workspace.database_root())}};
    return target;
}

MocapTarget of_mesh(const MocapTargetArguments& arguments) {
    if (arguments.landmarks.empty())
        throw InputError(
            "--landmarks: is missing; a mesh needs its landmarks (docs/landmarks.md), which say where its parts are");
    const std::filesystem::path file = arguments.target;
    for (const auto& one : {file, arguments.landmarks}) database::refuse_hidden_file(one);
    refuse_range_scan(file);
    const auto unit = io::parse_length_unit(arguments.unit);
    auto read = io::read_mesh_file(file, unit, io::MeshParts::without_attributes, io::BadTexture::report);
    MocapTarget target;
    target.name = file.filename().string();
    target.landmarks = io::read_landmarks(arguments.landmarks, read.mesh.vertices_mm, unit);
    target.mesh = std::move(read.mesh);
    target.triangles = geometry::triangulate(target.mesh.faces);
    target.remarks = read.remarks;
    if (target.triangles.empty()) throw InputError(fmt::format("{}: has no face to be moved", file.string()));
    target.made_by =
        database::said_in_files(database::united(database::origin_of(file), database::origin_of(arguments.landmarks)));
    return target;
}

/// Markers that lie elsewhere are of another unit, frame or face. Those of a jig lie above the skin, so the middle one
/// says.
void check_on_skin(const std::vector<geometry::Landmark>& labels, const geometry::SurfaceIndex& skin) {
    constexpr double most_mm = 15;
    std::vector<double> off_mm;
    for (const auto& label : labels) off_mm.push_back(skin.closest(label.position_mm).distance_mm);
    if (off_mm.empty() || base::median(off_mm) <= most_mm) return;
    throw InputError(
        fmt::format("half of the {} labels lie more than {:.1f} mm off the face, and {:g} is the most; mend "
                    "their unit or frame, or give those of this face",
                    labels.size(), base::median(off_mm), most_mm));
}

/// A scan has eyeball and lids in one surface, and where an eye is wide open the place of a lid's marker is before the
/// eyeball. That stays: bones would hang on nothing, and AUs would not see the lid move. The marker goes to the lid.
void put_on_lids(MocapTarget& target, const capture::MarkerSet& set, const geometry::SurfaceIndex& skin,
                 std::vector<geometry::Landmark>& labels) {
    using animation::LidSheet;
    target.prepare();
    const auto sheets = animation::lid_sheets(*target.prepared);
    const auto& vertices_mm = target.mesh.vertices_mm;
    const auto move = [&](const std::vector<std::string>& names, LidSheet sheet) {
        for (auto& label : labels) {
            if (std::find(names.begin(), names.end(), label.name) == names.end()) continue;
            const auto& corners = target.triangles[skin.closest(label.position_mm).triangle];
            if (std::none_of(corners.begin(), corners.end(), [&](auto v) { return sheets[v] == LidSheet::eyeball; }))
                continue;
            std::optional<std::size_t> nearest;
            for (std::size_t v = 0; v < vertices_mm.size(); ++v)
                if (sheets[v] == sheet && (!nearest || (vertices_mm[v] - label.position_mm).squaredNorm() <
                                                           (vertices_mm[*nearest] - label.position_mm).squaredNorm()))
                    nearest = v;
            if (nearest) label.position_mm = vertices_mm[*nearest];
        }
    };
    for (const auto& opening : set.openings) {
        if (!opening.name.starts_with("eye")) continue;
        move(opening.upper, LidSheet::upper);
        move(opening.lower, LidSheet::lower);
    }
}

}  // namespace

void MocapTarget::prepare() {
    if (prepared) return;
    expressions = std::make_shared<const builtin::BuiltinExpressions>();
    geometry::Mesh skin;
    skin.vertices_mm = mesh.vertices_mm;
    skin.faces = mesh.faces;
    prepared = std::make_shared<const animation::PreparedTarget>(geometry::face_surface(skin, landmarks),
                                                                 expressions->average(), name);
}

MocapTarget read_mocap_target(const MocapTargetArguments& arguments, const capture::MarkerSet& set) {
    const auto work = in_workspace(arguments.target);
    auto target = work ? of_workspace(work->first, work->second) : of_mesh(arguments);
    // Labels of the file go before; what it does not have is placed by the landmarks, on the surface.
    const geometry::SurfaceIndex skin(target.mesh.vertices_mm, target.triangles);
    std::vector<geometry::Landmark> labels;
    if (!arguments.markers.empty()) {
        database::refuse_hidden_file(arguments.markers);
        const auto read =
            io::read_landmarks(arguments.markers, target.mesh.vertices_mm, io::parse_length_unit(arguments.unit));
        labels.assign(read.all().begin(), read.all().end());
        naming(arguments.markers, [&] { check_on_skin(labels, skin); });
    }
    const geometry::Landmarks given(labels);
    const auto places =
        naming(target.name, [&] { return capture::stick_markers(set, target.landmarks, skin).landmarks(); });
    for (const auto& mark : places.all()) {
        if (given.find(mark.name)) continue;
        if (!arguments.markers.empty() && set.find(mark.name)) continue;  // a marker that its user left out
        labels.push_back(mark);
    }
    if (target.is_scan && arguments.markers.empty()) put_on_lids(target, set, skin, labels);
    target.labels = geometry::Landmarks(std::move(labels));
    for (const auto& fault : capture::surface_faults(set, target.labels)) target.remarks.push_back(fault);
    return target;
}

MocapRig::MocapRig(MocapTarget target, MarkerMethod method, const capture::MarkerSet& set,
                   std::vector<std::string> tracked, const animation::MarkerAnimatorOptions& options)
    : target_(std::move(target)), tracked_(std::move(tracked)) {
    surface_.mesh = target_.mesh;
    surface_.moves_with.resize(target_.mesh.vertices_mm.size());
    std::iota(surface_.moves_with.begin(), surface_.moves_with.end(), 0U);
    surface_.skin_vertices = surface_.moves_with.size();
    make_ready(method, set);
    const animation::MarkerAnimator::Mesh mesh{target_.mesh.vertices_mm, target_.triangles, parts_, &units_};
    animator_ = std::make_unique<const animation::MarkerAnimator>(method, mesh, set, target_.labels, tracked_, options);
    places_ = geometry::SurfaceIndex(target_.mesh.vertices_mm, target_.triangles).closest(animator_->rest_mm());
    if (const auto& missing = animator_->surface().left_out; !missing.empty())
        remarks_.push_back(fmt::format("{} of the control surface not there, such as '{}'; its triangles are left out",
                                       base::counted(missing.size(), "corner is", "corners are"), missing.front()));
}

void MocapRig::make_ready(MarkerMethod method, const capture::MarkerSet& set) {
    const bool masks = method == MarkerMethod::bones || method == MarkerMethod::units_bones;
    const bool units = method == MarkerMethod::units || method == MarkerMethod::units_bones;
    if (!masks && !units && !target_.is_scan) return;
    target_.prepare();
    // Any dense model knows the template of these expressions, which is then bent on to the target once.
    const auto& catalogue = facs::builtin_catalogue();
    const auto registrations =
        target_.expressions->model(catalogue, *catalogue.find_expression("12")).dense->registrations;
    parts_ = animation::vertex_parts(*target_.prepared, registrations, set);
    if (units) units_ = builtin::unit_fields(*target_.expressions, catalogue, *target_.prepared);
    if (target_.is_scan && !set.openings.empty()) cut_openings();
}

/// A scan is one surface from lip to lip and from lid to eyeball; what bridges them would be drawn out like a curtain,
/// or folded.
void MocapRig::cut_openings() {
    using animation::LidSheet;
    constexpr std::uint32_t upper = capture::part_bit(0, true), lower = capture::part_bit(0, false);
    const auto lids = animation::lid_sheets(*target_.prepared);
    std::vector<std::uint32_t> sheet;
    for (std::size_t v = 0; v < parts_.size(); ++v) {
        const std::uint32_t lip = parts_[v] == upper ? 1 : parts_[v] == lower ? 2 : 0;
        sheet.push_back(lip + 4 * static_cast<std::uint32_t>(lids[v]));
    }
    const auto& mesh = target_.mesh;
    std::vector<std::uint8_t> bridges(mesh.faces.size(), 0);
    for (std::size_t f = 0; f < bridges.size(); ++f)
        for (const auto a : mesh.faces[f])
            for (const auto b : mesh.faces[f]) {
                const bool lips = sheet[a] % 4 == 1 && sheet[b] % 4 == 2;
                if (lips || (lids[a] != lids[b] && lids[a] != LidSheet::neither && lids[b] != LidSheet::neither))
                    bridges[f] = 1;
            }
    const auto cut = static_cast<std::size_t>(std::count(bridges.begin(), bridges.end(), 1));
    if (cut == 0) return;
    remarks_.push_back(fmt::format("{} between lips and lids cut, so that they can part",
                                   base::counted(cut, "triangle", "triangles")));
    surface_ = animation::open_between_sheets(mesh, bridges, sheet);
    animation::colour_inside(surface_, report::painted_skin);
}

geometry::Mesh MocapRig::moved(std::span<const Vector> displacement_mm) const {
    auto mesh = surface_.mesh;
    for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v)
        mesh.vertices_mm[v] += displacement_mm[surface_.moves_with[v]];
    return mesh;
}

std::vector<double> MocapRig::marker_errors_mm(std::span<const Point> markers_mm,
                                               std::span<const Vector> displacement_mm) const {
    std::vector<double> errors;
    for (std::size_t k = 0; k < places_.size(); ++k) {
        // The label may stand a little off the skin; that is no error of the motion.
        Vector motion = Vector::Zero();
        const auto& corners = target_.triangles[places_[k].triangle];
        for (std::size_t c = 0; c < 3; ++c)
            motion += places_[k].barycentric[static_cast<Eigen::Index>(c)] * displacement_mm[corners[c]];
        errors.push_back((animator_->rest_mm()[k] + motion - markers_mm[k]).norm());
    }
    return errors;
}

}  // namespace mimik::cli
