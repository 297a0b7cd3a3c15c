#include "evaluation/target_cases.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>

#include <fmt/format.h>

#include "base/parallel.h"
#include "geometry/surface_index.h"

namespace mimik::evaluation {

using animation::TargetFace;
using geometry::Point;
using geometry::Vector;
using modeling::ExpressionModel;
using preprocessing::Face;

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

MaterialPoints material_points(const database::TrueScan& neutral, const std::vector<Point>& vertices) {
    const geometry::SurfaceIndex surface(neutral.vertices_mm, geometry::triangulate(neutral.faces));
    const auto triangles = surface.triangles();
    MaterialPoints points;
    for (const auto& hit : surface.closest(vertices)) {
        points.triangles.push_back(triangles[hit.triangle]);
        points.barycentric.push_back(hit.barycentric);
    }
    return points;
}

/// The next `max_sources` of `count` after t, in a ring.
std::vector<std::size_t> sources_of(std::size_t t, std::size_t count, std::size_t max_sources) {
    std::vector<std::size_t> sources;
    for (std::size_t step = 1; step < count; ++step) {
        if (max_sources > 0 && sources.size() >= max_sources) break;
        sources.push_back((t + step) % count);
    }
    return sources;
}

/// One target while its cases are scored.
class TargetRun {
public:
    TargetRun(const PerformanceReader& reader, const ExpressionCast& cast, std::size_t t, const CaseChoice& choice,
              FailureList& failures)
        : cast_(cast),
          choice_(choice),
          failures_(failures),
          name_(cast.participants[t].id.subject),
          own_(reader.read(cast.participants[t].id)),
          sources_(sources_of(t, cast.participants.size(), choice.max_sources)),
          target_(scored_target(own_.neutral.grid, own_.expressive.grid, own_.neutral_from_expressive,
                                carry_zone(cast.zone, reader.workspace().average(), own_.neutral))) {
        if (own_.true_neutral) {
            std::vector<Point> queries;
            for (const auto v : target_.vertices) queries.push_back(grid().vertices_mm[v]);
            material_ = material_points(*own_.true_neutral, queries);
            scanner_from_head_ = own_.true_neutral->scanner_from_head.linear();
            for (std::size_t k = 0; k < queries.size(); ++k)
                target_.true_displacement_mm.push_back(scanner_from_head_ *
                                                       material_.of(own_.true_expression->displacement_mm, k));
        }
        still_.assign(grid().size(), Vector::Zero());
        nothing_ = judge_case(target_, grid().vertices_mm, still_, grid(), choice_.whole_face);
    }
    TargetRun(const TargetRun&) = delete;  // the prepared targets point to the neutral face
    TargetRun& operator=(const TargetRun&) = delete;

    std::vector<CaseResult> one_source(const Method& method, std::size_t models) {
        std::vector<CaseResult> cases;
        for (const auto s : ascending()) {
            const auto& source = cast_.participants[s];
            const auto& model = source.models[models];  // none: reported when it was measured
            cases.push_back(model ? put(method, source.id.subject, [&] { return &*model; }) : nothing_);
        }
        return cases;
    }

    std::vector<CaseResult> mean(const Method& method, std::size_t models) {
        std::optional<ExpressionModel> mean;
        return {put(method, "mean", [&] {
            modeling::ExpressionMean sum;
            for (const auto s : sources_)
                if (const auto& model = cast_.participants[s].models[models]) sum.add(*model);
            return &mean.emplace(sum.mean());
        })};
    }

    void true_fields(TargetCases& cases) const {
        auto field = still_, mean_field = still_;
        for (const auto s : sources_) {
            const auto source = cast_.true_fields.of(s);
            for (std::size_t k = 0; k < target_.vertices.size(); ++k) {
                const auto v = target_.vertices[k];
                field[v] = scanner_from_head_ * material_.of(*source, k);
                mean_field[v] += field[v] / static_cast<double>(sources_.size());
            }
            cases.true_field.push_back(judge_field(field));
        }
        // Told in the order of the sources, not of the ring.
        std::rotate(cases.true_field.begin(), cases.true_field.begin() + ring_start(), cases.true_field.end());
        cases.true_field_mean.push_back(judge_field(mean_field));
    }

private:
    [[nodiscard]] const geometry::QuadGrid& grid() const { return own_.neutral.grid; }

