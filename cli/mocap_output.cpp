#include "cli/mocap_output.h"

#include <algorithm>

#include <fmt/format.h>

#include "animation/arkit_weights.h"
#include "animation/motion_components.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/output_folder.h"
#include "base/temporary.h"
#include "base/text.h"
#include "base/version.h"
#include "capture/control_surface.h"
#include "capture/live_link.h"
#include "cli/figure_start.h"
#include "facs/facs_catalogue.h"
#include "io/glb.h"
#include "io/landmark_io.h"
#include "io/mesh_io.h"
#include "report/figure_description.h"

namespace mimik::cli {

using geometry::Point;
using geometry::Vector;

namespace {

io::MadeBy made_by(const MocapMotion& motion) {
    io::MadeBy made = {{"made_by", fmt::format("Mimik {} mocap animate", base::version())},
                       {"target", motion.rig().target().name},
                       {"method", animation::to_string(motion.rig().animator().method())}};
    const auto& origin = motion.rig().target().made_by;
    made.insert(made.end(), origin.begin(), origin.end());
    return made;
}

geometry::Mesh frame_mesh(const MocapMotion& motion, std::size_t frame, bool with_displacement) {
    std::vector<Vector> displacement(motion.rig().animator().vertices());
    motion.displace(frame, displacement);
    auto mesh = motion.rig().moved(displacement);
    if (with_displacement) {
        geometry::VertexAttribute values{"displacement_mm", 3, {}};
        for (const auto v : motion.rig().surface().moves_with)
            values.values.insert(values.values.end(), displacement[v].begin(), displacement[v].end());
        mesh.attributes.push_back(std::move(values));
    }
    return mesh;
}

std::size_t thinned(std::size_t frames, std::size_t every) { return (frames + every - 1) / every; }

}  // namespace

MocapMotion::MocapMotion(const MocapRig& rig, const capture::MarkerSequence& markers)
    : rig_(rig), markers_(capture::with_markers(markers, rig.tracked())) {
    for (std::size_t k = 0; k < markers_.markers(); ++k) {
        Point last = rig.animator().rest_mm()[k];
        for (std::size_t f = 0; f < markers_.frames(); ++f) {
            if (markers_.valid(f, k)) {
                last = markers_.at_mm(f, k);
            } else {
                markers_.set(f, k, last);
                ++held_;
            }
        }
    }
}

void MocapMotion::displace(std::size_t frame, std::span<Vector> displacement_mm) const {
    rig_.animator().displace(markers_.frame_mm(frame), displacement_mm);
}

MocapWritten write_meshes(const std::filesystem::path& folder, const std::string& extension, const MocapMotion& motion,
                          std::size_t every, const Common& common) {
    base::check_takes_files(folder);
    io::MeshWriteOptions options;
    options.made_by = made_by(motion);
    MocapWritten written;
    Progress progress(common, "animate", thinned(motion.frames(), every));
    for (std::size_t f = 0; f < motion.frames(); f += every) {
        const auto file = folder / fmt::format("frame_{:06}.{}", motion.number(f), extension);
        for (auto& remark : io::write_mesh(file, frame_mesh(motion, f, true), options))
            if (f == 0) written.remarks.push_back(std::move(remark));
        progress.advance();
    }
    written.what = base::counted(thinned(motion.frames(), every), "mesh", "meshes");
    return written;
}

MocapWritten write_moving_glb(const std::filesystem::path& file, const MocapMotion& motion, std::size_t every,
                              std::size_t components) {
    animation::MotionComponentsOptions options;
    options.components = components;
    const auto frames = thinned(motion.frames(), every);
    const auto parts = animation::motion_components(
        frames, motion.rig().animator().vertices(),
        [&](std::size_t frame, std::span<Vector> displacement) { motion.displace(frame * every, displacement); },
        options);
    std::vector<std::uint32_t> source;
    const auto& surface = motion.rig().surface();
    auto glb = io::glb_mesh(surface.mesh, &source);
    io::WeightAnimation weights;
    for (std::size_t c = 0; c < parts.shapes_mm.size(); ++c) {
        io::MorphTarget target{fmt::format("component_{}", c + 1), {}, parts.weights.front()[c], {}};
        for (const auto v : source) target.displacement_mm.push_back(parts.shapes_mm[c][surface.moves_with[v]]);
        glb.morph_targets.push_back(std::move(target));
    }
    for (std::size_t f = 0; f < frames; ++f) {
        weights.times_s.push_back(static_cast<double>(f * every) / motion.rate_hz());
        weights.weights.insert(weights.weights.end(), parts.weights[f].begin(), parts.weights[f].end());
    }
    MocapWritten written;
    if (!glb.morph_targets.empty() && frames > 1) glb.animation = std::move(weights);
    glb.asset_extras = made_by(motion);
    written.remarks = io::animation_remarks(glb);
    io::write_glb(base::where_links_lead(file), glb);
    written.components = parts.shapes_mm.size();
    written.bound_mm = parts.largest_error_mm;
    written.rms_mm = parts.rms_error_mm;
    written.what = fmt::format("{} of {}; no vertex is more than {:.3f} mm off in any frame ({:.3f} rms)",
                               base::counted(frames, "frame"), base::counted(written.components, "component"),
                               parts.largest_error_mm, parts.rms_error_mm);
    return written;
}

MocapWritten write_live_link(const std::filesystem::path& file, const MocapMotion& motion, std::size_t every) {
    const auto& rig = motion.rig();
    std::vector<std::vector<double>> strengths;
    for (std::size_t f = 0; f < motion.frames(); f += every)
        strengths.push_back(rig.animator().weights(motion.markers_mm(f)));
    auto shapes = animation::arkit_weights(facs::builtin_catalogue(), rig.units().names, strengths,
                                           motion.rate_hz() / static_cast<double>(every));
    const auto text = capture::encode_live_link_csv(shapes);
    // The format does not say its rate: who reads it counts the frames of a second.
    const double counted_hz = capture::decode_live_link_csv(text, file.string()).rate_hz;
    base::write_atomically(base::where_links_lead(file), text);
    MocapWritten written;
    written.remarks = std::move(shapes.remarks);
    if (counted_hz != shapes.rate_hz)
        written.remarks.push_back(
            fmt::format("{}: has {:g} frames a second, and its timecodes look like {:g}; read it with --rate {:g}",
                        file.string(), shapes.rate_hz, counted_hz, shapes.rate_hz));
    written.what = fmt::format("{}, {} of the 61 channels of Live Link Face", base::counted(strengths.size(), "row"),
                               shapes.shapes.size());
    return written;
}

MocapWritten write_mocap_video(const std::filesystem::path& file, const MocapMotion& motion, std::size_t every,
                               const Common& common) {
    (void)find_video_program();  // before the work
    (void)find_figure_program();
    const base::TemporaryFolder folder(file.parent_path());
    const auto pictures = folder.path() / "frames";
    std::filesystem::create_directories(pictures);
    Progress progress(common, "draw", thinned(motion.frames(), every));
    // One camera for all frames: it looks at the middle of the face at rest, and leaves room for a jaw that drops.
    const auto labels = motion.rig().target().labels.all();
    Point low = labels.front().position_mm, high = low;
    for (const auto& mark : labels) {
        low = low.cwiseMin(mark.position_mm);
        high = high.cwiseMax(mark.position_mm);
    }
    std::size_t count = 0;
    for (std::size_t f = 0; f < motion.frames(); f += every) {
        const auto mesh = folder.path() / "frame.ply", description = folder.path() / "frame.json";
        (void)io::write_mesh(mesh, frame_mesh(motion, f, false));
        report::FigureDescription figure;
        figure.page.panel_width_px = 640;
        figure.page.panel_height_px = 720;
        figure.page.height_mm = 1.7 * (high - low).y();
        report::PanelDescription panel;
        panel.mesh = mesh;
        panel.centre_mm = Point(0.5 * (low + high));
        figure.panels = {panel};
        report::write_figure_description(description, figure);
        if (const auto fault = draw_figure(description, pictures / fmt::format("{:06}.png", count++)); !fault.empty())
            throw InputError(fault);
        progress.advance();
    }
    if (const auto fault = write_video(pictures, file, motion.rate_hz() / static_cast<double>(every)); !fault.empty())
        throw InputError(fmt::format("{}: not written: {}", file.string(), fault));
    return {base::counted(count, "picture"), {}, {}, 0, {}};
}

MocapWritten write_sheet(const std::filesystem::path& picture, const MocapMotion& motion,
                         const capture::MarkerSequence& source, const capture::MarkerSet& set, std::size_t panels) {
    (void)find_figure_program();
    const base::TemporaryFolder folder(picture.parent_path());
    const auto surface = capture::control_surface(set, source.names());
    report::FigureDescription figure;
    figure.page.columns = static_cast<int>(panels);
    figure.page.panel_width_px = 260;
    figure.page.panel_height_px = 330;
    figure.page.framing = figures::Framing::own;
    std::vector<report::PanelDescription> above, below;
    for (std::size_t k = 0; k < panels; ++k) {
        const auto f = panels > 1 ? k * (motion.frames() - 1) / (panels - 1) : 0;
        geometry::Mesh control;
        control.vertices_mm.assign(source.frame_mm(f).begin(), source.frame_mm(f).end());
        std::vector<geometry::Landmark> balls;
        for (std::size_t m = 0; m < source.markers(); ++m)
            if (source.valid(f, m)) balls.push_back({source.names()[m], source.at_mm(f, m), ""});
        for (const auto& t : surface.triangles)
            if (source.valid(f, t[0]) && source.valid(f, t[1]) && source.valid(f, t[2])) control.faces.add(t);
        const auto stem = fmt::format("{:02}", k);
        report::PanelDescription markers, face;
        markers.mesh = folder.path() / (stem + "_markers.ply");
        markers.landmarks = folder.path() / (stem + "_markers.csv");
        face.mesh = folder.path() / (stem + "_face.ply");
        face.caption = fmt::format("{:.2f} s", static_cast<double>(f) / motion.rate_hz());
        (void)io::write_mesh(markers.mesh, control);
        io::write_landmarks(markers.landmarks, geometry::Landmarks(std::move(balls)));
        (void)io::write_mesh(face.mesh, frame_mesh(motion, f, false));
        above.push_back(std::move(markers));
        below.push_back(std::move(face));
    }
    figure.panels = std::move(above);
    figure.panels.insert(figure.panels.end(), below.begin(), below.end());
    report::write_figure_description(folder.path() / "sheet.json", figure);
    if (const auto fault = draw_figure(folder.path() / "sheet.json", picture); !fault.empty()) throw InputError(fault);
    return {fmt::format("a contact sheet of {}", base::counted(panels, "frame")), {}, {}, 0, {}};
}

}  // namespace mimik::cli
