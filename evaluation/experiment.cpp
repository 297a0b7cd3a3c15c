#include "evaluation/experiment.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <numeric>

#include <fmt/format.h>

#include "evaluation/active_zone.h"
#include "geometry/errors.h"
#include "geometry/parallel.h"
#include "geometry/surface_index.h"
#include "synthesis/truth.h"

namespace mimik::evaluation {

using animation::TargetFace;
using database::ScanId;
using geometry::Point;
using geometry::Vector;
using modeling::ExpressionModel;
using preprocessing::Face;

Method method_by_name(const std::string& name) {
    if (name == "thesis")
        return {name, RowKind::one_source, modeling::ModelOptions::thesis(), animation::AnimationOptions::thesis(),
                1.0};
    if (name == "default") return {name, RowKind::one_source, {}, {}, 1.0};
    if (name == "mean") return {name, RowKind::mean, {}, {}, 1.0};
    throw InputError(fmt::format("method '{}' is unknown; there are: thesis, default, mean", name));
}

namespace {

/// Everything about one target that all methods share.
struct Target {
    std::vector<std::uint32_t> vertices;               ///< scored: measured, and doing nothing does not hit the border
    std::vector<char> in_zone;                         ///< parallel to `vertices`
    std::vector<double> nothing_mm;                    ///< parallel to `vertices`
    std::vector<Vector> true_displacement_mm;          ///< parallel to `vertices`, scanner frame; empty without a truth
    std::optional<geometry::SurfaceIndex> expressive;  ///< the real expressive scan, in the neutral's scanner frame
};

struct CaseResult {
    bool done = false;
    double zone_mm = 0, zone_nothing_mm = 0, whole_mm = 0, whole_nothing_mm = 0;
    double true_mm = -1, true_nothing_mm = -1, step_mm = 0;
    std::size_t left_out = 0;
};

/// Where the vertices of a target lie on its true neutral surface: carries any subject's true field over.
struct MaterialPoints {
    std::vector<geometry::Triangle> triangles;  ///< per vertex
    std::vector<Eigen::Vector3d> barycentric;
    [[nodiscard]] Vector of(const std::vector<Vector>& field, std::size_t k) const {
        Vector value = Vector::Zero();
        for (std::size_t c = 0; c < 3; ++c)
            value += barycentric[k][static_cast<Eigen::Index>(c)] * field[triangles[k][c]];
        return value;
    }
};

MaterialPoints material_points(const synthesis::TrueScan& neutral, const std::vector<Point>& vertices) {
    const geometry::SurfaceIndex surface(neutral.vertices_mm, geometry::triangulate(neutral.faces));
    const auto triangles = surface.triangles();
    MaterialPoints points;
    for (const auto& hit : surface.closest(vertices)) {
        points.triangles.push_back(triangles[hit.triangle]);
        points.barycentric.push_back(hit.barycentric);
    }
    return points;
}

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

std::vector<std::string> shown_subjects(const preprocessing::Workspace& workspace) {
    std::vector<std::string> subjects;
    for (const auto& subject : workspace.subjects())
        if (!workspace.hidden(subject)) subjects.push_back(subject);
    return subjects;
}

CaseResult judge(const Target& target, const std::vector<Point>& animated_mm,
                 const std::vector<Vector>& displacement_mm, const geometry::QuadGrid& grid, bool whole_face) {
    CaseResult result;
    result.done = true;
    // A vertex that stays where it was, or was left out, has the distance of doing nothing: only the others are asked.
    std::vector<Point> queries;
    std::vector<std::size_t> asked, moved;
    std::vector<double> distance_mm;
    for (std::size_t k = 0; k < target.vertices.size(); ++k) {
        if (!whole_face && !target.in_zone[k]) continue;
        const Point& p = animated_mm[target.vertices[k]];
        if (!p.allFinite()) {
            ++result.left_out;
        } else if (p != grid.vertices_mm[target.vertices[k]]) {
            moved.push_back(asked.size());
            queries.push_back(p);
        }
        asked.push_back(k);
        distance_mm.push_back(target.nothing_mm[k]);
    }
    const auto hits = target.expressive->closest(queries);
    for (std::size_t i = 0; i < moved.size(); ++i) distance_mm[moved[i]] = hits[i].distance_mm;
    double zone = 0, zone_nothing = 0, whole = 0, whole_nothing = 0, true_sum = 0, true_nothing = 0;
    std::size_t zone_count = 0;
    for (std::size_t i = 0; i < asked.size(); ++i) {
        const std::size_t k = asked[i];
        whole += distance_mm[i];
        whole_nothing += target.nothing_mm[k];
        if (!target.in_zone[k]) continue;
        ++zone_count;
        zone += distance_mm[i];
        zone_nothing += target.nothing_mm[k];
        if (!target.true_displacement_mm.empty()) {
            true_sum += (displacement_mm[target.vertices[k]] - target.true_displacement_mm[k]).norm();
            true_nothing += target.true_displacement_mm[k].norm();
        }
    }
    const auto count = static_cast<double>(std::max<std::size_t>(1, zone_count));
    result.zone_mm = zone / count;
    result.zone_nothing_mm = zone_nothing / count;
    if (whole_face && !asked.empty()) {
        result.whole_mm = whole / static_cast<double>(asked.size());
        result.whole_nothing_mm = whole_nothing / static_cast<double>(asked.size());
    }
    if (!target.true_displacement_mm.empty()) {
        result.true_mm = true_sum / count;
        result.true_nothing_mm = true_nothing / count;
    }
    return result;
}

Score summarise(const std::vector<CaseResult>& cases) {
    Score score;
    double method = 0, nothing = 0, whole = 0, whole_nothing = 0, truth = 0, truth_nothing = 0;
    std::size_t with_truth = 0;
    std::vector<double> explained;
    for (const auto& result : cases) {
        if (!result.done) continue;
        ++score.cases;
        method += result.zone_mm;
        nothing += result.zone_nothing_mm;
        whole += result.whole_mm;
        whole_nothing += result.whole_nothing_mm;
        score.largest_step_mm += result.step_mm;
        score.left_out_vertices += result.left_out;
        if (result.true_mm >= 0) {
            truth += result.true_mm;
            truth_nothing += result.true_nothing_mm;
            ++with_truth;
        }
        if (result.zone_nothing_mm > 0) explained.push_back(1 - result.zone_mm / result.zone_nothing_mm);
        if (result.zone_mm > result.zone_nothing_mm) ++score.worse_than_nothing;
    }
    if (score.cases == 0) return score;
    const auto n = static_cast<double>(score.cases);
    score.explained = nothing > 0 ? 1 - method / nothing : 0;
    score.explained_median = median(explained);
    score.explained_whole = whole_nothing > 0 ? 1 - whole / whole_nothing : 0;
    score.error_mm = method / n;
    score.nothing_mm = nothing / n;
    score.largest_step_mm /= n;
    if (with_truth > 0) {
        score.true_error_mm = truth / static_cast<double>(with_truth);
        score.nothing_true_mm = truth_nothing / static_cast<double>(with_truth);
    }
    return score;
}

}  // namespace

std::size_t experiment_steps(const preprocessing::Workspace& workspace, const ExperimentOptions& options) {
    std::size_t steps = 0;
    for (const auto& code : options.expressions)
        for (const auto& subject : shown_subjects(workspace)) steps += workspace.expression(subject, code) ? 1 : 0;
    return steps;
}

ExperimentReport run_experiment(const preprocessing::Workspace& workspace, const modeling::FacsCatalogue& catalogue,
                                const ExperimentOptions& options,
                                const std::function<void(const std::string&)>& progress) {
    const auto start = std::chrono::steady_clock::now();
    ExperimentReport report;
    report.subjects = shown_subjects(workspace);
    report.expressions = options.expressions;
    std::optional<synthesis::Truth> truth;
    if (std::filesystem::exists(workspace.database_root() / "truth" / "truth.json"))
        truth = synthesis::open_truth(workspace.database_root());
    const bool has_truth = truth.has_value();
    report.zones = has_truth ? "truth" : "catalogue";
    report.alignment = has_truth ? "true pose" : "ICP on the stable region";
    const auto& average = workspace.average();
    const auto& subjects = report.subjects;

    for (const auto& method : options.methods)
        report.rows.push_back({method.name, method.kind, false, {}, 0, 0, 0, {}});
    const bool with_reference = options.reference && has_truth;
    if (with_reference) {
        report.rows.push_back({"true field, one source", RowKind::one_source, true, {}, 0, 0, 0, {}});
        report.rows.push_back({"true field, mean", RowKind::mean, true, {}, 0, 0, 0, {}});
    }

    // Held for all subjects: neutral faces and, of a synthetic database, their truth. What a target needs beside them
    // is made when its turn comes, and costs little beside its transfers.
    std::vector<Face> neutrals(subjects.size());
    std::vector<synthesis::TrueScan> true_neutrals(has_truth ? subjects.size() : 0);
    geometry::parallel_for(subjects.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            neutrals[s] = workspace.face(workspace.neutral(subjects[s]));
            if (has_truth) true_neutrals[s] = synthesis::load_true_scan(*truth, neutrals[s].id);
        }
    });

    // Methods that model alike (default and mean) share the work of the first of them.
    std::vector<std::size_t> model_of;
    for (std::size_t m = 0; m < options.methods.size(); ++m) {
        std::size_t first = 0;
        while (options.methods[first].model != options.methods[m].model) ++first;
        model_of.push_back(first);
    }

    std::mutex failures_mutex;
    const auto fail = [&](const std::string& what) {
        const std::scoped_lock lock(failures_mutex);
        report.failures.push_back(what);
    };

    for (const auto& code : options.expressions) {
        std::vector<std::size_t> who;
        std::vector<ScanId> ids;
        for (std::size_t s = 0; s < subjects.size(); ++s)
            if (const auto id = workspace.expression(subjects[s], code)) {
                who.push_back(s);
                ids.push_back(*id);
            }
        const std::size_t n = who.size();
        if (n < 3)
            throw InputError(
                fmt::format("expression '{}': {} subjects show it; an experiment needs three or more", code, n));

        std::vector<Face> expressives(n);
        std::vector<synthesis::TrueScan> true_expressives(has_truth ? n : 0);
        std::vector<std::vector<std::optional<ExpressionModel>>> models(options.methods.size(),
                                                                        std::vector<std::optional<ExpressionModel>>(n));
        geometry::parallel_for(n, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                expressives[k] = workspace.face(ids[k]);
                if (has_truth) {
                    // From the neutral scan as it was, its micro-expression included, not from a face at rest.
                    true_expressives[k] = synthesis::load_true_scan(*truth, ids[k]);
                    const auto& at_rest = true_neutrals[who[k]].displacement_mm;
                    for (std::size_t v = 0; v < at_rest.size(); ++v)
                        true_expressives[k].displacement_mm[v] -= at_rest[v];
                }
                for (std::size_t m = 0; m < options.methods.size(); ++m) {
                    if (model_of[m] != m) continue;
                    try {
                        models[m][k] = modeling::measure_expression(catalogue, code, average, neutrals[who[k]],
                                                                    expressives[k], options.methods[m].model);
                    } catch (const std::exception& e) {
                        fail(
                            fmt::format("{} of {} by {}: {}", code, ids[k].subject, options.methods[m].name, e.what()));
                    }
                }
            }
        });

        ActiveZone zone;
        if (has_truth) {
            std::vector<TrueSubject> known;
            for (std::size_t k = 0; k < n; ++k)
                known.push_back({&neutrals[who[k]], &true_neutrals[who[k]], &true_expressives[k]});
            zone = active_zone_from_truth(code, average, known);
        } else {
            zone = active_zone_from_catalogue(code, average, catalogue);
        }

        std::vector<std::vector<CaseResult>> cases(report.rows.size(), std::vector<CaseResult>(n * n));
        geometry::parallel_for(n, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t t = begin; t < end; ++t) {
                const Face& neutral = neutrals[who[t]];
                Target target;
                {
                    geometry::Transform neutral_from_expressive = expressives[t].neutral_from_scan;
                    if (has_truth)
                        neutral_from_expressive = true_neutrals[who[t]].scanner_from_head *
                                                  true_expressives[t].scanner_from_head.inverse(Eigen::Isometry);
                    std::vector<Point> vertices;
                    for (const auto& p : expressives[t].grid.vertices_mm)
                        vertices.emplace_back(neutral_from_expressive * p);
                    target.expressive.emplace(
                        vertices, geometry::triangles(expressives[t].grid, geometry::BridgedVertices::leave_out));
                }
                const auto zone_here = carry_zone(zone, average, neutral);
                {
                    std::vector<std::uint32_t> measured;
                    std::vector<Point> queries;
                    for (std::uint32_t v = 0; v < neutral.grid.size(); ++v)
                        if (neutral.grid.measured(v)) {
                            measured.push_back(v);
                            queries.push_back(neutral.grid.vertices_mm[v]);
                        }
                    const auto hits = target.expressive->closest(queries);
                    for (std::size_t k = 0; k < measured.size(); ++k) {
                        if (target.expressive->on_border(hits[k])) continue;
                        target.vertices.push_back(measured[k]);
                        target.in_zone.push_back(zone_here[measured[k]]);
                        target.nothing_mm.push_back(hits[k].distance_mm);
                    }
                }
                MaterialPoints material;
                Eigen::Matrix3d scanner_from_head = Eigen::Matrix3d::Identity();
                if (has_truth) {
                    std::vector<Point> queries;
                    for (const auto v : target.vertices) queries.push_back(neutral.grid.vertices_mm[v]);
                    material = material_points(true_neutrals[who[t]], queries);
                    scanner_from_head = true_neutrals[who[t]].scanner_from_head.linear();
                    for (std::size_t k = 0; k < queries.size(); ++k)
                        target.true_displacement_mm.push_back(scanner_from_head *
                                                              material.of(true_expressives[t].displacement_mm, k));
                }

                std::vector<std::size_t> sources;
                for (std::size_t step = 1; step < n; ++step) {
                    if (options.max_sources > 0 && sources.size() >= static_cast<std::size_t>(options.max_sources))
                        break;
                    sources.push_back((t + step) % n);
                }

                const TargetFace similar(neutral, modeling::Frame::similarity);
                const TargetFace affine(neutral, modeling::Frame::affine, true);
                const auto put = [&](const Method& method, const ExpressionModel& model) {
                    const auto& prepared = method.model.frame == modeling::Frame::affine ? affine : similar;
                    const animation::WeightedExpression weighted{&model, method.magnitude};
                    const auto animated = animation::animate(prepared, std::span(&weighted, 1), method.animation);
                    auto result = judge(target, animated.grid.vertices_mm, animated.displacement_mm, neutral.grid,
                                        options.whole_face);
                    result.step_mm = animated.largest_neighbour_step_mm;
                    return result;
                };
                const auto nothing = [&] {
                    const std::vector<Vector> still(neutral.grid.size(), Vector::Zero());
                    return judge(target, neutral.grid.vertices_mm, still, neutral.grid, options.whole_face);
                };
                for (std::size_t m = 0; m < options.methods.size(); ++m) {
                    const auto& method = options.methods[m];
                    const auto& modelled = models[model_of[m]];
                    std::vector<ExpressionModel> others;
                    for (const auto s : sources)
                        if (modelled[s]) {
                            if (method.kind == RowKind::mean) others.push_back(*modelled[s]);
                        }
                    try {
                        if (method.kind == RowKind::mean) {
                            cases[m][t * n + t] = put(method, modeling::mean_expression(others));
                            continue;
                        }
                    } catch (const std::exception& e) {
                        fail(fmt::format("{}: mean -> {} by {}: {}", code, subjects[who[t]], method.name, e.what()));
                        cases[m][t * n + t] = nothing();
                        continue;
                    }
                    for (const auto s : sources) {
                        try {
                            cases[m][t * n + s] = modelled[s] ? put(method, *modelled[s]) : nothing();
                        } catch (const std::exception& e) {
                            fail(fmt::format("{}: {} -> {} by {}: {}", code, subjects[who[s]], subjects[who[t]],
                                             method.name, e.what()));
                            cases[m][t * n + s] = nothing();
                        }
                    }
                }
                if (with_reference) {
                    const std::size_t one = options.methods.size(), mean = one + 1;
                    std::vector<Vector> field(neutral.grid.size(), Vector::Zero()), mean_field = field;
                    std::vector<Point> moved(neutral.grid.size());
                    const auto judge_field = [&](const std::vector<Vector>& displacement) {
                        for (std::size_t v = 0; v < moved.size(); ++v)
                            moved[v] = neutral.grid.vertices_mm[v] + displacement[v];
                        return judge(target, moved, displacement, neutral.grid, options.whole_face);
                    };
                    for (const auto s : sources) {
                        for (std::size_t k = 0; k < target.vertices.size(); ++k) {
                            field[target.vertices[k]] =
                                scanner_from_head * material.of(true_expressives[s].displacement_mm, k);
                            mean_field[target.vertices[k]] +=
                                field[target.vertices[k]] / static_cast<double>(sources.size());
                        }
                        cases[one][t * n + s] = judge_field(field);
                    }
                    cases[mean][t * n + t] = judge_field(mean_field);
                }
                if (progress) progress(fmt::format("{} {}", code, subjects[who[t]]));
            }
        });
        for (std::size_t r = 0; r < report.rows.size(); ++r) report.rows[r].per_expression[code] = summarise(cases[r]);
    }

    for (auto& row : report.rows)
        for (const auto& [code, score] : row.per_expression) {
            const auto count = static_cast<double>(row.per_expression.size());
            row.explained += score.explained / count;
            row.explained_median += score.explained_median / count;
            row.explained_whole += score.explained_whole / count;
        }
    for (auto& row : report.rows)
        for (const auto& other : report.rows)
            if (other.reference && other.kind == row.kind && !row.reference && other.explained > 0)
                row.share = row.explained / other.explained;
    std::sort(report.failures.begin(), report.failures.end());
    report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report;
}

}  // namespace mimik::evaluation
