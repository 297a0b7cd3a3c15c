#include "evaluation/experiment.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <mutex>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "evaluation/active_zone.h"
#include "geometry/errors.h"
#include "geometry/parallel.h"
#include "geometry/surface_index.h"
#include "preprocessing/control_pairs.h"
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

std::vector<std::string> shown_subjects(const preprocessing::Workspace& workspace) {
    std::vector<std::string> subjects;
    for (const auto& subject : workspace.subjects())
        if (!workspace.hidden(subject)) subjects.push_back(subject);
    return subjects;
}

}  // namespace

void ExperimentOptions::check() const {
    if (methods.empty()) throw InputError("an experiment without a method; give one or more of thesis, default, mean");
    if (expressions.empty())
        throw InputError("an experiment without an expression; give one or more, such as 12 or HAPPY");
    for (std::size_t k = 0; k < expressions.size(); ++k)
        if (std::find(expressions.begin(), expressions.begin() + static_cast<std::ptrdiff_t>(k), expressions[k]) !=
            expressions.begin() + static_cast<std::ptrdiff_t>(k))
            throw InputError(
                fmt::format("expression '{}' is asked for twice; its cases would count twice", expressions[k]));
    if (max_sources < 0) throw InputError(fmt::format("max_sources is {}; give 0 (all) or more", max_sources));
    for (const auto& method : methods) {
        method.model.check();
        method.animation.check();
    }
}

std::size_t experiment_steps(const preprocessing::Workspace& workspace, const ExperimentOptions& options) {
    std::size_t steps = 0;
    for (const auto& code : options.expressions)
        for (const auto& subject : shown_subjects(workspace)) steps += workspace.expression(subject, code) ? 1 : 0;
    return steps;
}