    /// Where the smallest source stands in the ring.
    [[nodiscard]] std::ptrdiff_t ring_start() const {
        return std::min_element(sources_.begin(), sources_.end()) - sources_.begin();
    }
    [[nodiscard]] std::vector<std::size_t> ascending() const {
        auto sorted = sources_;
        std::sort(sorted.begin(), sorted.end());
        return sorted;
    }

    template <typename Model>
    CaseResult put(const Method& method, const std::string& from, const Model& model) {
        try {
            const animation::WeightedExpression weighted{model(), method.magnitude};
            const auto animated = animation::animate(prepared(method), std::span(&weighted, 1), method.animation);
            auto result =
                judge_case(target_, animated.grid.vertices_mm, animated.displacement_mm, grid(), choice_.whole_face);
            result.step_mm = animated.extent.largest_neighbour_step_mm;
            return result;
        } catch (const std::exception& e) {
            failures_.add(fmt::format("{}: {} -> {} by {}: {}", cast_.expression, from, name_, method.name, e.what()));
            return nothing_;
        }
    }

    /// Made when a method first asks.
    const TargetFace& prepared(const Method& method) {
        const bool thesis = method.model.normalisation == modeling::Normalisation::affine;
        auto& face = thesis ? affine_ : similar_;
        if (!face) face.emplace(own_.neutral, method.model.normalisation, thesis);
        return *face;
    }

    [[nodiscard]] CaseResult judge_field(const std::vector<Vector>& displacement_mm) const {
        std::vector<Point> moved(grid().size());
        for (std::size_t v = 0; v < moved.size(); ++v) moved[v] = grid().vertices_mm[v] + displacement_mm[v];
        return judge_case(target_, moved, displacement_mm, grid(), choice_.whole_face);
    }

    const ExpressionCast& cast_;
    const CaseChoice& choice_;
    FailureList& failures_;
    std::string name_;
    Performance own_;
    std::vector<std::size_t> sources_;  // in the order of the ring
    ScoredTarget target_;
    MaterialPoints material_;
    Eigen::Matrix3d scanner_from_head_ = Eigen::Matrix3d::Identity();
    std::vector<Vector> still_;
    CaseResult nothing_;
    std::optional<TargetFace> similar_, affine_;
};

}  // namespace

TargetCases score_target(const PerformanceReader& reader, const ExpressionCast& cast, std::size_t t,
                         const CaseChoice& choice, FailureList& failures) {
    TargetCases none{.methods = std::vector<std::vector<CaseResult>>(choice.methods.size()),
                     .true_field = {},
                     .true_field_mean = {}};
    const auto shared = models_shared_by(choice.methods);
    try {
        auto cases = none;
        TargetRun run(reader, cast, t, choice, failures);
        for (std::size_t m = 0; m < choice.methods.size(); ++m) {
            const auto& method = choice.methods[m];
            cases.methods[m] =
                method.kind == RowKind::mean ? run.mean(method, shared[m]) : run.one_source(method, shared[m]);
        }
        if (choice.true_fields) run.true_fields(cases);
        return cases;
    } catch (const std::exception& e) {
        failures.add(
            fmt::format("{}: no case with target {}: {}", cast.expression, cast.participants[t].id.subject, e.what()));
        return none;
    }
}

void score_in_order(std::size_t count, const std::function<TargetCases(std::size_t)>& score,
                    const std::function<void(const TargetCases&)>& take) {
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;
    std::map<std::size_t, TargetCases> waiting;
    std::size_t taken = 0;
    base::parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            // Whichever piece the scheduler begins, it does the first target that nobody has begun.
            const std::size_t t = next.fetch_add(1);
            auto cases = score(t);
            const std::scoped_lock lock(mutex);
            waiting.emplace(t, std::move(cases));
            for (auto first = waiting.begin(); first != waiting.end() && first->first == taken;
                 first = waiting.erase(first), ++taken)
                take(first->second);
        }
    });
}

}  // namespace mimik::evaluation
