// How far faces that markers move are from the truth: the tables of docs/results.md, "Motion capture".
//     mimik_mocap_accuracy [--ict FOLDER] [--makehuman FOLDER] [--people N] [--radius-share S] [--pull P] [--per-unit]
// Faces of the built-in model, of ICT-FaceKit and of makehuman-world play recordings whose surface is known. Fixed
// seeds; the same numbers on any number of threads.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "animation/dense_field.h"
#include "animation/marker_animator.h"
#include "animation/part_masks.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/parallel.h"
#include "base/quantile.h"
#include "base/text.h"
#include "builtin/builtin_expressions.h"
#include "builtin/unit_fields.h"
#include "capture/fill_gaps.h"
#include "capture/retarget.h"
#include "capture/stabilise.h"
#include "capture/stick_markers.h"
#include "facs/facs_catalogue.h"
#include "io/landmark_io.h"
#include "io/mesh_io.h"
#include "modeling/expression_model.h"
#include "preprocessing/kept_registrations.h"
#include "synthesis/performance.h"

namespace {

using namespace mimik;
using animation::MarkerMethod;
using geometry::Point;
using geometry::Vector;

struct Arguments {
    std::string ict, makehuman;
    int people = 2;
    double radius_share = animation::MarkerAnimatorOptions{}.bones.radius_share;
    double pull = animation::UnitWeightsOptions{}.pull;
    bool per_unit = false;
};

/// A face at rest, and what it can do.
struct Actor {
    std::string name;
    std::vector<Point> rest_mm;
    std::vector<geometry::Triangle> triangles;
    geometry::Landmarks landmarks, labels;
    std::vector<std::string> units;
    std::function<std::vector<Vector>(std::size_t unit, double strength)> motion_mm;
};

/// What animates it.
struct Rig {
    std::unique_ptr<animation::PreparedTarget> target;
    std::vector<std::uint32_t> parts;
    std::vector<preprocessing::LipSide> lips;
    animation::UnitFields units;
    std::vector<std::uint32_t> lip_vertices;
    std::map<MarkerMethod, std::unique_ptr<animation::MarkerAnimator>> by;
};

struct Shelf {
    builtin::BuiltinExpressions expressions;
    std::shared_ptr<const preprocessing::KeptRegistrations> registrations;
    modeling::ExpressionModel lips;  ///< any dense model: says on which lip vertices lie
    Shelf() : lips(expressions.model(facs::builtin_catalogue(), *facs::builtin_catalogue().find_expression("27"))) {
        registrations = lips.dense->registrations;
    }
};

geometry::Landmarks labels_on(const std::vector<Point>& vertices, const std::vector<geometry::Triangle>& triangles,
                              const geometry::Landmarks& landmarks) {
    const geometry::SurfaceIndex skin(vertices, triangles);
    return capture::stick_markers(capture::builtin_marker_set(), landmarks, skin).landmarks();
}

Rig rig_of(const Actor& actor, const Shelf& shelf, const Arguments& arguments) {
    Rig rig;
    geometry::FaceSurface surface{actor.rest_mm, actor.triangles, {}, {}, actor.landmarks};
    surface.present.assign(actor.rest_mm.size(), 0);
    for (const auto& t : actor.triangles)
        for (const auto v : t) surface.present[v] = 1;
    surface.measured = surface.present;
    rig.target = std::make_unique<animation::PreparedTarget>(std::move(surface), shelf.expressions.average());
    rig.parts = animation::vertex_parts(*rig.target, shelf.registrations);
    rig.lips = animation::lip_sides(*rig.target, *shelf.lips.dense);
    rig.units = builtin::unit_fields(shelf.expressions, facs::builtin_catalogue(), *rig.target);
    std::vector<std::string> tracked;
    for (const auto& marker : capture::builtin_marker_set().markers) tracked.push_back(marker.name);
    animation::MarkerAnimatorOptions options;
    options.bones.radius_share = arguments.radius_share;
    options.units.pull = arguments.pull;
    for (const auto method : animation::marker_methods())
        rig.by[method] = std::make_unique<animation::MarkerAnimator>(
            method, animation::MarkerAnimator::Mesh{actor.rest_mm, actor.triangles, rig.parts, &rig.units},
            capture::builtin_marker_set(), actor.labels, tracked, options);
    // Lip vertices: within 4 mm of a marker of the lips.
    std::vector<Point> rim;
    for (const auto& mark : actor.labels.all())
        if (mark.name.starts_with("lip_") || mark.name.starts_with("mouth_corner")) rim.push_back(mark.position_mm);
    for (std::uint32_t v = 0; v < actor.rest_mm.size(); ++v)
        if (std::any_of(rim.begin(), rim.end(), [&](const Point& p) { return (p - actor.rest_mm[v]).norm() < 4; }))
            rig.lip_vertices.push_back(v);
    return rig;
}

std::vector<Point> markers_of(const Actor& actor, const std::vector<Vector>& motion) {
    const geometry::SurfaceIndex skin(actor.rest_mm, actor.triangles);
    std::vector<Point> all;
    for (const auto& marker : capture::builtin_marker_set().markers) {
        const auto place = skin.closest(actor.labels.position_mm(marker.name));
        Point at = place.position_mm;
        for (std::size_t c = 0; c < 3; ++c)
            at += place.barycentric[static_cast<Eigen::Index>(c)] * motion[actor.triangles[place.triangle][c]];
        all.push_back(at);
    }
    return all;
}

/// Of vertices that truly move by more than 0.5 mm.
struct Sums {
    double error = 0, motion = 0;
    std::vector<double> errors_mm;
    std::vector<double> lip_mm;  ///< the largest of every frame
    void add(const std::vector<Vector>& truth, const std::vector<Vector>& made,
             const std::vector<std::uint32_t>& lips) {
        for (std::size_t v = 0; v < truth.size(); ++v) {
            if (truth[v].norm() <= 0.5) continue;
            const double e = (made[v] - truth[v]).norm();
            error += e;
            motion += truth[v].norm();
            errors_mm.push_back(e);
        }
        double largest = 0;
        for (const auto v : lips) largest = std::max(largest, (made[v] - truth[v]).norm());
        lip_mm.push_back(largest);
    }
    [[nodiscard]] double share() const { return motion > 0 ? 1 - error / motion : 0; }
    [[nodiscard]] std::string row() const {
        auto sorted = errors_mm;
        std::sort(sorted.begin(), sorted.end());
        double mean = 0, lip = 0;
        for (const double e : sorted) mean += e / static_cast<double>(sorted.size());
        for (const double e : lip_mm) lip += e / static_cast<double>(lip_mm.size());
        const double p95 = sorted.empty() ? 0 : sorted[(sorted.size() - 1) * 95 / 100];
        return fmt::format("{:.2f} | {:.2f} | {:.2f} | {:.1f} | {:.2f}", share(), mean, p95,
                           sorted.empty() ? 0 : sorted.back(), lip);
    }
};

void measure_a(const Actor& actor, const Rig& rig, std::map<MarkerMethod, Sums>& sums,
               std::map<std::string, std::map<MarkerMethod, Sums>>& by_unit) {
    for (std::size_t u = 0; u < actor.units.size(); ++u)
        for (const double strength : {0.25, 0.5, 0.75, 1.0}) {
            const auto truth = actor.motion_mm(u, strength);
            const auto markers = markers_of(actor, truth);
            for (const auto method : animation::marker_methods()) {
                std::vector<Vector> made(truth.size());
                rig.by.at(method)->displace(markers, made);
                sums[method].add(truth, made, rig.lip_vertices);
                by_unit[actor.units[u]][method].add(truth, made, rig.lip_vertices);
            }
        }
}

/// Motion of one lip by the markers of the other alone, share of what the other lip moves.
double leakage(const Actor& actor, const Rig& rig, MarkerMethod method, std::size_t unit, bool of_lower) {
    const auto& opening = capture::builtin_marker_set().openings.front();
    const auto truth = actor.motion_mm(unit, 1.0);
    auto markers = markers_of(actor, truth);
    const auto& own = of_lower ? opening.lower : opening.upper;
    for (std::size_t k = 0; k < markers.size(); ++k) {
        const auto& name = capture::builtin_marker_set().markers[k].name;
        if (std::find(own.begin(), own.end(), name) == own.end()) markers[k] = actor.labels.position_mm(name);
    }
    std::vector<Vector> made(truth.size());
    rig.by.at(method)->displace(markers, made);
    double here = 0, there = 0, n_here = 0, n_there = 0;
    for (const auto v : rig.lip_vertices) {
        if (rig.lips[v] == preprocessing::LipSide::neither) continue;
        if ((rig.lips[v] == preprocessing::LipSide::lower) == of_lower)
            here += made[v].norm(), ++n_here;
        else
            there += made[v].norm(), ++n_there;
    }
    return n_here > 0 && n_there > 0 && here > 0 ? (there / n_there) / (here / n_here) : 0;
}

std::optional<Actor> makehuman_actor(const std::filesystem::path& folder, const std::string& subject) {
    std::map<std::string, geometry::Transform> poses;
    std::istringstream lines(base::read_text(folder / "poses.csv", 1U << 24U));
    std::string line;
    while (std::getline(lines, line)) {
        std::vector<std::string> cells;
        std::istringstream row(line);
        for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
        if (cells.size() != 14 || cells[0] != subject) continue;
        geometry::Transform pose = geometry::Transform::Identity();
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) pose.linear()(i, j) = std::stod(cells[static_cast<std::size_t>(2 + 4 * i + j)]);
            pose.translation()[i] = std::stod(cells[static_cast<std::size_t>(2 + 4 * i + 3)]);
        }
        poses[cells[1]] = pose;
    }
    if (poses.empty()) return std::nullopt;
    const auto in_head = [&](const std::string& expression) {
        auto mesh = io::read_mesh_file(folder / subject / (expression + ".obj")).mesh;
        const geometry::Transform head_from_scan = poses.at(expression).inverse();
        for (auto& p : mesh.vertices_mm) p = head_from_scan * p;
        return mesh;
    };
    Actor actor;
    actor.name = subject;
    const auto rest = in_head("N");
    actor.rest_mm = rest.vertices_mm;
    actor.triangles = geometry::triangulate(rest.faces);
    actor.landmarks = geometry::transformed(io::read_landmarks(folder / subject / "N.csv"), poses.at("N").inverse());
    actor.labels = labels_on(actor.rest_mm, actor.triangles, actor.landmarks);
    auto fields = std::make_shared<std::vector<std::vector<Vector>>>();
    for (const auto& [name, pose] : poses) {
        if (name == "N") continue;
        const auto moved = in_head(name);
        auto& field = fields->emplace_back(rest.vertices_mm.size());
        for (std::size_t v = 0; v < field.size(); ++v) field[v] = moved.vertices_mm[v] - rest.vertices_mm[v];
        actor.units.push_back(name.starts_with("AU") ? name.substr(2) : name);
    }
    actor.motion_mm = [fields](std::size_t unit, double strength) {
        auto motion = (*fields)[unit];
        for (auto& d : motion) d *= strength;
        return motion;
    };
    return actor;
}

