#include "cli/experiment_folder.h"

#include <algorithm>
#include <array>
#include <functional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "animation/model_method.h"
#include "base/content_hash.h"
#include "base/errors.h"
#include "base/fields.h"
#include "base/file.h"
#include "base/file_digest.h"
#include "base/parallel.h"
#include "base/text.h"
#include "base/version.h"
#include "cli/expression_names.h"
#include "cli/libraries.h"
#include "cli/per_vertex_files.h"
#include "cli/shard_files.h"
#include "database/truth.h"
#include "io/json_values.h"
#include "modeling/average_fingerprint.h"

namespace mimik::cli {
namespace {

namespace fs = std::filesystem;
using evaluation::ExperimentFile;
using evaluation::SubjectChoice;

/// What a run writes, in a fixed order; other files in the folder are somebody else's.
constexpr std::array result_names = {"experiment.json",
                                     "rows.csv",
                                     "rows.sqlite",
                                     "scores.json",
                                     "scores.csv",
                                     "summary.md",
                                     "statistics/differences.csv",
                                     "statistics/methods.csv",
                                     "statistics/source_dependence.csv",
                                     "tables/error_mm.tex",
                                     "tables/explained.tex",
                                     "tables/intervals.tex"};

std::vector<fs::path> results_in(const fs::path& root) {
    std::vector<fs::path> files;
    for (const auto* name : result_names) files.push_back(root / name);
    for (auto& file : per_vertex_files(root)) files.push_back(std::move(file));
    return files;
}

/// Runs what may refuse a choice, and puts before the refusal where the choice was made.
template <class Work>
auto at(const ExperimentFile& file, const std::string& key, const Work& work) {
    try {
        return work();
    } catch (const InputError& e) {
        throw InputError(fmt::format("{}: {}", file.place(key), e.what()));
    }
}

/// The subjects of a choice by name; empty: all.
std::vector<std::string> names_of(const SubjectChoice& choice, const preprocessing::Workspace& workspace) {
    if (choice.sex.empty()) return choice.names;
    std::vector<std::string> names;
    for (const auto& subject : workspace.shown_subjects())
        if (workspace.face(workspace.neutral(subject)).sex == choice.sex) names.push_back(subject);
    if (names.empty())
        throw InputError(
            fmt::format("no subject of {} is known to be '{}'; the database's manifest or subjects.csv "
                        "says who is",
                        workspace.root().string(), choice.sex));
    return names;
}

/// Neutrals, scans of the expressions, and of an emotion's AUs, of which zones are made.
bool plays_a_part(const database::ScanId& id, const evaluation::ExperimentPlan& plan) {
    if (id.neutral()) return true;
    const auto shown = id.expression();
    return std::any_of(plan.expressions.begin(), plan.expressions.end(), [&](const auto& planned) {
        if (planned.expression == shown) return true;
        const auto units = planned.expression.units();
        return units.size() > 1 && std::any_of(units.begin(), units.end(), [&](const facs::UnitOnSide& unit) {
                   return facs::Expression::of_units({{unit.unit, unit.side, false}}) == shown;
               });
    });
}

std::vector<fs::path> face_files(const preprocessing::Workspace& workspace, const evaluation::ExperimentPlan& plan) {
    std::vector<fs::path> files;
    for (const auto& id : workspace.scans())
        if (!workspace.hidden(id.subject) && plays_a_part(id, plan))
            for (const auto* ending : {".ply", ".json"}) files.emplace_back(workspace.stem(id).string() + ending);
    return files;
}

/// Of every face that the experiment may read, and of what belongs to them.
nlohmann::ordered_json inputs_of(const evaluation::PerformanceReader& reader, const facs::FacsCatalogue& catalogue,
                                 const evaluation::ExperimentPlan& plan, const InputDigests& known) {
    const auto& workspace = reader.workspace();
    const auto files = face_files(workspace, plan);
    std::vector<std::string> digests(files.size());
    base::parallel_for_each(files.size(), [&](std::size_t k) { digests[k] = known.digest(files[k]); });
    base::ContentHash faces;
    for (std::size_t k = 0; k < files.size(); ++k) faces.add(files[k].filename().string() + " " + digests[k] + "\n");
    const auto truth = workspace.database_root() / "truth" / "truth.json";
    return {{"subjects", workspace.shown_subjects().size()},
            {"faces", faces.text()},
            {"average_face", modeling::average_fingerprint(workspace.average())},
            {"catalogue", catalogue.content_hash()},
            {"truth", reader.has_truth() ? nlohmann::ordered_json(base::digest_of_file(truth).text())
                                         : nlohmann::ordered_json()}};
}

nlohmann::ordered_json method_entry(const animation::Method& method) {
    nlohmann::ordered_json entry = {{"name", method.name()}, {"source", animation::to_string(method.needs())}};
    if (const auto* model = dynamic_cast<const animation::ModelMethod*>(&method)) {
        entry["model"] = std::string(base::trimmed(base::field_text(model->model_options())));
        entry["animation"] = std::string(base::trimmed(base::field_text(model->animation_options())));
    }
    return entry;
}

nlohmann::ordered_json configuration_of(const ExperimentFile& file, const evaluation::ExperimentPlan& plan) {
    nlohmann::ordered_json document;
    auto& expressions = document["expressions"] = nlohmann::ordered_json::array();
    for (const auto& planned : plan.expressions)
        expressions.push_back({{"code", planned.expression.code()}, {"scans", planned.performances.size()}});
    document["left_out"] = plan.left_out;
    auto& methods = document["methods"] = nlohmann::ordered_json::array();
    for (const auto& method : plan.methods) methods.push_back(method_entry(*method));
    document["magnitudes"] = plan.magnitudes;
    document["seed"] = file.seed;
    document["subjects"] = plan.subjects;
    document["targets"] = plan.targets;
    document["sources"] = plan.sources;
    document["max_sources"] = plan.max_sources;
    document["zones"] = to_string(plan.zones);
    document["whole_face"] = plan.whole_face;
    document["on_itself"] = plan.on_itself;
    auto& estimators = document["estimators"] = nlohmann::ordered_json::array();
    for (const auto& choice : plan.estimators) estimators.push_back(evaluation::to_string(choice));
    document["regions"] = plan.regions;
    document["metrics"] = plan.metrics.metrics;
    document["area_weighted"] = plan.metrics.area_weighted;
    document["alignment"] = evaluation::to_string(plan.alignment);
    document["resamples"] = file.resamples;
    document["confidence"] = file.confidence;
    auto& per_vertex = document["per_vertex"] = nlohmann::ordered_json::array();
    for (const auto& choice : file.per_vertex) per_vertex.push_back(choice.text());
    return document;
}

std::string identity_of(const ExperimentFile& file, const evaluation::PerformanceReader& reader,
                        const facs::FacsCatalogue& catalogue, const evaluation::ExperimentPlan& plan,
                        const InputDigests& known) {
    nlohmann::ordered_json document = {
        {"schema", 1}, {"mimik", base::version()}, {"commit", commit()}, {"compiler", MIMIK_COMPILER}};
    auto& versions = document["libraries"] = nlohmann::ordered_json::object();
    for (const auto& [name, version] : libraries()) versions[name] = version;
    document["experiment"] = configuration_of(file, plan);
    document["inputs"] = inputs_of(reader, catalogue, plan, known);
    if (const auto truth = reader.truth_origin())
        document["truth"] = {{"seed", truth->seed},           {"face_model", truth->face_model},
                             {"subjects", truth->subjects},   {"expressions", truth->expressions},
                             {"neutrals", truth->neutrals},   {"repeat", truth->repeat},
                             {"variances", truth->variances}, {"scanner", truth->scanner}};
    return document.dump(1) + "\n";
}

/// "experiment/methods/0/name is \"mean\" there and \"thesis\" here": the first difference.
std::string difference(const nlohmann::json& there, const nlohmann::json& here) {
    const auto one = there.flatten(), other = here.flatten();
    for (const auto& [key, value] : other.items())
        if (!one.contains(key) || one[key] != value)
            return fmt::format("{} is {} there and {} here", key.substr(1),
                               one.contains(key) ? io::shown(one[key]) : "absent", io::shown(value));
    for (const auto& [key, value] : one.items())
        if (!other.contains(key)) return fmt::format("{} is {} there and absent here", key.substr(1), io::shown(value));
    return "the files differ";
}

}  // namespace

bool ExperimentFolder::whole() const { return base::is_there(manifest()); }

void ExperimentFolder::claim(const std::string& own) const {
    if (!base::is_there(identity())) {
        if (base::is_there(part()))
            throw InputError(fmt::format(
                "{}: rows of an experiment that is not known lie there; remove them, or give --anew", part().string()));
        return base::write_atomically(identity(), own);
    }
    require(own);
}

void ExperimentFolder::require(const std::string& own) const {
    const auto there = base::read_text(identity(), io::most_json_bytes);
    if (there == own) return;
    throw InputError(fmt::format(
        "{}: holds another experiment ({}); give another folder with -o, or --anew to begin "
        "again",
        root_.string(), difference(io::parse_json(there, identity().string()), nlohmann::json::parse(own))));
}

void ExperimentFolder::clear() const {
    // In this order: the run is not whole, its rows are nobody's, and then the rest.
    for (const auto& file : {manifest(), part()}) {
        std::error_code fault;
        fs::remove(file, fault);
        if (fault) throw InputError(fmt::format("{}: cannot be removed ({})", file.string(), fault.message()));
    }
    std::error_code none;
    for (const auto& file : results_in(root_)) fs::remove(file, none);
    for (const auto& file : files_of_shards(root_)) fs::remove(file, none);
    for (const auto& file : {provenance(), face_digests(), preprocessing_mark()}) fs::remove(file, none);
    fs::remove(page(), none);
    for (const auto* folder : {"statistics", "tables", "per_vertex", "shards"})
        fs::remove(root_ / folder, none);  // where empty
}

void ExperimentFolder::seal() const {
    nlohmann::ordered_json files;
    for (const auto& file : results_in(root_))
        files[fs::relative(file, root_).generic_string()] = base::digest_of_file(file).text();
    base::write_atomically(manifest(), nlohmann::ordered_json{{"schema", 1}, {"files", files}}.dump(1) + "\n");
}

std::vector<std::string> ExperimentFolder::damage() const {
    const auto name = manifest().string();
    const auto document = io::parse_json(base::read_text(manifest(), io::most_json_bytes), name);
    std::vector<std::string> damage;
    try {
        for (const auto& [file, digest] : io::read_field<std::map<std::string, std::string>>(document, "files")) {
            const fs::path relative(file);
            if (relative.is_absolute() || std::find(relative.begin(), relative.end(), "..") != relative.end())
                damage.push_back(fmt::format("{}: is not in the folder", file));
            else if (!base::is_there(root_ / relative))
                damage.push_back(fmt::format("{}: is missing", file));
            else if (base::digest_of_file(root_ / relative).text() != digest)
                damage.push_back(fmt::format("{}: was changed after the run", file));
        }
    } catch (const InputError& e) {
        throw InputError(fmt::format("{}: {}", name, e.what()));
    }
    return damage;
}

InputDigests digests_of_faces(const preprocessing::Workspace& workspace, const evaluation::ExperimentPlan& plan) {
    return InputDigests::of(face_files(workspace, plan));
}

PlannedExperiment planned(const ExperimentFile& file, const evaluation::PerformanceReader& reader,
                          const facs::FacsCatalogue& catalogue, const InputDigests& known) {
    const auto& workspace = reader.workspace();
    auto options = file.options();
    options.expressions = at(file, "expressions",
                             [&] { return expressions_named(workspace, catalogue, "expressions", file.expressions); });
    for (const auto& [key, choice, names] : {std::tuple{"subjects.targets", &file.targets, &options.targets},
                                             std::tuple{"subjects.sources", &file.sources, &options.sources}})
        *names = at(file, key, [&] {
            auto chosen = names_of(*choice, workspace);
            (void)evaluation::known_subjects(workspace, chosen);
            return chosen;
        });
    PlannedExperiment experiment;
    experiment.plan =
        at(file, "", [&] { return evaluation::plan_experiment(workspace, catalogue, options, reader.has_truth()); });
    check_per_vertex(file, experiment.plan);
    experiment.identity = identity_of(file, reader, catalogue, experiment.plan, known);
    return experiment;
}

facs::FacsCatalogue catalogue_of(const ExperimentFile& file) {
    auto catalogue = file.catalogue.empty() ? facs::builtin_catalogue() : facs::read_catalogue(file.catalogue);
    if (file.emotions.empty()) return catalogue;
    return at(file, "emotions", [&] { return catalogue.with_emotions(file.emotions); });
}

fs::path workspace_of(const ExperimentFile& file, const ExperimentFolder& folder) {
    return file.workspace.empty() ? folder.workspace() : file.workspace;
}

}  // namespace mimik::cli