ExperimentReport run_experiment(const preprocessing::Workspace& workspace, const modeling::FacsCatalogue& catalogue,
                                const ExperimentOptions& options,
                                const std::function<void(const std::string&)>& progress) {
    options.check();
    for (const auto& code : options.expressions) (void)catalogue.resolve(code);
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

    std::mutex failures_mutex;
    const auto fail = [&](const std::string& what) {
        const std::scoped_lock lock(failures_mutex);
        report.failures.push_back(what);
    };

    // Found out before hours of work: an expression that too few show.
    for (const auto& code : options.expressions) {
        const auto shown = std::count_if(subjects.begin(), subjects.end(), [&](const std::string& subject) {
            return workspace.expression(subject, code).has_value();
        });
        if (shown < 3)
            throw InputError(fmt::format("{}: expression '{}': {} subjects show it; an experiment needs three or more",
                                         workspace.root().string(), code, shown));
    }

    std::vector<Face> neutrals(subjects.size());
    std::vector<char> usable(subjects.size(), 0);
    std::vector<synthesis::TrueScan> true_neutrals(has_truth ? subjects.size() : 0);
    geometry::parallel_for(subjects.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) try {
                neutrals[s] = workspace.face(workspace.neutral(subjects[s]));
                (void)preprocessing::landmark_spline(average.landmarks, neutrals[s].landmarks);  // zones need it
                if (has_truth) true_neutrals[s] = synthesis::load_true_scan(*truth, neutrals[s].id);
                usable[s] = 1;
            } catch (const std::exception& e) {
                fail(fmt::format("{}: takes part in no case: {}", subjects[s], e.what()));
            }
    });

    // Methods that model alike (default and mean) share their models.
    std::vector<std::size_t> models_of(options.methods.size());
    for (std::size_t m = 0; m < models_of.size(); ++m)
        for (models_of[m] = 0; !(options.methods[models_of[m]].model == options.methods[m].model);) ++models_of[m];

    for (const auto& code : options.expressions) {
        struct Participant {
            std::size_t subject = 0;
            ScanId id;
            bool read = false;
            Face expressive;
            synthesis::TrueScan truth;
            std::vector<std::optional<ExpressionModel>> models;  ///< per method; those of models_of only
        };
        std::vector<Participant> there;
        for (std::size_t s = 0; s < subjects.size(); ++s)
            if (const auto id = workspace.expression(subjects[s], code); id && usable[s])
                there.push_back({s, *id, false, {}, {}, std::vector<std::optional<ExpressionModel>>(models_of.size())});
        geometry::parallel_for(there.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                auto& own = there[k];
                try {
                    own.expressive = workspace.face(own.id);
                    if (has_truth) {
                        // From the neutral scan as it was, its micro-expression included, not from a face at rest.
                        own.truth = synthesis::load_true_scan(*truth, own.id);
                        const auto& at_rest = true_neutrals[own.subject].displacement_mm;
                        for (std::size_t v = 0; v < at_rest.size(); ++v) own.truth.displacement_mm[v] -= at_rest[v];
                    }
                    own.read = true;
                } catch (const std::exception& e) {
                    fail(fmt::format("{}: takes part in no case: {}", own.id.name(), e.what()));
                    continue;
                }
                for (std::size_t m = 0; m < models_of.size(); ++m) try {
                        if (models_of[m] == m)
                            own.models[m] =
                                modeling::measure_expression(catalogue, code, average, neutrals[own.subject],
                                                             own.expressive, options.methods[m].model);
                    } catch (const std::exception& e) {
                        fail(fmt::format("{} of {} by {}: no model: {}", code, own.id.subject, options.methods[m].name,
                                         e.what()));
                    }
            }
        });
        std::erase_if(there, [](const Participant& own) { return !own.read; });
        const std::size_t n = there.size();
        if (n < 3) {
            std::sort(report.failures.begin(), report.failures.end());
            throw InputError(
                fmt::format("expression '{}': {} subjects are left; an experiment needs three or more ({})", code, n,
                            fmt::join(report.failures, "; ")));
        }

        ActiveZone zone;
        if (has_truth) {
            std::vector<TrueSubject> known;
            known.reserve(there.size());
            for (const auto& own : there)
                known.push_back({&neutrals[own.subject], &true_neutrals[own.subject], &own.truth});
            zone = active_zone_from_truth(code, average, known);
        } else {
            zone = active_zone_from_catalogue(code, average, catalogue);
        }

        std::vector<std::vector<CaseResult>> cases(report.rows.size(), std::vector<CaseResult>(n * n));
        const auto score_target = [&](std::size_t t) {
            const auto& own = there[t];
            const Face& neutral = neutrals[own.subject];
            geometry::Transform neutral_from_expressive = own.expressive.neutral_from_scan;
            if (has_truth)
                neutral_from_expressive =
                    true_neutrals[own.subject].scanner_from_head * own.truth.scanner_from_head.inverse(Eigen::Isometry);
            auto target = scored_target(neutral.grid, own.expressive.grid, neutral_from_expressive,
                                        carry_zone(zone, average, neutral));
            MaterialPoints material;
            Eigen::Matrix3d scanner_from_head = Eigen::Matrix3d::Identity();
            if (has_truth) {
                std::vector<Point> queries;
                for (const auto v : target.vertices) queries.push_back(neutral.grid.vertices_mm[v]);
                material = material_points(true_neutrals[own.subject], queries);
                scanner_from_head = true_neutrals[own.subject].scanner_from_head.linear();
                for (std::size_t k = 0; k < queries.size(); ++k)
                    target.true_displacement_mm.push_back(scanner_from_head *
                                                          material.of(own.truth.displacement_mm, k));
            }

            std::vector<std::size_t> sources;
            for (std::size_t step = 1; step < n; ++step) {
                if (options.max_sources > 0 && sources.size() >= static_cast<std::size_t>(options.max_sources)) break;
                sources.push_back((t + step) % n);
            }

            // Made when a method first asks, and gone with the target: the memory does not grow with the subjects.
            std::optional<TargetFace> similar, affine;
            const auto put = [&](const Method& method, const ExpressionModel& model) {
                const bool thesis = method.model.frame == modeling::Frame::affine;
                auto& prepared = thesis ? affine : similar;
                if (!prepared) prepared.emplace(neutral, method.model.frame, thesis);
                const animation::WeightedExpression weighted{&model, method.magnitude};
                const auto animated = animation::animate(*prepared, std::span(&weighted, 1), method.animation);
                auto result = judge_case(target, animated.grid.vertices_mm, animated.displacement_mm, neutral.grid,
                                         options.whole_face);
                result.step_mm = animated.largest_neighbour_step_mm;
                return result;
            };
            const std::vector<Vector> still(neutral.grid.size(), Vector::Zero());
            const auto nothing = judge_case(target, neutral.grid.vertices_mm, still, neutral.grid, options.whole_face);
            const auto failed = [&](const std::string& from, const Method& method, const std::exception& e) {
                fail(fmt::format("{}: {} -> {} by {}: {}", code, from, own.id.subject, method.name, e.what()));
            };
            for (std::size_t m = 0; m < options.methods.size(); ++m) {
                const auto& method = options.methods[m];
                if (method.kind == RowKind::mean) {
                    std::vector<ExpressionModel> others;
                    for (const auto s : sources)
                        if (const auto& model = there[s].models[models_of[m]]) others.push_back(*model);
                    auto& result = cases[m][t * n + t];
                    try {
                        result = put(method, modeling::mean_expression(others));
                    } catch (const std::exception& e) {
                        failed("mean", method, e);
                        result = nothing;
                    }
                    continue;
                }
                for (const auto s : sources) {
                    const auto& model = there[s].models[models_of[m]];  // none: reported when it was measured
                    auto& result = cases[m][t * n + s];
                    try {
                        result = model ? put(method, *model) : nothing;
                    } catch (const std::exception& e) {
                        failed(there[s].id.subject, method, e);
                        result = nothing;
                    }
                }
            }
            if (with_reference) {
                const std::size_t one = options.methods.size(), mean = one + 1;
                std::vector<Vector> field = still, mean_field = still;
                std::vector<Point> moved(neutral.grid.size());
                const auto judge_field = [&](const std::vector<Vector>& displacement) {
                    for (std::size_t v = 0; v < moved.size(); ++v)
                        moved[v] = neutral.grid.vertices_mm[v] + displacement[v];
                    return judge_case(target, moved, displacement, neutral.grid, options.whole_face);
                };
                for (const auto s : sources) {
                    for (std::size_t k = 0; k < target.vertices.size(); ++k) {
                        field[target.vertices[k]] = scanner_from_head * material.of(there[s].truth.displacement_mm, k);
                        mean_field[target.vertices[k]] +=
                            field[target.vertices[k]] / static_cast<double>(sources.size());
                    }
                    cases[one][t * n + s] = judge_field(field);
                }
                cases[mean][t * n + t] = judge_field(mean_field);
            }
        };
        geometry::parallel_for(n, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t t = begin; t < end; ++t) {
                try {
                    score_target(t);
                } catch (const std::exception& e) {
                    fail(fmt::format("{}: no case with target {}: {}", code, there[t].id.subject, e.what()));
                }
                if (progress) progress(fmt::format("{} {}", code, there[t].id.subject));
            }
        });
        for (std::size_t r = 0; r < report.rows.size(); ++r)
            report.rows[r].per_expression[code] = summarise_cases(cases[r]);
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
