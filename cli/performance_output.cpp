#include "cli/performance_output.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "animation/blend_examples.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/output_folder.h"
#include "base/parallel.h"
#include "base/temporary.h"
#include "base/text.h"
#include "cli/figure_start.h"
#include "io/glb.h"
#include "io/image.h"
#include "report/shaded_face.h"

namespace mimik::cli {
namespace {

std::string kind_of(const std::filesystem::path& output) { return base::lower_case(output.extension().string()); }

std::vector<std::vector<geometry::Vector>> displacements(const animation::FacialExamples& character) {
    std::vector<std::vector<geometry::Vector>> all;
    for (const auto& example : character.examples) all.push_back(example.displacement_mm);
    return all;
}

std::vector<std::string> write_moving_glb(const std::filesystem::path& file, const Performance& performance) {
    const auto& character = performance.character;
    std::vector<std::string> remarks;
    auto neutral = character.neutral;
    neutral.attributes.clear();  // what they say is of the face at rest
    std::vector<std::uint32_t> source;
    auto mesh = io::glb_mesh(neutral, &source);
    mesh.name = file.stem().string();
    if (!mesh.texture_coordinates.empty() && !character.texture_file.empty()) {
        try {
            mesh.texture_png = io::read_as_png(character.texture_file);
        } catch (const InputError& e) {
            remarks.push_back(fmt::format("the face has no picture: {}", e.what()));
        }
    }
    mesh.asset_extras = performance.made_by;
    for (const auto& example : character.examples) {
        io::MorphTarget morph{example.name, {}, 0.0, example.arkit.size() == 1 ? example.arkit.front() : ""};
        morph.displacement_mm.reserve(source.size());
        for (const auto v : source) morph.displacement_mm.push_back(example.displacement_mm[v]);
        mesh.morph_targets.push_back(std::move(morph));
    }
    io::WeightAnimation animation{"performance", performance.times_s, {}};
    animation.weights.reserve(static_cast<std::size_t>(performance.weights.size()));
    for (Eigen::Index frame = 0; frame < performance.weights.rows(); ++frame)
        for (const double weight : performance.weights.row(frame)) animation.weights.push_back(weight);
    mesh.animation = std::move(animation);
    for (auto& remark : io::animation_remarks(mesh)) remarks.push_back(fmt::format("{}: {}", file.string(), remark));
    if (performance.wires)
        remarks.push_back(fmt::format("{}: a GLB blends vertices; pictures and video show the wires", file.string()));
    io::write_glb(file, mesh);
    return remarks;
}

void write_pictures(const std::filesystem::path& folder, const Performance& performance, const Common& common) {
    const auto& character = performance.character;
    io::Image texture;
    if (!character.texture_file.empty()) texture = io::read_image(character.texture_file);
    report::ShadedFaceOptions options;
    options.width = options.height = performance.picture_size;
    const report::FacePainter painter(character.neutral, std::move(texture), options);
    const animation::ExampleBlender blender(character.neutral.vertices_mm, displacements(character));
    const auto frames = static_cast<std::size_t>(performance.weights.rows());
    Progress progress(common, "frames", frames);
    base::parallel_for_each(frames, [&](std::size_t frame) {
        const Eigen::VectorXd row = performance.weights.row(static_cast<Eigen::Index>(frame));
        const std::span<const double> weights(row.data(), static_cast<std::size_t>(row.size()));
        std::vector<geometry::Point> vertices_mm(character.neutral.vertices_mm.size());
        if (performance.wires)
            vertices_mm = performance.wires->blended(weights);
        else
            blender.blend(weights, vertices_mm);
        io::write_png(folder / fmt::format("frame_{:06}.png", frame), painter.picture(vertices_mm));
        progress.advance();
    });
}

}  // namespace

void check_performance_output(const std::filesystem::path& output) {
    const auto kind = kind_of(output);
    if (kind == ".mp4") {
        (void)find_video_program();
    } else if (kind != ".glb" && !kind.empty()) {
        throw InputError(fmt::format("{}: a performance is written as .glb, .mp4 or pictures in a folder, not '{}'",
                                     output.string(), kind));
    }
    const auto folder = kind.empty() ? output : output.parent_path();
    if (!folder.empty()) base::check_takes_files(folder);
}

int check_clip(const std::filesystem::path& clip, const std::filesystem::path& output, std::size_t frames) {
    std::error_code none;
    if (std::filesystem::is_directory(clip, none))
        throw InputError(fmt::format("--video {}: is a folder; give a video file", clip.string()));
    if (!std::filesystem::is_regular_file(clip, none))
        throw InputError(fmt::format("--video {}: there is no such file", clip.string()));
    const base::TemporaryFolder folder(output.parent_path());
    const auto said = folder.path() / "clip.json";
    const auto fault = run_program(find_video_program(),
                                   {"mimik-video", "look", std::filesystem::absolute(clip), "--output", said.string()});
    if (!fault.empty()) throw InputError(fmt::format("--video {}: cannot be read: {}", clip.string(), fault));
    const auto facts = nlohmann::json::parse(base::read_text(said));
    const auto held = facts.at("frames").get<std::size_t>();
    if (held > 0 && held < frames)
        throw InputError(
            fmt::format("--video {}: ends at frame {}, before the performance of {} frames; is it the video that the "
                        "motion was captured from?",
                        clip.string(), held, frames));
    return facts.at("height_beside").get<int>();
}

std::vector<std::string> write_performance(const std::filesystem::path& output,
                                           const std::vector<Performance>& performances,
                                           const PerformerVideo& performer, const Common& common) {
    const auto& first = performances.front();
    if (kind_of(output) == ".glb") return write_moving_glb(output, first);
    if (kind_of(output) != ".mp4") {
        write_pictures(output, first, common);
        return {};
    }
    const auto program = find_video_program();  // before the work
    const base::TemporaryFolder folder(output.parent_path());
    std::vector<std::string> words = {"mimik-video",   "write", (folder.path() / "0").string(),
                                      output.string(), "--fps", fmt::format("{:g}", first.rate_hz),
                                      "--quiet"};
    for (std::size_t k = 0; k < performances.size(); ++k) {
        const auto pictures = folder.path() / std::to_string(k);
        std::filesystem::create_directory(pictures);
        write_pictures(pictures, performances[k], common);
        if (k > 0) words.insert(words.end(), {"--beside", pictures.string()});
    }
    if (!performer.clip.empty()) {
        const auto table = folder.path() / "motion.csv";
        capture::write_feature_motion(table, *performer.motion);
        words.insert(words.end(), {"--performer", performer.clip.string(), "--motion", table.string()});
    }
    const auto fault = run_program(program, std::move(words));
    if (!fault.empty()) throw InputError(fmt::format("{}: not written: {}", output.string(), fault));
    return {};
}

}  // namespace mimik::cli
