#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "animation/dense_label_fit.h"
#include "base/errors.h"
#include "base/text.h"
#include "capture/label_fit.h"
#include "cli/error_report.h"
#include "cli/mocap_commands.h"
#include "cli/notes.h"
#include "database/hidden_subjects.h"
#include "io/json_values.h"
#include "io/landmark_io.h"
#include "io/mesh_io.h"

namespace mimik::cli {
namespace {

struct FitArguments {
    Common common;
    std::filesystem::path reference, mesh, labels, points, set, truth, output;
    std::string reference_unit = "mm", unit = "mm", kernel = "imq", by = "dense", rest = "warped";
    bool compare = false;
    capture::LabelFitOptions options;
};

const std::vector<std::string> ways = {"start", "levenberg", "ceres", "simplex", "dense"};

/// A mesh as a fit needs it.
struct Surface {
    std::vector<geometry::Point> vertices_mm;
    std::vector<geometry::Triangle> triangles;
};

Surface read_surface(const std::filesystem::path& file, const std::string& unit, std::vector<std::string>& remarks) {
    database::refuse_hidden_file(file);
    refuse_range_scan(file);
    auto read = io::read_mesh_file(file, io::parse_length_unit(unit), io::MeshParts::without_attributes,
                                   io::BadTexture::report);
    remarks.insert(remarks.end(), read.remarks.begin(), read.remarks.end());
    Surface surface{std::move(read.mesh.vertices_mm), geometry::triangulate(read.mesh.faces)};
    if (surface.triangles.empty())
        throw InputError(fmt::format(
            "{}: has points and no faces; labels are fitted to a surface: give a mesh with faces", file.string()));
    return surface;
}

geometry::Landmarks read_marks(const std::filesystem::path& file, const Surface& on, const std::string& unit) {
    database::refuse_hidden_file(file);
    return io::read_landmarks(file, on.vertices_mm, io::parse_length_unit(unit));
}

/// How far labels are from true ones.
struct FitError {
    std::size_t labels = 0;
    double mean_mm = 0, largest_mm = 0;
    std::string largest_at;
};

/// One way to fit, and what it cost.
struct Fitted {
    std::string by;
    geometry::Landmarks labels;
    std::optional<capture::SurfaceEnergyParts> start, end;
    std::optional<std::size_t> evaluations;
    std::optional<double> seconds, matched_share, residual_rms_mm;
    std::optional<FitError> error;
};

/// Of those labels that were not placed by hand.
FitError error_of(const geometry::Landmarks& labels, const geometry::Landmarks& truth,
                  const geometry::Landmarks& points) {
    FitError error;
    for (const auto& label : labels.all()) {
        const auto* there = truth.find(label.name);
        if (!there || points.find(label.name)) continue;
        const double mm = (label.position_mm - there->position_mm).norm();
        error.mean_mm += mm;
        ++error.labels;
        if (mm < error.largest_mm) continue;
        error.largest_mm = mm;
        error.largest_at = label.name;
    }
    if (error.labels == 0) throw InputError("has none of the labels that are fitted; name them as they are");
    error.mean_mm /= static_cast<double>(error.labels);
    return error;
}

struct Task {
    const FitArguments& arguments;
    Surface reference, mesh;
    geometry::Landmarks labels, points;
    std::optional<geometry::Landmarks> truth;
    capture::MarkerSet set;
    capture::LabelStart start;
    preprocessing::FitTarget target;

