// How far labels that are fitted to another face are from the truth: the tables of docs/results.md, "Mesh
// registration".
//     mimik_label_fit_accuracy [--ict FOLDER] [--pairs N] [--noise MM] [--kernel K] [--rest warped|reference] ...
// scripts/mocap_numbers.sh runs it as the page says. Faces of one model share their vertices: the truth of a label is
// its place in the triangle of the reference. Fixed seeds; the same numbers on any number of threads, but for the
// times.

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "animation/dense_label_fit.h"
#include "base/random_stream.h"
#include "capture/label_fit.h"
#include "synthesis/performance.h"

namespace {

using namespace mimik;
using geometry::Landmarks;
using geometry::Point;

struct Arguments {
    std::string ict, kernel = "imq", rest = "warped";
    int pairs = 3;
    double noise_mm = 0;
    bool no_simplex = false;
    capture::LabelFitOptions fit;
    animation::DenseLabelFitOptions dense;
};

constexpr std::array by_hand = {"forehead_high",    "eye_outer_left", "eye_inner_left",    "eye_inner_right",
                                "eye_outer_right",  "nose_tip",       "mouth_corner_left", "mouth_corner_right",
                                "lip_upper_middle", "chin",           "jaw_outer_left",    "jaw_outer_right"};

struct Sums {
    std::vector<double> errors_mm;
    double start = 0, end = 0, seconds = 0;
    std::size_t evaluations = 0, runs = 0;
};

/// The labels of one face on the vertices of another one of its model.
Landmarks carried(const geometry::SurfaceIndex& from, const Landmarks& labels, const std::vector<Point>& to_mm) {
    std::vector<geometry::Landmark> list;
    for (const auto& label : labels.all()) {
        const auto at = from.closest(label.position_mm);
        Point place = Point::Zero();
        for (std::size_t c = 0; c < 3; ++c)
            place += at.barycentric[static_cast<Eigen::Index>(c)] * to_mm[from.triangles()[at.triangle][c]];
        list.push_back({label.name, place, ""});
    }
    return Landmarks(std::move(list));
}

Landmarks placed(const Landmarks& truth, const geometry::SurfaceIndex& target, double noise_mm, std::uint64_t seed) {
    base::RandomStream chance(seed, "label_fit_accuracy/hand");
    std::vector<geometry::Landmark> list;
    for (const auto* name : by_hand) {
        Point at = truth.position_mm(name);
        for (Eigen::Index k = 0; k < 3; ++k) at[k] += noise_mm * chance.normal();
        list.push_back({name, target.closest(at).position_mm, ""});
    }
    return Landmarks(std::move(list));
}

void add_errors(Sums& sums, const Landmarks& labels, const Landmarks& truth) {
    for (const auto& label : labels.all())
        if (std::find(by_hand.begin(), by_hand.end(), label.name) == by_hand.end())
            sums.errors_mm.push_back((label.position_mm - truth.position_mm(label.name)).norm());
    ++sums.runs;
}

void measure(const synthesis::FaceModel& model, const Arguments& arguments) {
    std::map<std::string, Sums> by;
    std::vector<std::string> order;
    const auto sums_of = [&](const std::string& name) -> Sums& {
        if (by.find(name) == by.end()) order.push_back(name);
        return by[name];
    };
    for (int pair = 0; pair < arguments.pairs; ++pair) {
        const auto seed = static_cast<std::uint64_t>(pair + 1);
        const synthesis::Performer source(model, "source", seed), person(model, "target", seed);
        const std::vector<geometry::Triangle> triangles(source.triangles().begin(), source.triangles().end());
        const geometry::SurfaceIndex reference(source.resting_mm(), triangles);
        const preprocessing::FitTarget target(person.resting_mm(), triangles);
        const auto labels = source.labels();
        const auto truth = carried(reference, labels, person.resting_mm());
        const auto points = placed(truth, target.surface(), arguments.noise_mm, seed);
        const auto start = capture::start_labels(reference, labels, target.surface(), points, arguments.fit);
        add_errors(sums_of("22 landmarks"), person.labels(), truth);
        std::vector<geometry::Landmark> warped;
        for (std::size_t k = 0; k < start.names.size(); ++k) warped.push_back({start.names[k], start.warped_mm[k], ""});
        add_errors(sums_of("RBF warp"), Landmarks(std::move(warped)), truth);
        add_errors(sums_of("start"), start.labels(), truth);
        for (const auto minimiser : capture::surface_minimisers()) {
            if (!capture::is_there(minimiser)) continue;
            if (minimiser == capture::SurfaceMinimiser::simplex && arguments.no_simplex) continue;
            const auto found = capture::fit_labels(start, labels, target.surface(), capture::builtin_marker_set(),
                                                   minimiser, arguments.fit);
            auto& sums = sums_of(capture::to_string(minimiser));
            add_errors(sums, found.labels, truth);
            sums.start += found.found.start.total;
            sums.end += found.found.end.total;
            sums.evaluations += found.found.evaluations;
            sums.seconds += found.found.seconds;
        }
        const auto dense =
            animation::fit_labels_densely(start, source.resting_mm(), triangles, labels, target, arguments.dense);
        auto& sums = sums_of("dense");
        add_errors(sums, dense.labels, truth);
        sums.seconds += dense.seconds;
    }
    fmt::print(
        "### {}: {} pairs, {} points placed with an error of {:g} mm; lengths of the {}, projected up to {:g} mm\n\n"
        "| by | mean, mm | median | 95th | largest | energy at the start | at the end | evaluations | s |\n"
        "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
        model.name(), arguments.pairs, by_hand.size(), arguments.noise_mm,
        arguments.rest == "reference" ? "reference" : "warped reference", arguments.fit.most_projected_mm);
    for (const auto& name : order) {
        auto& sums = by[name];
        double mean = 0;
        for (const double mm : sums.errors_mm) mean += mm / static_cast<double>(sums.errors_mm.size());
        std::sort(sums.errors_mm.begin(), sums.errors_mm.end());
        const auto at = [&](double share) {
            return sums.errors_mm[static_cast<std::size_t>(share * static_cast<double>(sums.errors_mm.size() - 1))];
        };
        const auto runs = static_cast<double>(sums.runs);
        fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |", name, mean, at(0.5), at(0.95), sums.errors_mm.back());
        if (sums.evaluations > 0)
            fmt::print(" {:.4f} | {:.4f} | {:.0f} |", sums.start / runs, sums.end / runs,
                       static_cast<double>(sums.evaluations) / runs);
        else
            fmt::print(" | | |");
        fmt::print(" {} |\n", sums.seconds > 0 ? fmt::format("{:.3f}", sums.seconds / runs) : "");
    }
    fmt::print("\n");
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App app("How far fitted labels are from the truth");
    app.add_option("--ict", arguments.ict, "Folder of ICT-FaceKit");
    app.add_option("--pairs", arguments.pairs, "Pairs of people of each model");
    app.add_option("--noise", arguments.noise_mm, "Standard deviation of the hand that places points, mm");
    app.add_option("--kernel", arguments.kernel, "imq, gaussian, wendland, r, r2logr")
        ->check(CLI::IsMember({"imq", "gaussian", "wendland", "r", "r2logr"}));
    app.add_option("--rest", arguments.rest, "warped or reference")->check(CLI::IsMember({"warped", "reference"}));
    app.add_option("--strain", arguments.fit.energy.strain, "Weight");
    app.add_option("--bending", arguments.fit.energy.bending, "Weight");
    app.add_option("--projected", arguments.fit.most_projected_mm, "mm");
    app.add_option("--evaluations", arguments.fit.minimise.most_evaluations, "Of the simplex");
    app.add_option("--step", arguments.fit.minimise.first_step_mm, "Of the simplex");
    app.add_option("--iterations", arguments.fit.minimise.most_iterations, "Of a stage");
    app.add_option("--change", arguments.fit.minimise.least_change, "Of a stage");
    app.add_option("--stages", arguments.fit.minimise.stages, "Stages");
    app.add_option("--width", arguments.fit.minimise.last_width_mm, "Last width");
    app.add_option("--around", arguments.dense.around_mm, "Of the dense fit");
    app.add_flag("--no-simplex", arguments.no_simplex, "Leave it out");
    CLI11_PARSE(app, argc, argv);
    using geometry::RadialKernel;
    for (const auto kernel : {RadialKernel::inverse_multiquadric, RadialKernel::gaussian, RadialKernel::wendland,
                              RadialKernel::r, RadialKernel::r2_log_r2})
        if (arguments.kernel == geometry::to_string(kernel)) arguments.fit.basis.kernel = kernel;
    arguments.fit.rest =
        arguments.rest == "reference" ? capture::LabelFitRest::reference : capture::LabelFitRest::warped;
    measure(*synthesis::make_builtin_face_model(), arguments);
    if (!arguments.ict.empty()) measure(*synthesis::load_ict_face_model(arguments.ict), arguments);
    return 0;
}