Actor actor_of(std::shared_ptr<const synthesis::Performer> performer,
               std::shared_ptr<const std::vector<synthesis::PosedExpression>> units) {
    Actor actor;
    actor.name = performer->name();
    actor.rest_mm = performer->resting_mm();
    actor.triangles.assign(performer->triangles().begin(), performer->triangles().end());
    actor.landmarks = performer->landmarks();
    actor.labels = performer->labels();
    for (const auto& unit : *units) actor.units.push_back(unit.code);
    actor.motion_mm = [performer, units](std::size_t unit, double strength) {
        std::vector<double> strengths(units->size(), 0.0);
        strengths[unit] = strength;
        return performer->motion_mm(*units, strengths);
    };
    return actor;
}

/// Recording B of one person on another (or the same) face.
void measure_b(const synthesis::Performer& source, const Actor& target_actor, const synthesis::Performer& target,
               const Rig& rig, const std::vector<synthesis::PosedExpression>& units,
               std::map<MarkerMethod, Sums>& sums) {
    synthesis::PerformanceOptions options;
    const auto score = synthesis::spoken_score(units, options);
    const auto take = synthesis::laboratory_recording(source, score, options);
    capture::StabiliseOptions stabilise;
    for (const auto& one : source.jig()) stabilise.jig.push_back(one.first);
    const auto still = capture::stabilise(take, stabilise);
    std::vector<std::string> names;
    for (const auto& marker : capture::builtin_marker_set().markers) names.push_back(marker.name);
    const auto whole = capture::fill_gaps(capture::with_markers(still.markers, names));
    const auto there = capture::retarget(whole.markers, target_actor.labels);
    constexpr std::size_t every = 12;
    std::vector<std::vector<Vector>> truths(score.frames());
    for (std::size_t f = 0; f < score.frames(); f += every) {
        const auto truth = target.motion_mm(score.units, score.strength[f]);
        for (const auto method : animation::marker_methods()) {
            std::vector<Vector> made(truth.size());
            rig.by.at(method)->displace(there.markers.frame_mm(f), made);
            sums[method].add(truth, made, rig.lip_vertices);
        }
    }
}

