#include "cli/per_vertex_files.h"

#include <algorithm>
#include <exception>
#include <fstream>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "evaluation/experiment.h"
#include "evaluation/per_vertex.h"
#include "io/mesh_io.h"

namespace mimik::cli {
namespace {

namespace fs = std::filesystem;
using evaluation::CaseChoice;
using evaluation::CaseKey;
using evaluation::ExperimentPlan;

constexpr const char* list_header = "file,source,target,expression,method,magnitude,vertices,zone_mean_mm";

fs::path folder_in(const fs::path& root) { return root / "per_vertex"; }
fs::path list_in(const fs::path& root) { return folder_in(root) / "cases.csv"; }

bool has_method(const CaseChoice& choice, const animation::Method& method, const ExperimentPlan& plan) {
    const auto magnitudes = plan.magnitudes_of(method);
    return std::any_of(magnitudes.begin(), magnitudes.end(), [&](double magnitude) {
        return evaluation::variant_of(method.name(), magnitude) == choice.method;
    });
}

std::string why_not_planned(const CaseChoice& choice, const ExperimentPlan& plan) {
    const auto planned = std::find_if(plan.expressions.begin(), plan.expressions.end(),
                                      [&](const auto& one) { return one.expression.code() == choice.expression; });
    if (planned == plan.expressions.end()) return fmt::format("expression '{}' is not run", choice.expression);
    const auto shows = [&](const std::string& subject) {
        return std::any_of(planned->performances.begin(), planned->performances.end(),
                           [&](const auto& id) { return id.subject == subject; });
    };
    if (!shows(choice.target) || !plan.is_target(choice.target))
        return fmt::format("'{}' is no target of expression '{}'", choice.target, choice.expression);
    const auto method = std::find_if(plan.methods.begin(), plan.methods.end(),
                                     [&](const auto& one) { return has_method(choice, *one, plan); });
    if (method == plan.methods.end())
        return fmt::format("method '{}' is not run; one at another magnitude than 1 is written 'mean@0.8'",
                           choice.method);
    if (choice.source.empty()) return {};
    if ((*method)->needs() != animation::SourceKind::one_source)
        return choice.source == "mean" ? "" : fmt::format("method '{}' has no one source", choice.method);
    const auto target = std::find_if(planned->performances.begin(), planned->performances.end(),
                                     [&](const auto& id) { return id.subject == choice.target; });
    const auto ring =
        plan.sources_of(static_cast<std::size_t>(target - planned->performances.begin()), planned->performances);
    const bool learned = std::any_of(ring.begin(), ring.end(),
                                     [&](std::size_t s) { return planned->performances[s].subject == choice.source; });
    return learned ? "" : fmt::format("'{}' is no source of target '{}'", choice.source, choice.target);
}

/// @return its line of the list; empty: the case has no answer
std::string write_case(const fs::path& root, const CaseKey& key, const evaluation::JudgedFace& face) {
    if (face.target.zone_size() == 0) return {};  // it has no score, either
    const auto error_mm = evaluation::vertex_errors_mm(face);
    const auto mesh = evaluation::judged_mesh(face, error_mm);
    const auto name = evaluation::file_stem(key) + ".ply";
    base::write_atomically(folder_in(root) / name, io::encode_ply(mesh, name));
    double zone_mm = 0;
    for (std::size_t k = 0; k < face.target.vertices.size(); ++k)
        if (face.target.in_zone[k]) zone_mm += error_mm[face.target.vertices[k]];
    return fmt::format("{},{},{},{},{},{},{},{}\n", base::csv_field(name), base::csv_field(key.source),
                       base::csv_field(key.target), base::csv_field(key.expression), base::csv_field(key.method),
                       key.magnitude, mesh.vertices_mm.size(), zone_mm / static_cast<double>(face.target.zone_size()));
}

}  // namespace

void check_per_vertex(const evaluation::ExperimentFile& file, const ExperimentPlan& plan) {
    for (const auto& choice : file.per_vertex)
        if (const auto why = why_not_planned(choice, plan); !why.empty())
            throw InputError(fmt::format("{}: case \"{}\": {}", file.place("output.per_vertex"), choice.text(), why));
}

std::vector<std::string> write_per_vertex(const fs::path& root, const evaluation::ExperimentFile& file,
                                          const evaluation::PerformanceReader& reader,
                                          const facs::FacsCatalogue& catalogue, const ExperimentPlan& plan) {
    std::vector<std::string> failures;
    if (file.per_vertex.empty()) return failures;
    std::map<std::pair<std::string, std::string>, std::vector<CaseChoice>> by_unit;  // expression, target
    for (const auto& choice : file.per_vertex) by_unit[{choice.expression, choice.target}].push_back(choice);
    std::string list = std::string(list_header) + "\n";
    for (const auto& [unit, choices] : by_unit) {
        const auto& wanted = choices;
        auto own = plan;
        std::erase_if(own.methods, [&](const auto& method) {
            return std::none_of(wanted.begin(), wanted.end(),
                                [&](const auto& choice) { return has_method(choice, *method, plan); });
        });
        std::exception_ptr not_written;  // a full disk is no failure of the scan
        const auto write = [&](const CaseKey& key, const evaluation::JudgedFace& face) {
            if (not_written ||
                std::none_of(wanted.begin(), wanted.end(), [&](const CaseChoice& choice) { return choice.fits(key); }))
                return;
            try {
                list += write_case(root, key, face);
            } catch (...) {
                not_written = std::current_exception();
            }
        };
        try {
            evaluation::visit_cases(reader, catalogue, own, unit.first, unit.second, write);
        } catch (const InputError& e) {
            failures.push_back(fmt::format("per_vertex/: no case of target {} and expression '{}': {}",
                                           base::in_quotes(unit.second), unit.first, e.what()));
        }
        if (not_written) std::rethrow_exception(not_written);
    }
    base::write_atomically(list_in(root), list);
    return failures;
}

std::vector<fs::path> per_vertex_files(const fs::path& root) {
    std::vector<fs::path> files;
    std::ifstream in(list_in(root), std::ios::binary);
    std::string line;
    if (!std::getline(in, line) || line != list_header) return files;
    files.push_back(list_in(root));
    while (std::getline(in, line)) {
        const fs::path name = line.substr(0, line.find(','));
        if (name.filename() == name && name.extension() == ".ply") files.push_back(folder_in(root) / name);
    }
    return files;
}

}  // namespace mimik::cli
