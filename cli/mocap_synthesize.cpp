#include <iostream>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "capture/motion_file.h"
#include "cli/mocap_commands.h"
#include "io/json_values.h"
#include "io/landmark_io.h"
#include "io/mesh_io.h"
#include "synthesis/performance.h"
#include "synthesis/synthesize.h"

namespace mimik::cli {
namespace {

struct SynthesizeTakesArguments {
    Common common;
    std::filesystem::path out;
    std::string face_model;
    std::size_t truth_every = 60;
    synthesis::PerformanceOptions options;
};

geometry::Mesh mesh_of(const synthesis::Performer& performer, std::span<const geometry::Vector> motion_mm) {
    geometry::Mesh mesh;
    mesh.vertices_mm = performer.resting_mm();
    for (std::size_t v = 0; v < motion_mm.size(); ++v) mesh.vertices_mm[v] += motion_mm[v];
    for (const auto& triangle : performer.triangles()) mesh.faces.add(triangle);
    return mesh;
}

void write_face(const std::filesystem::path& stem, const synthesis::Performer& performer) {
    (void)io::write_mesh(stem.string() + ".ply", mesh_of(performer, {}));
    io::write_landmarks(stem.string() + "_landmarks.csv", performer.landmarks());
    io::write_landmarks(stem.string() + "_markers.csv", performer.labels());
}

void write_score(const std::filesystem::path& file, const synthesis::Score& score) {
    base::write_atomically(file, [&](std::ostream& out) {
        out << "frame";
        for (const auto& unit : score.units) out << ",AU" << unit.code;
        out << '\n';
        for (std::size_t f = 0; f < score.frames(); ++f) {
            out << f + 1;
            for (const double strength : score.strength[f]) out << ',' << fmt::format("{}", strength);
            out << '\n';
        }
    });
}

/// @return how many faces
std::size_t write_truth(const std::filesystem::path& folder, const synthesis::Performer& performer,
                        const synthesis::Score& score, std::size_t every) {
    std::size_t count = 0;
    for (std::size_t f = 0; every > 0 && f < score.frames(); f += every, ++count)
        (void)io::write_mesh(folder / fmt::format("frame_{:06}.ply", f + 1),
                             mesh_of(performer, performer.motion_mm(score.units, score.strength[f])));
    return count;
}

int run_synthesize_takes(const SynthesizeTakesArguments& arguments) {
    check_by_option({{"rate_hz", "--rate"},
                     {"seconds", "--seconds"},
                     {"noise_mm", "--noise"},
                     {"drop_outs_a_minute", "--drop-outs"}},
                    [&] { arguments.options.check(); });
    synthesis::check_database_place(arguments.out);
    const auto model = arguments.face_model.empty() ? synthesis::make_builtin_face_model()
                                                    : synthesis::load_ict_face_model(arguments.face_model);
    const synthesis::Performer source(*model, "source", arguments.options.seed);
    const synthesis::Performer target(*model, "target", arguments.options.seed);
    const auto units = synthesis::units_that_show(*model);
    const auto ramps = synthesis::ramped_score(units, arguments.options);
    const auto speech = synthesis::spoken_score(units, arguments.options);
    const auto& out = arguments.out;
    write_face(out / "source", source);
    write_face(out / "target", target);
    capture::write_motion(out / "recording_a.c3d", synthesis::exact_recording(source, ramps));
    capture::write_motion(out / "recording_b.c3d", synthesis::laboratory_recording(source, speech, arguments.options));
    write_score(out / "strengths_a.csv", ramps);
    write_score(out / "strengths_b.csv", speech);
    std::size_t truths = 0;
    for (const auto* performer : {&source, &target}) {
        truths +=
            write_truth(out / fmt::format("truth_a_{}", performer->name()), *performer, ramps, arguments.truth_every);
        truths +=
            write_truth(out / fmt::format("truth_b_{}", performer->name()), *performer, speech, arguments.truth_every);
    }
    if (arguments.common.json) {
        std::cout << io::json_text(nlohmann::json{{"schema", 1},
                                                  {"folder", out.string()},
                                                  {"face_model", model->name()},
                                                  {"units", units.size()},
                                                  {"frames_a", ramps.frames()},
                                                  {"frames_b", speech.frames()},
                                                  {"truths", truths}});
        return exit_done;
    }
    std::cout << fmt::format("{}: {} ({}), 68 markers and a jig of 7; recording A {}, B {}; {} true faces\n",
                             out.string(), base::counted(units.size(), "AU"), model->name(),
                             base::counted(ramps.frames(), "frame"), base::counted(speech.frames(), "frame"), truths);
    return exit_done;
}

}  // namespace

void add_mocap_synthesize(CLI::App& group, int& exit_code) {
    auto* command = group.add_subcommand(
        "synthesize", "Make recordings with a truth: a source who acts, and how a target would look doing the same");
    auto arguments = std::make_shared<SynthesizeTakesArguments>();
    command->add_option("OUT", arguments->out, "New folder")->required();
    command->add_option("--face-model", arguments->face_model,
                        "Folder of ICT-FaceKit (its FaceXModel or the parent); without it the built-in model");
    auto& options = arguments->options;
    command->add_option("--rate", options.rate_hz, "Frames a second")->capture_default_str();
    command->add_option("--seconds", options.seconds, "Length of recording B")->capture_default_str();
    command->add_option("--noise", options.noise_mm, "Of recording B, mm")->capture_default_str();
    command->add_option("--drop-outs", options.drop_outs_a_minute, "Of each marker in recording B, a minute")
        ->capture_default_str();
    command
        ->add_option("--truth-every", arguments->truth_every, "True faces of every so manyth frame, as meshes; 0: none")
        ->capture_default_str();
    add_seed_option(*command, options.seed);
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run_synthesize_takes(*arguments); });
}

}  // namespace mimik::cli