void print(const std::string& title, const std::map<MarkerMethod, Sums>& sums) {
    fmt::print(
        "\n### {}\n\n| method | share | mean mm | 95 % mm | largest mm | lips mm |\n| --- | ---: | ---: | ---: | "
        "---: | ---: |\n",
        title);
    for (const auto& [method, one] : sums) fmt::print("| {} | {} |\n", animation::to_string(method), one.row());
    std::fflush(stdout);
}

void measure_world(const std::string& name, const std::vector<Actor>& actors, const std::vector<Rig>& rigs,
                   const Arguments& arguments) {
    std::map<MarkerMethod, Sums> sums;
    std::map<std::string, std::map<MarkerMethod, Sums>> by_unit;
    for (std::size_t k = 0; k < actors.size(); ++k) measure_a(actors[k], rigs[k], sums, by_unit);
    print(name + ", recording A", sums);
    if (arguments.per_unit) {
        fmt::print("\n| AU |");
        for (const auto method : animation::marker_methods()) fmt::print(" {} |", animation::to_string(method));
        fmt::print("\n| --- |");
        for (std::size_t k = 0; k < animation::marker_methods().size(); ++k) fmt::print(" ---: |");
        for (const auto& [unit, of] : by_unit) {
            fmt::print("\n| {} |", unit);
            for (const auto& [method, one] : of) fmt::print(" {:.2f} |", one.share());
        }
        fmt::print("\n");
    }
    fmt::print("\n");
    for (const auto method : {MarkerMethod::open_bones, MarkerMethod::bones, MarkerMethod::units_bones})
        for (std::size_t k = 0; k < actors.size(); ++k) {
            const auto& units = actors[k].units;
            const auto jaw = std::find(units.begin(), units.end(), "27");
            const auto raiser = std::find(units.begin(), units.end(), "10");
            if (jaw == units.end() || raiser == units.end()) continue;
            const auto down = static_cast<std::size_t>(jaw - units.begin());
            const auto up = static_cast<std::size_t>(raiser - units.begin());
            fmt::print("- leakage {} {}: lower to upper {:.1f} %, upper to lower (AU 10) {:.1f} %\n", actors[k].name,
                       animation::to_string(method), 100 * leakage(actors[k], rigs[k], method, down, true),
                       100 * leakage(actors[k], rigs[k], method, up, false));
        }
    std::fflush(stdout);
}