    [[nodiscard]] Fitted by(const std::string& way) const {
        Fitted fitted;
        fitted.by = way;
        if (way == "start") {
            fitted.labels = start.labels();
        } else if (way == "dense") {
            auto dense = naming(arguments.mesh, [&] {
                return animation::fit_labels_densely(start, reference.vertices_mm, reference.triangles, labels, target);
            });
            fitted.labels = std::move(dense.labels);
            fitted.seconds = dense.seconds;
            fitted.matched_share = dense.matched_share;
            fitted.residual_rms_mm = dense.residual_rms_mm;
        } else {
            for (const auto minimiser : capture::surface_minimisers()) {
                if (way != capture::to_string(minimiser)) continue;
                auto found = capture::fit_labels(start, labels, target.surface(), set, minimiser, arguments.options);
                fitted.labels = std::move(found.labels);
                fitted.start = found.found.start;
                fitted.end = found.found.end;
                fitted.evaluations = found.found.evaluations;
                fitted.seconds = found.found.seconds;
            }
        }
        if (truth) fitted.error = naming(arguments.truth, [&] { return error_of(fitted.labels, *truth, points); });
        return fitted;
    }
};

bool can(const std::string& way) {
    for (const auto minimiser : capture::surface_minimisers())
        if (way == capture::to_string(minimiser)) return capture::is_there(minimiser);
    return true;
}

nlohmann::json as_json(const capture::SurfaceEnergyParts& energy) {
    return {{"total", energy.total},
            {"distance_mm", energy.distance_mm},
            {"strain_mm", energy.strain_mm},
            {"bending", energy.bending}};
}

nlohmann::json as_json(const Fitted& fitted) {
    nlohmann::json document = {{"by", fitted.by}};
    if (fitted.start) document["start_energy"] = as_json(*fitted.start);
    if (fitted.end) document["energy"] = as_json(*fitted.end);
    if (fitted.evaluations) document["evaluations"] = *fitted.evaluations;
    if (fitted.seconds) document["seconds"] = *fitted.seconds;
    if (fitted.matched_share) document["matched_share"] = *fitted.matched_share;
    if (fitted.residual_rms_mm) document["residual_rms_mm"] = *fitted.residual_rms_mm;
    if (fitted.error)
        document["error"] = {{"labels", fitted.error->labels},
                             {"mean_mm", fitted.error->mean_mm},
                             {"largest_mm", fitted.error->largest_mm},
                             {"largest_at", fitted.error->largest_at}};
    return document;
}

/// @param points  placed by hand @param projected  of the start
std::string in_words(const Fitted& fitted, std::size_t points, std::size_t projected) {
    auto words = fmt::format("{:<9}", fitted.by);
    if (fitted.by == "start")
        words += fmt::format("  {} projected from the axis of the head, {} put on the nearest point", projected,
                             fitted.labels.size() - points - projected);
    if (fitted.end)
        words +=
            fmt::format("  energy {:.4f} -> {:.4f} ({:.3f} mm off, {:.3f} mm stretched, {:.3f} bent), {} in {:.3f} s",
                        fitted.start->total, fitted.end->total, fitted.end->distance_mm, fitted.end->strain_mm,
                        fitted.end->bending, base::counted(*fitted.evaluations, "evaluation"), *fitted.seconds);
    if (fitted.matched_share)
        words += fmt::format("  {:.0f} % of the reference on the mesh, rms {:.2f} mm, in {:.3f} s",
                             100 * *fitted.matched_share, *fitted.residual_rms_mm, *fitted.seconds);
    if (fitted.error)
        words += fmt::format("{} {:.2f} mm from the truth in the mean, {:.2f} at '{}'",
                             fitted.end || fitted.matched_share || fitted.by == "start" ? ";" : " ",
                             fitted.error->mean_mm, fitted.error->largest_mm, fitted.error->largest_at);
    return words;
}

Task prepared(const FitArguments& arguments, std::vector<std::string>& remarks) {
    auto reference = read_surface(arguments.reference, arguments.reference_unit, remarks);
    auto mesh = read_surface(arguments.mesh, arguments.unit, remarks);
    auto labels = read_marks(arguments.labels, reference, arguments.reference_unit);
    auto points = read_marks(arguments.points, mesh, arguments.unit);
    std::optional<geometry::Landmarks> truth;
    if (!arguments.truth.empty()) truth = read_marks(arguments.truth, mesh, arguments.unit);
    auto set = arguments.set.empty() ? capture::builtin_marker_set() : capture::read_marker_set(arguments.set);
    const geometry::SurfaceIndex skin(reference.vertices_mm, reference.triangles);
    preprocessing::FitTarget target(mesh.vertices_mm, mesh.triangles);
    naming_any({arguments.labels, arguments.reference},
               [&] { capture::check_reference(skin, labels, arguments.options); });
    auto start = naming_any({arguments.points, arguments.mesh}, [&] {
        return capture::start_labels(skin, labels, target.surface(), points, arguments.options);
    });
    remarks.insert(remarks.end(), start.remarks.begin(), start.remarks.end());
    return {arguments,        std::move(reference), std::move(mesh),  std::move(labels), std::move(points),
            std::move(truth), std::move(set),       std::move(start), std::move(target)};
}

/// The labels stand beside the mesh and are read with its unit.
geometry::Landmarks in_unit_of_mesh(const geometry::Landmarks& labels_mm, const std::string& unit) {
    const double one_mm = io::millimetres_per(io::parse_length_unit(unit));
    std::vector<geometry::Landmark> list(labels_mm.all().begin(), labels_mm.all().end());
    for (auto& label : list) label.position_mm /= one_mm;
    return geometry::Landmarks(std::move(list));
}

/// What a user typed and no chosen way reads is a misunderstanding.
void refuse_options_of_other_ways(const FitArguments& arguments, const CLI::App& command) {
    if (arguments.compare) return;
    const auto& by = arguments.by;
    const bool energy = by == "levenberg" || by == "ceres" || by == "simplex";
    for (const auto* option : {"--rest", "--distance", "--strain", "--bending", "--set"})
        if (command.count(option) > 0 && !energy)
            throw InputError(fmt::format(
                "{}: serves levenberg, ceres and simplex, and the labels are fitted by {}; leave it out, or give --by",
                option, by));
    if (command.count("--evaluations") > 0 && by != "simplex")
        throw InputError(fmt::format(
            "--evaluations: serves simplex, and the labels are fitted by {}; leave it out, or give --by simplex", by));
}

int run_fit(FitArguments& arguments) {
    auto& options = arguments.options;
    refuse_as_output(arguments.output, {arguments.reference, arguments.mesh, arguments.labels, arguments.points,
                                        arguments.set, arguments.truth});
    options.basis.kernel = radial_kernel_named(arguments.kernel);
    options.rest = arguments.rest == "reference" ? capture::LabelFitRest::reference : capture::LabelFitRest::warped;
    check_by_option({{"distance", "--distance"},
                     {"strain", "--strain"},
                     {"bending", "--bending"},
                     {"most_off_mm", "--most-off"},
                     {"most_projected_mm", "--most-projected"},
                     {"most_evaluations", "--evaluations"}},
                    [&] { options.check(); });
    if (io::landmark_format(arguments.output) != io::LandmarkFormat::csv)
        throw InputError(fmt::format("{}: labels are written as .csv", arguments.output.string()));
    std::vector<std::string> remarks;
    const auto task = prepared(arguments, remarks);
    std::vector<Fitted> all;
    for (const auto& way : ways) {
        if (way != arguments.by && !arguments.compare) continue;
        if (way != arguments.by && !can(way)) {
            remarks.push_back(
                fmt::format("{} is not compared: its library is not there (scripts/setup.sh --adapters)", way));
            continue;
        }
        try {
            all.push_back(task.by(way));
        } catch (const InputError& e) {  // a library that is there and does not load
            if (way == arguments.by) throw;
            remarks.push_back(fmt::format("{} is not compared: {}", way, e.what()));
        }
    }
    const auto& chosen = *std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.by == arguments.by; });
    io::write_landmarks(arguments.output, in_unit_of_mesh(chosen.labels, arguments.unit));
    if (arguments.common.json) {
        auto fits = nlohmann::json::array();
        for (const auto& one : all) fits.push_back(as_json(one));
        std::cout << io::json_text(nlohmann::json{{"schema", 1},
                                                  {"output", arguments.output.string()},
                                                  {"labels", chosen.labels.size()},
                                                  {"points", task.points.size()},
                                                  {"projected", task.start.projected},
                                                  {"by", arguments.by},
                                                  {"fits", std::move(fits)},
                                                  {"remarks", remarks}});
        return exit_done;
    }
    if (!arguments.common.quiet) say_notes(remarks);
    std::cout << fmt::format("{}: {} by {} placed by hand; {}\n", arguments.output.string(),
                             base::counted(chosen.labels.size(), "label"), task.points.size(), arguments.by);
    for (const auto& one : all) std::cout << in_words(one, task.points.size(), task.start.projected) << '\n';
    return exit_done;
}

