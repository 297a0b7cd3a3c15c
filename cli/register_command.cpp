#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/expression_names.h"
#include "cli/notes.h"
#include "cli/subject_names.h"
#include "facs/facs_catalogue.h"
#include "io/json_values.h"
#include "io/landmark_io.h"
#include "io/mesh_io.h"
#include "preprocessing/kept_registrations.h"
#include "preprocessing/register_workspace.h"
#include "preprocessing/workspace_layout.h"

namespace mimik::cli {
namespace {

struct Arguments {
    Common common;
    std::string workspace;
    std::vector<std::string> subjects, expressions;
};

/// The neutral scans of every subject that is asked for, and their scans of the expressions that are. A second neutral
/// scan is registered as an expression is.
std::vector<database::ScanId> chosen_scans(const preprocessing::Workspace& workspace, Arguments& arguments) {
    for (auto& subject : arguments.subjects) {
        subject = subject_named(workspace, subject);
        workspace.refuse_hidden(subject);
        (void)workspace.neutral(subject);  // names the subjects there are
    }
    refuse_doubles("--subject", arguments.subjects);
    const auto expressions =
        expressions_named(workspace, facs::builtin_catalogue(), "--expression", arguments.expressions);
    const auto asked_for = [&](const database::ScanId& id) {
        if (workspace.hidden(id.subject)) return false;
        if (!arguments.subjects.empty() &&
            std::find(arguments.subjects.begin(), arguments.subjects.end(), id.subject) == arguments.subjects.end())
            return false;
        return id.neutral() || expressions.empty() ||
               std::any_of(expressions.begin(), expressions.end(), [&](const facs::Expression& expression) {
                   return base::equal_ignoring_case(id.code, expression.code());
               });
    };
    std::vector<database::ScanId> scans;
    for (const auto& id : workspace.scans())
        if (asked_for(id)) scans.push_back(id);
    return scans;
}

/// The template itself, and where its landmarks are: what the meshes of all scans correspond to.
void write_template(const preprocessing::FaceTemplate& face_template, const std::filesystem::path& folder) {
    geometry::Mesh mesh;
    mesh.vertices_mm = face_template.surface.vertices_mm;
    for (const auto& triangle : face_template.surface.triangles) mesh.faces.add(triangle);
    io::write_mesh(folder / "template.ply", mesh);
    io::write_landmarks(folder / "template_landmarks.csv", face_template.surface.landmarks);
}

void print(const Arguments& arguments, const std::filesystem::path& table, std::size_t vertices,
           const std::vector<preprocessing::ScanRegistration>& found, std::size_t refused) {
    if (!arguments.common.json) {
        std::cout << fmt::format("{} of {} by a template of {} vertices; {}\n", found.size() - refused,
                                 base::counted(found.size(), "scan"), vertices, table.string());
        return;
    }
    auto list = nlohmann::json::array();
    for (const auto& one : found) {
        nlohmann::json entry = {{"scan", one.id.name()}};
        if (one.refused.empty()) {
            entry["matched_share"] = one.matched_share;
            entry["residual_rms_mm"] = one.residual_rms_mm;
            entry["still_controls"] = one.still_controls;
            entry["largest_motion_mm"] = one.largest_motion_mm;
        } else {
            entry["refused"] = one.refused;
        }
        list.push_back(std::move(entry));
    }
    std::cout << io::json_text(
        nlohmann::json{{"schema", 1}, {"table", table.string()}, {"vertices", vertices}, {"scans", list}});
}

int run(Arguments& arguments) {
    const preprocessing::Workspace workspace(arguments.workspace);
    const auto scans = chosen_scans(workspace, arguments);
    const auto folder = preprocessing::registered_folder(workspace.root());
    check_output_folder(folder, false);
    std::vector<preprocessing::ScanRegistration> found;
    {
        Progress progress(arguments.common, "register", scans.size());
        found = preprocessing::register_workspace(workspace, scans,
                                                  [&](const std::string& scan) { progress.advance(scan); });
    }
    const auto& face_template = workspace.registrations()->face_template();
    write_template(face_template, folder);
    const auto table = folder / "registrations.csv";
    base::write_atomically(table, preprocessing::to_csv(found));
    std::vector<std::string> failures;
    for (const auto& one : found)
        if (!one.refused.empty()) failures.push_back(fmt::format("{}: {}", one.id.name(), one.refused));
    print(arguments, table, face_template.size(), found, failures.size());
    say_failures(failures);
    return failures.empty() ? exit_done : exit_done_with_failures;
}

}  // namespace

void add_register_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand("register", "Bring all scans into dense correspondence: one mesh on each");
    auto arguments = std::make_shared<Arguments>();
    command->add_option("WORK", arguments->workspace, "Folder made by 'mimik preprocess'; the meshes go to registered/")
        ->required();
    command->add_option("--subject", arguments->subjects, "Only these subjects")->delimiter(',');
    command
        ->add_option("--expression,--au", arguments->expressions,
                     "Only these AUs and emotions, beside the neutral scans")
        ->delimiter(',');
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