void measure_model(const std::string& name, const synthesis::FaceModel& model, const Shelf& shelf,
                   const Arguments& arguments) {
    auto units = std::make_shared<const std::vector<synthesis::PosedExpression>>(synthesis::units_that_show(model));
    std::vector<std::shared_ptr<const synthesis::Performer>> performers;
    std::vector<Actor> actors;
    std::vector<Rig> rigs;
    for (int k = 0; k < arguments.people; ++k) {
        performers.push_back(std::make_shared<const synthesis::Performer>(model, fmt::format("actor{}", k), 7));
        actors.push_back(actor_of(performers.back(), units));
        rigs.push_back(rig_of(actors.back(), shelf, arguments));
    }
    fmt::print("\n{}: {} vertices, {} lip vertices, {} units fitted\n", name, actors.front().rest_mm.size(),
               rigs.front().lip_vertices.size(), rigs.front().units.names.size());
    measure_world(name, actors, rigs, arguments);
    std::map<MarkerMethod, Sums> same, others;
    for (std::size_t s = 0; s < actors.size(); ++s)
        for (std::size_t t = 0; t < actors.size(); ++t)
            measure_b(*performers[s], actors[t], *performers[t], rigs[t], *units, s == t ? same : others);
    print(name + ", recording B, same person", same);
    if (actors.size() > 1) print(name + ", recording B, pairs", others);
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App app;
    app.add_option("--ict", arguments.ict);
    app.add_option("--makehuman", arguments.makehuman);
    app.add_option("--people", arguments.people);
    app.add_option("--radius-share", arguments.radius_share);
    app.add_option("--pull", arguments.pull);
    app.add_flag("--per-unit", arguments.per_unit);
    CLI11_PARSE(app, argc, argv);
    const Shelf shelf;
    if (arguments.people > 0) measure_model("built-in", *synthesis::make_builtin_face_model(), shelf, arguments);
    if (!arguments.ict.empty())
        measure_model("ICT-FaceKit", *synthesis::load_ict_face_model(arguments.ict), shelf, arguments);
    if (!arguments.makehuman.empty()) {
        std::vector<Actor> actors;
        std::vector<Rig> rigs;
        for (const char* subject : {"m00", "m03"})
            if (auto actor = makehuman_actor(arguments.makehuman, subject)) {
                actors.push_back(std::move(*actor));
                rigs.push_back(rig_of(actors.back(), shelf, arguments));
            }
        measure_world("MakeHuman", actors, rigs, arguments);
    }
    return 0;
}