void add_weights(CLI::App& command, FitArguments& arguments) {
    auto& options = arguments.options;
    command
        .add_option("--rest", arguments.rest,
                    "Whose lengths and angles are kept: warped (the reference as the points warp it) or reference")
        ->check(CLI::IsMember({"warped", "reference"}))
        ->capture_default_str();
    command.add_option("--distance", options.energy.distance, "Weight of the distance to the mesh")
        ->capture_default_str();
    command.add_option("--strain", options.energy.strain, "Weight of lengths that change")->capture_default_str();
    command.add_option("--bending", options.energy.bending, "Weight of angles that change")->capture_default_str();
    command.add_option("--most-off", options.most_off_mm, "A point or label farther off its mesh is refused, mm")
        ->capture_default_str();
    command
        .add_option("--most-projected", options.most_projected_mm,
                    "What the cylindrical projection would move farther goes to the nearest point, mm")
        ->capture_default_str();
    command.add_option("--evaluations", options.minimise.most_evaluations, "Of the simplex, at most")
        ->capture_default_str();
}

}  // namespace

void add_mocap_fit(CLI::App& group, int& exit_code) {
    auto* command =
        group.add_subcommand("fit", "Put the labels of a reference face on another mesh, by a few points on it");
    auto arguments = std::make_shared<FitArguments>();
    command->add_option("REFERENCE", arguments->reference, "Mesh of a face whose markers are labelled")->required();
    command->add_option("MESH", arguments->mesh, "Mesh of the face that is to be labelled")->required();
    command->add_option("--labels", arguments->labels, "Where the markers are on REFERENCE, by name (landmark file)")
        ->required();
    command
        ->add_option("--points", arguments->points,
                     "Some of them on MESH, placed by hand: 10 to 12 all over the face, by the same names")
        ->required();
    command->add_option("-o,--output", arguments->output, "Where all of them are on MESH, in its unit (.csv)")
        ->required();
    command
        ->add_option("--by", arguments->by,
                     "dense; levenberg, ceres or simplex (the published energy); start (its start alone)")
        ->check(CLI::IsMember(ways))
        ->capture_default_str();
    command->add_flag("--compare", arguments->compare, "Fit in every way that there is, and say what each found");
    command->add_option("--truth", arguments->truth, "True labels on MESH: say how far the fitted ones are off");
    command->add_option("--set", arguments->set, "Marker set (.toml; default: 'mimik mocap markers')");
    command->add_option("--reference-unit", arguments->reference_unit, "Of REFERENCE and its labels: mm, cm, m or inch")
        ->capture_default_str();
    command->add_option("--mesh-unit", arguments->unit, "Of MESH and its points: mm, cm, m or inch")
        ->capture_default_str();
    add_radial_kernel_option(*command, arguments->kernel);
    add_weights(*command, *arguments);
    add_common_options(*command, arguments->common);
    command->callback([arguments, command, &exit_code] {
        refuse_options_of_other_ways(*arguments, *command);
        exit_code = run_fit(*arguments);
    });
}

}  // namespace mimik::cli
