// mimik-remesh is linked with parts of CGAL that are GPL-3.0-or-later, and so is this program; `mimik` knows nothing of
// it.

#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/output_folder.h"
#include "cli/command.h"
#include "cli/error_report.h"
#include "cli/notes.h"
#include "cli/terminal.h"
#include "database/hidden_subjects.h"
#include "io/json_values.h"
#include "io/mesh_io.h"
#include "remeshing/hausdorff.h"
#include "remeshing/remesh.h"

namespace mimik::cli {
namespace {

struct RemeshArguments {
    Common common;
    std::string input, output, unit = "mm";
    bool resample_border = false;
    double error_bound_mm = 0.01;
    remeshing::RemeshOptions options;
};

void say_result(const RemeshArguments& arguments, const io::MeshFile& input, const geometry::Mesh& made,
                const remeshing::RemeshReport& report, const remeshing::Hausdorff& apart) {
    if (arguments.common.json) {
        std::cout << io::json_text(nlohmann::ordered_json{
            {"schema", 1},
            {"output", arguments.output},
            {"units", "mm"},
            {"vertices_before", input.mesh.vertices_mm.size()},
            {"vertices", made.vertices_mm.size()},
            {"triangles", made.faces.size()},
            {"edge", report.edge_mm},
            {"mean_edge", report.mean_edge_mm},
            {"protected_edges", report.protected_edges},
            {"hausdorff", {{"to_input", apart.second_to_first_mm}, {"from_input", apart.first_to_second_mm}}},
            {"hausdorff_error_bound", apart.error_bound_mm},
            {"remarks", report.remarks}});
        return;
    }
    std::cout << fmt::format(
        "{}: {} vertices, {} triangles, edges of {:.3f} mm on average ({} vertices before)\n"
        "Hausdorff distance {:.3f} mm ({:.3f} from input to output, {:.3f} back), to within {} mm\n",
        arguments.output, made.vertices_mm.size(), made.faces.size(), report.mean_edge_mm,
        input.mesh.vertices_mm.size(), apart.mm(), apart.first_to_second_mm, apart.second_to_first_mm,
        apart.error_bound_mm);
}

void remesh_file(RemeshArguments& arguments) {
    const std::filesystem::path file = arguments.input, output = arguments.output;
    arguments.options.keep_lines = !arguments.resample_border;
    check_by_option({{"edge_mm", "--edge-mm"},
                     {"vertices", "--vertices"},
                     {"crease_deg", "--crease-deg"},
                     {"iterations", "--iterations"}},
                    [&] { arguments.options.check(); });
    if (!(arguments.error_bound_mm > 0))
        throw InputError(fmt::format("--error-mm is {}; give more than 0", arguments.error_bound_mm));
    (void)io::mesh_format(output);
    refuse_range_scan(file);
    database::refuse_hidden_file(file);
    const auto unit = io::parse_length_unit(arguments.unit);
    const auto input = naming(file, [&] {
        return io::read_mesh_file(file, unit, io::MeshParts::without_attributes, io::BadTexture::report);
    });
    remeshing::RemeshReport report;
    const auto made = naming(file, [&] { return remeshing::remesh(input.mesh, arguments.options, {}, &report); });
    const auto apart = naming(file, [&] { return remeshing::hausdorff(input.mesh, made, arguments.error_bound_mm); });
    for (auto& remark : report.remarks) remark = fmt::format("{}: {}", file.string(), remark);
    report.remarks.insert(report.remarks.begin(), input.remarks.begin(), input.remarks.end());
    io::MeshWriteOptions options;
    options.frame = input.frame;
    options.made_by = database::said_in_files(database::origin_to_carry(std::vector{file}));
    for (auto& remark : io::write_mesh(base::where_links_lead(output), made, options))
        report.remarks.push_back(std::move(remark));
    if (!arguments.common.quiet && !arguments.common.json) say_notes(report.remarks);
    say_result(arguments, input, made, report, apart);
}

int run_remesh(int argc, char** argv) {
    prepare_standard_streams();
    CLI::App app{
        "Gives a surface triangles of one size, and says how far it then lies from what it was.\n"
        "This program is GPL-3.0-or-later: it is linked with CGAL's remeshing.",
        "mimik-remesh"};
    app.set_help_flag("-h,--help", "Print this help and stop");
    RemeshArguments arguments;
    auto& options = arguments.options;
    app.add_option("MESH", arguments.input, "PLY, OBJ, STL, PCD or VTP with faces")->required();
    app.add_option("-o,--output", arguments.output, "The same formats")->required();
    auto* edge = app.add_option("--edge-mm", options.edge_mm, "Length of the edges")->capture_default_str();
    app.add_option("--vertices", options.vertices, "So many vertices, within 1 in 100 where the surface allows it")
        ->excludes(edge);
    app.add_flag("--resample-border", arguments.resample_border,
                 "Give borders and creases the new edge length, too; else they lose no vertex");
    app.add_option("--crease-deg", options.crease_deg, "Protect edges whose faces differ by more; 0: none")
        ->capture_default_str();
    app.add_option("--iterations", options.iterations, "Rounds of splits, collapses, flips and smoothing")
        ->capture_default_str();
    app.add_option("--error-mm", arguments.error_bound_mm, "Of the Hausdorff distance; a tenth takes longer")
        ->capture_default_str();
    app.add_option("--unit", arguments.unit, "Unit of the input: mm, cm, m or inch")->capture_default_str();
    add_common_options(app, arguments.common);
    app.callback([&] { remesh_file(arguments); });
    return run(app, argc, argv, exit_done);
}

}  // namespace
}  // namespace mimik::cli

int main(int argc, char** argv) { return mimik::cli::run_remesh(argc, argv); }
