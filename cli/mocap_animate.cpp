#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "capture/fill_gaps.h"
#include "capture/retarget.h"
#include "capture/stabilise.h"
#include "cli/figure_start.h"
#include "cli/mocap_commands.h"
#include "cli/mocap_output.h"
#include "cli/mocap_target.h"
#include "cli/notes.h"
#include "io/glb.h"
#include "io/json_values.h"
#include "io/mesh_io.h"

namespace mimik::cli {
namespace {

struct AnimateTakeArguments {
    Common common;
    Recording recording;
    MocapTargetArguments target;
    std::filesystem::path output, set, sheet, truth;
    std::string method = "units-bones", format = "vtp";
    std::vector<std::string> jig;
    bool cleaned = false;
    std::size_t every = 1, components = 8, panels = 8;
    capture::RetargetOptions retarget;
    animation::MarkerAnimatorOptions animator;
};

enum class Kind { meshes, glb, video, weights };
Kind kind_of(const std::filesystem::path& output) {
    const auto extension = base::lower_case(output.extension().string());
    if (extension == ".glb") return Kind::glb;
    if (extension == ".mp4") return Kind::video;
    if (extension == ".csv") return Kind::weights;
    if (extension.empty()) return Kind::meshes;
    throw InputError(fmt::format("{}: give a folder (no extension), a .glb, a .mp4 or a .csv", output.string()));
}

void refuse_options_of_other_outputs(const AnimateTakeArguments& arguments, const CLI::App& command) {
    const auto kind = kind_of(arguments.output);
    if (command.count("--components") > 0 && kind != Kind::glb)
        throw InputError(
            fmt::format("--components: serves a .glb, and the output is {}; leave it out", arguments.output.string()));
    if (command.count("--format") > 0 && kind != Kind::meshes)
        throw InputError(fmt::format("--format: serves a folder of meshes, and the output is {}; leave it out",
                                     arguments.output.string()));
}

void check(const AnimateTakeArguments& arguments) {
    const auto method = animation::parse_marker_method(arguments.method);
    if (kind_of(arguments.output) == Kind::weights && method != animation::MarkerMethod::units &&
        method != animation::MarkerMethod::units_bones)
        throw InputError(
            fmt::format("{}: a .csv says how strong AUs are, which --method {} does not; give units or "
                        "units-bones",
                        arguments.output.string(), arguments.method));
    refuse_as_output(arguments.output, {arguments.recording.file, arguments.target.target, arguments.target.landmarks,
                                        arguments.target.markers, arguments.set});
    if (arguments.every < 1) throw InputError("--every: is 0; give 1 for every frame, 2 for every other one");
    if (arguments.components < 1 || arguments.components > io::most_animated_targets)
        throw InputError(
            fmt::format("--components: is {}; give 1 to {}", arguments.components, io::most_animated_targets));
    if (arguments.panels < 1 || arguments.panels > 24) throw InputError("--panels: give 1 to 24");
    if (arguments.cleaned && !arguments.jig.empty())
        throw InputError("--cleaned: says that the head's motion is off; leave --jig out, or --cleaned");
    check_by_option({{"bones.radius_share", "--radius-share"}, {"radius_share", "--radius-share"}},
                    [&] { arguments.animator.bones.check(); });
    check_by_option({{"pull", "--pull"}, {"most", "--most"}}, [&] { arguments.animator.units.check(); });
}

/// The markers of the face without the motion of the head and without gaps.
capture::MarkerSequence cleaned(const AnimateTakeArguments& arguments, const capture::MarkerSequence& take,
                                const capture::MarkerSet& set, std::vector<std::string>& remarks) {
    if (arguments.cleaned) return take;
    const auto add = [&](const std::vector<std::string>& more) {
        remarks.insert(remarks.end(), more.begin(), more.end());
    };
    capture::StabiliseOptions options;
    options.jig = arguments.jig;
    check_by_option({{"jig", "--jig"}}, [&] { options.check(); });
    auto still = capture::stabilise(take, options);
    add(still.remarks);
    std::vector<std::string> face;
    for (const auto& name : take.names())
        if (std::find(arguments.jig.begin(), arguments.jig.end(), name) == arguments.jig.end()) face.push_back(name);
    if (face.empty()) throw InputError("--jig: names every marker; name those of the jig alone");
    auto filled = capture::fill_gaps(capture::with_markers(still.markers, face), set);
    add(filled.remarks);
    return std::move(filled.markers);
}

/// How far made faces are from true ones.
struct TruthScore {
    std::size_t frames = 0;
    double mean_mm = 0, p95_mm = 0, largest_mm = 0;  ///< p95_mm to 0.01 mm, rounded up
    double lips_mm = 0;                              ///< the largest error of a lip vertex, a frame's mean
    std::vector<std::uint32_t> lip_vertices;
};

/// Vertices within 4 mm of a marker or derived point of the lips.
std::vector<std::uint32_t> lip_vertices(const MocapTarget& target) {
    constexpr double near_mm = 4;
    std::vector<std::uint32_t> list;
    for (std::uint32_t v = 0; v < target.mesh.vertices_mm.size(); ++v)
        for (const auto& mark : target.labels.all())
            if ((mark.name.starts_with("lip_") || mark.name.starts_with("mouth_corner")) &&
                (mark.position_mm - target.mesh.vertices_mm[v]).norm() < near_mm) {
                list.push_back(v);
                break;
            }
    return list;
}

/// Errors in bins of 0.01 mm up to 200 mm: memory does not grow with the take.
class ErrorBins {
public:
    void add(double error_mm) {
        const double bin = std::min(error_mm / width_mm, static_cast<double>(bins_.size() - 1));
        ++bins_[bin >= 0 ? static_cast<std::size_t>(bin) : bins_.size() - 1];  // NaN is far off
        ++count_;
        sum_mm_ += error_mm;
        largest_mm_ = std::max(largest_mm_, error_mm);
    }
    [[nodiscard]] double mean_mm() const { return sum_mm_ / static_cast<double>(count_); }
    [[nodiscard]] double largest_mm() const { return largest_mm_; }
    /// The upper end of the bin that the error lies in, and at most the largest.
    [[nodiscard]] double percentile_mm(std::uint64_t percent) const {
        const auto rank = (count_ - 1) * percent / 100;
        std::uint64_t below = 0;
        for (std::size_t k = 0; k + 1 < bins_.size(); ++k)
            if ((below += bins_[k]) > rank) return std::min(width_mm * static_cast<double>(k + 1), largest_mm_);
        return largest_mm_;
    }

private:
    static constexpr double width_mm = 0.01;
    std::vector<std::uint64_t> bins_ = std::vector<std::uint64_t>(20'001);  // the last: 200 mm and more
    std::uint64_t count_ = 0;
    double sum_mm_ = 0, largest_mm_ = 0;
};

TruthScore score(const std::filesystem::path& folder, const MocapMotion& motion) {
    const auto& target = motion.rig().target();
    TruthScore result;
    result.lip_vertices = lip_vertices(target);
    std::vector<geometry::Vector> displacement(target.mesh.vertices_mm.size());
    ErrorBins bins;
    std::vector<double> errors(displacement.size());
    for (std::size_t f = 0; f < motion.frames(); ++f) {
        const auto file = folder / fmt::format("frame_{:06}.ply", motion.number(f));
        if (!std::filesystem::exists(file)) continue;
        const auto truth = io::read_mesh(file).vertices_mm;
        if (truth.size() != displacement.size())
            throw InputError(fmt::format("{}: has {} vertices, and the target {}; give the truth of this mesh",
                                         file.string(), truth.size(), displacement.size()));
        motion.displace(f, displacement);
        double largest = 0;
        for (std::size_t v = 0; v < truth.size(); ++v) {
            errors[v] = (target.mesh.vertices_mm[v] + displacement[v] - truth[v]).norm();
            bins.add(errors[v]);
        }
        for (const auto v : result.lip_vertices) largest = std::max(largest, errors[v]);
        result.lips_mm += largest;
        ++result.frames;
    }
    if (result.frames == 0)
        throw InputError(
            fmt::format("--truth: {} has no frame_NNNNNN.ply of a frame of the recording", folder.string()));
    result.lips_mm /= static_cast<double>(result.frames);
    result.mean_mm = bins.mean_mm();
    result.p95_mm = bins.percentile_mm(95);
    result.largest_mm = bins.largest_mm();
    return result;
}

/// Root mean square over the frames, per marker.
std::vector<double> marker_errors(const MocapMotion& motion, std::size_t every) {
    std::vector<double> squares(motion.rig().tracked().size(), 0.0);
    std::vector<geometry::Vector> displacement(motion.rig().animator().vertices());
    std::size_t count = 0;
    for (std::size_t f = 0; f < motion.frames(); f += every) {
        motion.displace(f, displacement);
        const auto errors = motion.rig().marker_errors_mm(motion.markers_mm(f), displacement);
        for (std::size_t k = 0; k < errors.size(); ++k) squares[k] += errors[k] * errors[k];
        ++count;
    }
    for (auto& one : squares) one = std::sqrt(one / static_cast<double>(count));
    return squares;
}

struct Result {
    std::vector<MocapWritten> written;
    std::vector<double> marker_error_mm;
    std::optional<TruthScore> truth;
    std::int64_t rest_frame = 0;
    double scale = 1;
};

nlohmann::json as_json(const AnimateTakeArguments& arguments, const MocapMotion& motion, const Result& result,
                       const std::vector<std::string>& remarks) {
    auto markers = nlohmann::json::array();
    for (std::size_t k = 0; k < result.marker_error_mm.size(); ++k)
        markers.push_back({{"marker", motion.rig().tracked()[k]}, {"rms_mm", result.marker_error_mm[k]}});
    nlohmann::json document = {{"schema", 1},
                               {"output", arguments.output.string()},
                               {"target", motion.rig().target().name},
                               {"method", arguments.method},
                               {"frames", motion.frames()},
                               {"rate_hz", motion.rate_hz()},
                               {"rest_frame", result.rest_frame},
                               {"scale", result.scale},
                               {"marker_error", std::move(markers)},
                               {"remarks", remarks}};
    if (const auto& glb = result.written.front(); glb.bound_mm)
        document["components"] = {
            {"count", glb.components}, {"largest_error_mm", *glb.bound_mm}, {"rms_error_mm", *glb.rms_mm}};
    if (result.truth)
        document["truth"] = {{"frames", result.truth->frames},
                             {"mean_mm", result.truth->mean_mm},
                             {"p95_mm", result.truth->p95_mm},
                             {"largest_mm", result.truth->largest_mm},
                             {"lip_vertex_error_mm", result.truth->lips_mm},
                             {"lip_vertices", result.truth->lip_vertices}};
    return document;
}

void print(const AnimateTakeArguments& arguments, const MocapMotion& motion, const Result& result) {
    const auto worst = std::max_element(result.marker_error_mm.begin(), result.marker_error_mm.end());
    const double mean = std::accumulate(result.marker_error_mm.begin(), result.marker_error_mm.end(), 0.0) /
                        static_cast<double>(result.marker_error_mm.size());
    std::cout << fmt::format("{}: {} on {} by {}: {}\n", arguments.output.string(),
                             base::counted(motion.frames(), "frame"), motion.rig().target().name, arguments.method,
                             result.written.front().what);
    std::cout << fmt::format(
        "{}: rest in frame {}, lengths times {:.3f}; the skin is {:.2f} mm (rms) from its marker in the mean, {:.2f} "
        "at '{}'\n",
        base::counted(motion.rig().tracked().size(), "marker"), result.rest_frame, result.scale, mean, *worst,
        motion.rig().tracked()[static_cast<std::size_t>(worst - result.marker_error_mm.begin())]);
    if (result.truth)
        std::cout << fmt::format(
            "against the truth of {}: {:.3f} mm in the mean, 95 % within {:.3f}, {:.3f} at most; the worst of {} lip "
            "vertices {:.3f} mm in a frame's mean\n",
            base::counted(result.truth->frames, "frame"), result.truth->mean_mm, result.truth->p95_mm,
            result.truth->largest_mm, result.truth->lip_vertices.size(), result.truth->lips_mm);
    if (result.written.size() > 1)
        std::cout << fmt::format("{}: {}\n", arguments.sheet.string(), result.written.back().what);
}

/// Markers of the recording that the target has labels of.
std::vector<std::string> tracked(const capture::MarkerSequence& markers, const geometry::Landmarks& labels) {
    std::vector<std::string> names;
    for (const auto& name : markers.names())
        if (labels.find(name)) names.push_back(name);
    if (names.empty())
        throw InputError(
            fmt::format("no marker of the recording has a label on the target: there is '{}' here and '{}' there; "
                        "rename one (--markers, or 'mimik mocap convert' to CSV)",
                        markers.names().front(), labels.all().front().name));
    return names;
}

int run_animate_take(const AnimateTakeArguments& arguments) {
    check(arguments);
    const auto kind = kind_of(arguments.output);
    if (kind == Kind::video) (void)find_video_program();
    const auto set = arguments.set.empty() ? capture::builtin_marker_set() : capture::read_marker_set(arguments.set);
    const auto file = arguments.recording.read();
    auto remarks = file.remarks;
    auto target = read_mocap_target(arguments.target, set);
    const auto face = cleaned(arguments, file.markers, set, remarks);
    Result result;
    std::optional<capture::Retargeted> there;
    check_by_option({{"rest_frame", "--rest-frame"}},
                    [&] { there = capture::retarget(face, target.labels, arguments.retarget); });
    result.rest_frame = there->rest_frame;
    result.scale = there->scale;
    remarks.insert(remarks.end(), there->remarks.begin(), there->remarks.end());
    remarks.insert(remarks.end(), target.remarks.begin(), target.remarks.end());
    auto names = tracked(there->markers, target.labels);
    const MocapRig rig(std::move(target), animation::parse_marker_method(arguments.method), set, std::move(names),
                       arguments.animator);
    remarks.insert(remarks.end(), rig.remarks().begin(), rig.remarks().end());
    const MocapMotion motion(rig, there->markers);
    if (motion.held() > 0)
        remarks.push_back(fmt::format("{} still missing: the marker holds still where it was last",
                                      base::counted(motion.held(), "sample is", "samples are")));
    if (kind == Kind::glb)
        result.written.push_back(write_moving_glb(arguments.output, motion, arguments.every, arguments.components));
    else if (kind == Kind::weights)
        result.written.push_back(write_live_link(arguments.output, motion, arguments.every));
    else if (kind == Kind::video)
        result.written.push_back(write_mocap_video(arguments.output, motion, arguments.every, arguments.common));
    else
        result.written.push_back(
            write_meshes(arguments.output, arguments.format, motion, arguments.every, arguments.common));
    if (!arguments.sheet.empty())
        result.written.push_back(write_sheet(arguments.sheet, motion, face, set, arguments.panels));
    for (const auto& one : result.written) remarks.insert(remarks.end(), one.remarks.begin(), one.remarks.end());
    result.marker_error_mm = marker_errors(motion, arguments.every);
    if (!arguments.truth.empty()) result.truth = score(arguments.truth, motion);
    if (arguments.common.json) {
        std::cout << io::json_text(as_json(arguments, motion, result, remarks));
        return exit_done;
    }
    if (!arguments.common.quiet) say_notes(remarks);
    print(arguments, motion, result);
    return exit_done;
}

void add_output_options(CLI::App& command, AnimateTakeArguments& arguments) {
    command
        .add_option("-o,--output", arguments.output,
                    "Folder of meshes frame_000001.vtp ..., a .glb whose morph weights move, a .mp4, or a .csv: "
                    "strengths of AUs as Live Link Face writes them")
        ->required();
    command.add_option("--format", arguments.format, "Of the meshes in a folder: vtp or ply")
        ->check(CLI::IsMember({"vtp", "ply"}))
        ->capture_default_str();
    command.add_option("--every", arguments.every, "Only every so manyth frame")->capture_default_str();
    command.add_option("--components", arguments.components, "Of a .glb: morph targets, 1 to 256")
        ->capture_default_str();
    command.add_option("--sheet", arguments.sheet, "A contact sheet, too: markers above, faces below (.png)");
    command.add_option("--panels", arguments.panels, "Frames on the contact sheet")->capture_default_str();
    command.add_option(
        "--truth", arguments.truth,
        "Folder of true faces frame_000001.ply ...: say how far the made ones are from them, percentiles to 0.01 mm");
}

}  // namespace

void add_mocap_animate(CLI::App& group, int& exit_code) {
    auto* command = group.add_subcommand("animate", "Put a recording on a face: meshes, a moving .glb, a video");
    auto arguments = std::make_shared<AnimateTakeArguments>();
    arguments->recording.add_options(*command);
    command
        ->add_option("--target", arguments->target.target,
                     "The face: a mesh at rest (with --landmarks), or WORK:bs003, a subject of a workspace")
        ->required();
    command->add_option("--landmarks", arguments->target.landmarks, "Of the mesh (docs/landmarks.md)");
    command->add_option("--markers", arguments->target.markers,
                        "Where the markers are on the face, by name (default: placed by the landmarks)");
    command->add_option("--mesh-unit", arguments->target.unit, "Of the mesh and its points: mm, cm, m or inch")
        ->capture_default_str();
    command->add_option("--set", arguments->set, "Marker set (.toml; default: 'mimik mocap markers')");
    command
        ->add_option("--method", arguments->method,
                     "still, nearest, rbf, open-bones, bones, units, units-bones (docs/algorithms/planar_bones.md)")
        ->capture_default_str();
    command->add_option("--jig", arguments->jig, "Markers that move with the skull")->delimiter(',');
    command->add_flag("--cleaned", arguments->cleaned, "The head's motion is off already ('mimik mocap clean')");
    command->add_option("--rest-frame", arguments->retarget.rest_frame,
                        "Frame of the relaxed face (default: the first with the most markers)");
    command
        ->add_option("--radius-share", arguments->animator.bones.radius_share,
                     "Reach of a bone, in shortest edges at its corners")
        ->capture_default_str();
    command->add_option("--pull", arguments->animator.units.pull, "How much the strengths of AUs are held down")
        ->capture_default_str();
    add_output_options(*command, *arguments);
    add_common_options(*command, arguments->common);
    command->callback([arguments, command, &exit_code] {
        refuse_options_of_other_outputs(*arguments, *command);
        exit_code = run_animate_take(*arguments);
    });
}

}  // namespace mimik::cli
