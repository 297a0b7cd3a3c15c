#include <algorithm>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

#include "animation/torn_faces.h"
#include "base/errors.h"
#include "base/output_folder.h"
#include "base/text.h"
#include "cli/animate_job.h"
#include "cli/error_report.h"
#include "database/doctor.h"
#include "database/file_origin.h"
#include "database/hidden_subjects.h"
#include "io/landmark_io.h"
#include "io/mesh_io.h"
#include "io/warp_file.h"

namespace mimik::cli {
namespace {

/// @param at_any_magnitude  whatever the expressions are set to: morph targets can be moved
std::ptrdiff_t count_torn(const geometry::Mesh& mesh, const animation::AnimatedFace& animated, bool at_any_magnitude) {
    const auto torn = at_any_magnitude ? animation::torn_faces_of_any_shape(animated, mesh.faces)
                                       : animation::torn_faces(animated, animated.field.mm, mesh.faces);
    return std::count(torn.begin(), torn.end(), 1);
}

/// Whoever the mesh shows, by what it says of itself, is heeded in what is made of it, too.
void carry_origin(const AnimateArguments& arguments, io::MadeBy& made_by) {
    std::vector<std::filesystem::path> files = {arguments.mesh, arguments.landmarks};
    for (const auto& typed : arguments.model_files)
        files.emplace_back(std::filesystem::exists(typed) ? typed : facs::split_magnitude(typed).text);
    for (auto& saying : database::said_in_files(database::origin_to_carry(files))) {
        const auto said = std::find_if(made_by.begin(), made_by.end(),
                                       [&](const auto& entry) { return entry.first == saying.first; });
        if (said == made_by.end())
            made_by.push_back(std::move(saying));
        else if (saying.first == "subjects")
            said->second += " " + saying.second;
    }
}

/// The one image of a mesh that goes into a GLB; empty with a remark where there is another number, or it may not be
/// handed on.
std::filesystem::path glb_texture(const AnimateArguments& arguments, const io::MeshFile& file,
                                  std::vector<std::string>& remarks) {
    if (file.texture_files.size() > 1)
        remarks.push_back(
            fmt::format("{}: a GLB of a mesh of your own holds one picture, and this mesh has {}; .ply "
                        "and .obj keep them",
                        arguments.output, file.texture_files.size()));
    if (file.texture_files.size() != 1) return {};
    const auto folder = arguments.mesh.parent_path();
    auto image = folder / file.texture_files.front();
    database::refuse_hidden_file(image);
    try {
        (void)io::checked_image(image, folder, arguments.mesh.string());
    } catch (const InputError& e) {
        remarks.emplace_back(e.what());
        return {};
    }
    return image;
}

/// A face of another size than people's is in another unit, and no length of it would be in millimetres.
void refuse_other_unit(const AnimateArguments& arguments, const OwnMesh& own) {
    database::LoadedScan loaded;
    loaded.entry.scan_file = arguments.mesh;
    loaded.scan.points_mm = own.file.mesh.vertices_mm;
    loaded.scan.faces = own.file.mesh.faces;
    loaded.landmarks = own.landmarks;
    for (const auto& finding : database::reasons_to_refuse(loaded))
        if (finding.kind == "unit")
            throw InputError(
                fmt::format("{}: {}; say the unit of the mesh and its landmarks with --unit mm, cm, m or "
                            "inch, or scale both",
                            arguments.mesh.string(), finding.what));
}

void write_moved(const AnimateArguments& arguments, io::MeshFile& file, const io::MadeBy& made_by,
                 std::vector<std::string>& remarks) {
    const auto output = base::where_links_lead(arguments.output);
    io::MeshWriteOptions options;
    options.made_by = made_by;
    options.frame = file.frame;
    if (io::takes_texture(output))
        io::copy_textures(
            file, arguments.mesh, output,
            [](const std::filesystem::path& image) { database::refuse_hidden_file(image); }, options, remarks);
    else if (!file.texture_files.empty())
        remarks.push_back(fmt::format(
            "{}: the format names no image, so the texture is left out; .ply and .obj keep it", arguments.output));
    for (auto& remark : io::write_mesh(output, file.mesh, options)) remarks.push_back(std::move(remark));
}

}  // namespace

OwnMesh read_own_mesh(const AnimateArguments& arguments) {
    for (const auto& file : {arguments.mesh, arguments.landmarks}) database::refuse_hidden_file(file);
    refuse_range_scan(arguments.mesh);
    const auto unit = io::parse_length_unit(arguments.unit);
    OwnMesh own{io::read_mesh_file(arguments.mesh, unit, io::MeshParts::all, io::BadTexture::report), {}};
    own.landmarks = io::read_landmarks(arguments.landmarks, own.file.mesh.vertices_mm, unit);
    refuse_other_unit(arguments, own);
    return own;
}

int animate_own_mesh(const AnimateArguments& arguments, const ExpressionShelf& shelf, OwnMesh own,
                     ChosenExpressions& chosen) {
    auto& file = own.file;
    const bool blendshapes = base::lower_case(std::filesystem::path(arguments.output).extension().string()) == ".glb";
    auto& remarks = chosen.remarks;
    remarks.insert(remarks.end(), file.remarks.begin(), file.remarks.end());
    auto options = arguments.method.animation_options();
    options.combination = combination_of(arguments);
    animation::AnimatedFace animated;
    auto moved = naming_any({arguments.landmarks, arguments.mesh}, [&] {
        return animation::animate_mesh(file.mesh, own.landmarks, shelf.average(), chosen.weighted(), options,
                                       &animated);
    });
    remarks.insert(remarks.end(), animated.remarks.begin(), animated.remarks.end());
    if (const auto torn = count_torn(file.mesh, animated, blendshapes); torn > 0)
        remarks.push_back(fmt::format("lips or lids that part are joined in {} by {}, stretched there: cut the mesh",
                                      arguments.mesh.string(), base::counted(torn, "face")));
    auto made = made_by(arguments, shelf, arguments.mesh.filename().string(), "", chosen);
    carry_origin(arguments, made);
    if (!file.texture_error.empty()) remarks.push_back(file.texture_error);
    if (blendshapes) {
        if (file.frame)
            remarks.push_back(
                fmt::format("{}: a GLB does not say in which frame of the body its coordinates are", arguments.output));
        const auto texture = glb_texture(arguments, file, remarks);
        for (auto& remark : animation::write_animated_mesh(base::where_links_lead(arguments.output), animated,
                                                           file.mesh, chosen.names, texture, made))
            remarks.push_back(std::move(remark));
    } else {
        file.mesh = std::move(moved);
        write_moved(arguments, file, made, remarks);
    }
    return report_animation(arguments, arguments.mesh.string(), chosen, animated.extent);
}

}  // namespace mimik::cli
