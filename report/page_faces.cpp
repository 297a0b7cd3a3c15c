#include "report/page_faces.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "animation/method.h"
#include "animation/prepared_target.h"
#include "base/errors.h"
#include "base/parallel.h"
#include "evaluation/active_zone.h"
#include "evaluation/cast.h"
#include "evaluation/estimator.h"
#include "evaluation/score.h"
#include "evaluation/scored_target.h"
#include "evaluation/surface_distance.h"
#include "evaluation/target_estimators.h"
#include "geometry/box.h"
#include "geometry/face_surface.h"
#include "geometry/point_index.h"
#include "io/json_values.h"
#include "modeling/control_points.h"
#include "report/page_buffers.h"

namespace mimik::report {
namespace {

using animation::SourceKind;
using evaluation::CaseRow;
using evaluation::Cast;
using evaluation::ExperimentPlan;
using geometry::Point;
using geometry::QuadGrid;
using geometry::Vector;
using nlohmann::ordered_json;

bool is_judged(const animation::Method& method) {
    return method.name() != evaluation::baseline_method && !method.needs_truth();
}

/// Errors of one method on one target and expression, and of doing nothing there.
struct Sums {
    double error = 0, nothing = 0;
};

/// What each method explains of each target: mean over the expressions.
using TargetScores = std::map<std::string, std::map<std::string, double>>;  // by method, by target

TargetScores target_scores(const evaluation::CaseRowReader& read) {
    std::map<std::array<std::string, 2>, double> nothing;                  // by target and expression
    std::map<std::string, std::map<std::array<std::string, 2>, Sums>> of;  // by method, likewise
    const auto visit_zone = [&](const auto& visit) {
        read([&](const CaseRow& row) {
            if (row.estimator == "surface_distance" && row.region == "zone" && row.metric == "mean" && row.value)
                visit(row);
        });
    };
    visit_zone([&](const CaseRow& row) {
        if (row.key.method == evaluation::baseline_method) nothing[{row.key.target, row.key.expression}] = *row.value;
    });
    visit_zone([&](const CaseRow& row) {
        const auto found = nothing.find({row.key.target, row.key.expression});
        if (found == nothing.end() || row.key.magnitude != 1.0) return;
        auto& sums = of[row.key.method][{row.key.target, row.key.expression}];
        sums.error += *row.value;
        sums.nothing += found->second;
    });
    TargetScores scores;
    for (const auto& [method, cases] : of) {
        std::map<std::string, std::pair<double, int>> means;
        for (const auto& [key, sums] : cases) {
            if (sums.nothing <= evaluation::least_motion_mm) continue;
            auto& [sum, count] = means[key[0]];
            sum += 1 - sums.error / sums.nothing;
            ++count;
        }
        for (const auto& [target, mean] : means) scores[method][target] = mean.first / mean.second;
    }
    return scores;
}

double mean_of(const std::map<std::string, double>& values) {
    double sum = 0;
    for (const auto& [name, value] : values) sum += value;
    return values.empty() ? -std::numeric_limits<double>::infinity() : sum / static_cast<double>(values.size());
}

std::vector<std::string> shown_methods(const TargetScores& scores, const ExperimentPlan& plan,
                                       const std::vector<std::string>& asked) {
    std::vector<std::string> names;
    for (const auto& method : plan.methods)
        if (method->name() != evaluation::baseline_method) names.push_back(method->name());
    for (const auto& name : asked)
        if (std::find(names.begin(), names.end(), name) == names.end())
            throw InputError(
                fmt::format("method '{}' is none of the experiment; it has {}", name, fmt::join(names, ", ")));
    if (!asked.empty()) return asked;
    std::set<std::string> wanted;
    std::map<SourceKind, std::pair<double, std::string>> best;
    for (const auto& method : plan.methods) {
        const auto found = scores.find(method->name());
        if (!is_judged(*method) || found == scores.end()) continue;
        if (wanted.empty()) wanted.insert(method->name());  // the first
        const std::pair candidate(mean_of(found->second), method->name());
        const auto [place, is_new] = best.emplace(method->needs(), candidate);
        if (!is_new && candidate.first > place->second.first) place->second = candidate;
    }
    for (const auto& [kind, entry] : best) wanted.insert(entry.second);
    std::vector<std::string> shown;
    for (const auto& name : names)
        if (wanted.contains(name)) shown.push_back(name);
    return shown;
}

}  // namespace

void PageFacesOptions::check() const {
    if (most_faces < 0) throw InputError(fmt::format("most_faces is {}; give 0 (none) or more", most_faces));
}

PageChoice choose_faces(const evaluation::CaseRowReader& read, const ExperimentPlan& plan,
                        const PageFacesOptions& options) {
    options.check();
    const auto scores = target_scores(read);
    PageChoice choice;
    choice.methods = shown_methods(scores, plan, options.methods);
    std::string judge;
    double greatest = -std::numeric_limits<double>::infinity();
    for (const auto& name : choice.methods) {
        const auto found = scores.find(name);
        if (found == scores.end() || mean_of(found->second) <= greatest) continue;
        greatest = mean_of(found->second);
        judge = name;
    }
    std::vector<std::pair<double, std::string>> ranked;
    if (!judge.empty())
        for (const auto& [target, value] : scores.at(judge)) ranked.emplace_back(-value, target);
    std::sort(ranked.begin(), ranked.end());
    const auto add = [&](std::size_t rank) {
        choice.faces.push_back(
            {ranked[rank].second, fmt::format("rank {} of {} by {}", rank + 1, ranked.size(), judge)});
    };
    for (const auto& target : options.targets) {
        const auto found =
            std::find_if(ranked.begin(), ranked.end(), [&](const auto& r) { return r.second == target; });
        if (found == ranked.end())
            throw InputError(fmt::format("target '{}' has no row in the experiment; rows.csv lists who has", target));
        add(static_cast<std::size_t>(found - ranked.begin()));
    }
    if (!options.targets.empty()) return choice;
    const auto count = std::min(ranked.size(), static_cast<std::size_t>(options.most_faces));
    for (std::size_t k = 0; k < count; ++k) add(count == 1 ? 0 : k * (ranked.size() - 1) / (count - 1));
    return choice;
}

namespace {

/// How the page stands before the camera: turned upright, with the middle of the face at the origin.
struct PageFrame {
    Eigen::Matrix3d page_from_scan = Eigen::Matrix3d::Identity();
    Point middle_mm = Point::Zero();
    [[nodiscard]] Point place(const Point& p) const { return page_from_scan * (p - middle_mm); }
};

PageFrame frame_of(const preprocessing::Face& neutral) {
    PageFrame frame;
    frame.page_from_scan = neutral.average_from_scan.rotation();
    frame.middle_mm = geometry::box_of(geometry::to_mesh(neutral.grid).vertices_mm).center();
    return frame;
}

std::vector<std::uint32_t> inside_of(const QuadGrid& grid) {
    std::vector<std::uint32_t> inside;
    for (std::uint32_t v = 0; v < grid.size(); ++v)
        if (grid.inside(v) && grid.vertices_mm[v].allFinite()) inside.push_back(v);
    return inside;
}

/// x, y and z, each packed.
template <class At>
ordered_json packed_points(std::size_t count, const At& at) {
    auto axes = ordered_json::array();
    std::vector<Vector> points(count);
    for (std::size_t k = 0; k < count; ++k) points[k] = at(k);
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<std::int16_t> steps(count);
        for (std::size_t k = 0; k < count; ++k) steps[k] = in_page_steps(points[k][axis]);
        axes.push_back(packed_steps(steps));
    }
    return axes;
}

/// A gridded surface: what the browser makes vertices and triangles of.
ordered_json packed_grid(const QuadGrid& grid, const std::vector<std::uint32_t>& inside, const PageFrame& frame,
                         const geometry::Transform& neutral_from_grid) {
    std::vector<std::uint8_t> origin(grid.size(), 0);
    for (const auto v : inside) origin[v] = static_cast<std::uint8_t>(grid.origin[v]);
    return {{"rows", grid.rows},
            {"cols", grid.cols},
            {"vertices", inside.size()},
            {"origin", packed_bytes(origin)},
            {"positions", packed_points(inside.size(), [&](std::size_t k) {
                 return frame.place(neutral_from_grid * grid.vertices_mm[inside[k]]);
             })}};
}

/// Catalogue points of an expression: placed on the average face, carried over, then the nearest vertex of the page.
ordered_json control_points(const facs::FacsCatalogue& catalogue, const facs::Expression& expression,
                            const preprocessing::AverageFace& average, const preprocessing::Face& neutral,
                            const std::vector<std::uint32_t>& inside) {
    auto points = ordered_json::array();
    const geometry::SurfaceIndex surface(geometry::face_surface(average.grid, average.landmarks).vertices_mm,
                                         geometry::triangles(average.grid));
    const auto placed = modeling::place_controls(catalogue, expression, average.landmarks, surface, {false, false});
    if (placed.controls.empty()) return points;
    const auto carried = evaluation::average_vertices_on(average, neutral);
    std::vector<Point> on_average, on_face, present;
    for (std::size_t v = 0; v < average.grid.size(); ++v)
        if (average.grid.inside(v) && carried[v].allFinite()) {
            on_average.push_back(average.grid.vertices_mm[v]);
            on_face.push_back(carried[v]);
        }
    for (const auto v : inside) present.push_back(neutral.grid.vertices_mm[v]);
    const geometry::PointIndex nearest_on_average(on_average), nearest_on_face(present);
    for (const auto& control : placed.controls) {
        const auto there = nearest_on_average.nearest(control.position_mm);
        points.push_back({{"name", control.name},
                          {"kind", facs::to_string(control.kind)},
                          {"vertex", nearest_on_face.nearest(on_face[there.index]).index}});
    }
    return points;
}

/// One expression of one target, while its part of the page is made.
class ExpressionOnFace {
public:
    ExpressionOnFace(const evaluation::PerformanceReader& reader, const ExperimentPlan& plan, const Cast& cast,
                     std::size_t t)
        : plan_(plan),
          cast_(cast),
          t_(t),
          own_(reader.read(cast.participants[t])),
          prepared_(own_.neutral, own_.true_neutral ? &*own_.true_neutral : nullptr),
          aligned_(evaluation::neutral_from_expressive(plan.alignment, own_)),
          zone_(evaluation::carry_zone(cast.zone, reader.workspace().average(), own_.neutral)),
          scored_(evaluation::scored_target(prepared_.surface(), own_.expressive.grid, aligned_, zone_)),
          inside_(inside_of(own_.neutral.grid)),
          frame_(frame_of(own_.neutral)) {}

    [[nodiscard]] ordered_json begun(const preprocessing::AverageFace& average) const {
        const auto still = geometry::DisplacementField::still(prepared_.surface().size());
        std::vector<std::uint8_t> zone(own_.neutral.grid.size(), 0);
        for (std::size_t k = 0; k < scored_.vertices.size(); ++k)
            if (scored_.in_zone[k] != 0) zone[scored_.vertices[k]] = 1;
        std::vector<std::uint8_t> packed;
        for (const auto v : inside_) packed.push_back(zone[v]);
        return {{"code", cast_.expression.code()},
                {"zone", packed_bytes(packed)},
                {"controls", control_points(cast_.catalogue, cast_.expression, average, own_.neutral, inside_)},
                {"real", packed_grid(own_.expressive.grid, inside_of(own_.expressive.grid), frame_, aligned_)},
                {"nothing", judged(still)},
                {"shapes", ordered_json::array()}};
    }

    /// The motion of a method from the target's first source that taught it something. Null: there is none.
    [[nodiscard]] ordered_json shape(std::size_t m) const {
        const auto& method = *plan_.methods[m];
        if (!cast_.lessons.can_learn(m)) return {};
        std::string source;
        std::vector<animation::LessonPointer> lessons;
        if (method.needs() != SourceKind::none)
            for (const auto s : plan_.sources_of(t_, cast_.participants)) {
                auto lesson = cast_.lessons.lesson(m, s);
                if (!lesson) continue;
                lessons.push_back(std::move(lesson));
                source = method.needs() == SourceKind::one_source ? cast_.participants[s].subject : "mean";
                if (method.needs() == SourceKind::one_source) break;
            }
        if (method.needs() != SourceKind::none && lessons.empty()) return {};
        const auto transfer = cast_.lessons.learner(m).learn(lessons);
        const auto field = animation::field_on(*transfer, prepared_);
        auto shape = judged(field);
        shape["method"] = method.name();
        shape["source"] = source;
        shape["motion"] = packed_points(
            inside_.size(), [&](std::size_t k) -> Vector { return frame_.page_from_scan * way_mm(field, inside_[k]); });
        std::vector<std::uint8_t> lips;
        if (const auto sides = transfer->lip_sides(prepared_); !sides.empty())
            for (const auto v : inside_) lips.push_back(static_cast<std::uint8_t>(sides[v]));
        shape["lips"] = lips.empty() ? ordered_json() : ordered_json(packed_bytes(lips));
        return shape;
    }

    [[nodiscard]] ordered_json face(const PageFace& chosen) const {
        return {{"target", chosen.target},
                {"why", chosen.why},
                {"neutral", packed_grid(own_.neutral.grid, inside_, frame_, geometry::Transform::Identity())},
                {"expressions", ordered_json::array()}};
    }

private:
    [[nodiscard]] static Vector way_mm(const geometry::DisplacementField& field, std::uint32_t v) {
        return field.answered.empty() || field.answered[v] != 0 ? field.mm[v] : Vector(Vector::Zero());
    }

    /// What the rows say of a motion, and the distance of every scored vertex.
    [[nodiscard]] ordered_json judged(const geometry::DisplacementField& field) const {
        const auto& surface = prepared_.surface();
        auto moved = surface.vertices_mm;
        geometry::VertexMask counts(moved.size(), 0);
        for (const auto v : scored_.vertices) {
            counts[v] = 1;
            moved[v] += way_mm(field, v);
        }
        const auto found = evaluation::distances_to_surface(moved, *scored_.expressive, counts);
        std::vector<std::int16_t> steps;
        for (const auto v : inside_) steps.push_back(in_page_steps(found.distance_mm[v]));
        return {{"error_mm", evaluation::distances_to_real_scan({scored_, surface, field}).zone_mm},
                {"distance", packed_steps(steps)}};
    }

    const ExperimentPlan& plan_;
    const Cast& cast_;
    std::size_t t_;
    modeling::Performance own_;
    animation::PreparedTarget prepared_;
    geometry::Transform aligned_;
    geometry::VertexMask zone_;
    evaluation::ScoredTarget scored_;
    std::vector<std::uint32_t> inside_;
    PageFrame frame_;
};

/// What one expression gives one face.
struct Piece {
    ordered_json face, expression;  ///< null: the target does not show it, or it failed
    std::vector<std::string> remarks;
};

Piece piece_of(const evaluation::PerformanceReader& reader, const ExperimentPlan& plan, const Cast& cast,
               const PageFace& chosen) {
    Piece piece;
    const auto found = std::find_if(cast.participants.begin(), cast.participants.end(),
                                    [&](const auto& id) { return id.subject == chosen.target; });
    if (found == cast.participants.end()) return piece;
    const auto remark = [&](const std::string& method, const char* what) {
        piece.remarks.push_back(
            fmt::format("{} on {}{}: not on the page: {}", cast.expression.code(), chosen.target, method, what));
    };
    try {
        const ExpressionOnFace on(reader, plan, cast, static_cast<std::size_t>(found - cast.participants.begin()));
        piece.expression = on.begun(reader.workspace().average());
        piece.face = on.face(chosen);
        for (std::size_t m = 0; m < plan.methods.size(); ++m) try {
                if (auto shape = on.shape(m); !shape.is_null()) piece.expression["shapes"].push_back(std::move(shape));
            } catch (const std::exception& e) {
                remark(" by " + plan.methods[m]->name(), e.what());
            }
    } catch (const std::exception& e) {
        remark("", e.what());
        piece.expression = piece.face = ordered_json();
    }
    return piece;
}

}  // namespace

namespace {

/// The subjects that take part in a case, as the run itself finds them out.
std::set<std::string> usable_subjects(const evaluation::PerformanceReader& reader, const ExperimentPlan& plan) {
    std::vector<char> usable(plan.subjects.size(), 0);
    base::parallel_for_each(usable.size(), [&](std::size_t s) {
        try {
            (void)reader.check_neutral(plan.subjects[s]);
            usable[s] = 1;
        } catch (const std::exception&) {  // told by the run itself
        }
    });
    std::set<std::string> names;
    for (std::size_t s = 0; s < usable.size(); ++s)
        if (usable[s] != 0) names.insert(plan.subjects[s]);
    return names;
}

}  // namespace

std::string page_faces(const evaluation::PerformanceReader& reader, const facs::FacsCatalogue& catalogue,
                       const ExperimentPlan& plan, const PageChoice& choice, const PageFacesOptions& options,
                       std::vector<std::string>& remarks) {
    auto shown = plan;
    std::erase_if(shown.methods, [&](const auto& method) {
        return std::find(choice.methods.begin(), choice.methods.end(), method->name()) == choice.methods.end();
    });
    std::vector<ordered_json> faces(choice.faces.size());
    std::vector<std::size_t> bytes(choice.faces.size(), 0);
    if (choice.faces.empty() && options.most_faces > 0)
        remarks.emplace_back(
            "no face is on the page: no method has errors at magnitude 1 to rank targets by; add 1 to the magnitudes");
    std::set<std::string> usable;
    if (!choice.faces.empty()) usable = usable_subjects(reader, plan);
    for (const auto& planned : plan.expressions) {
        if (choice.faces.empty()) break;
        auto performances = planned.performances;
        std::erase_if(performances, [&](const auto& id) { return !usable.contains(id.subject); });
        evaluation::FailureList told;  // by the run itself
        const animation::LearningTask task{planned.expression, reader.workspace().average(), catalogue,
                                           reader.workspace().registrations()};
        const auto cast = evaluation::gather_cast(reader, task, performances, shown.methods, told, plan.zones);
        std::vector<Piece> pieces(choice.faces.size());
        base::parallel_for_each(pieces.size(),
                                [&](std::size_t f) { pieces[f] = piece_of(reader, shown, cast, choice.faces[f]); });
        for (std::size_t f = 0; f < pieces.size(); ++f) {
            remarks.insert(remarks.end(), pieces[f].remarks.begin(), pieces[f].remarks.end());
            if (pieces[f].expression.is_null()) continue;
            if (faces[f].is_null()) faces[f] = std::move(pieces[f].face);
            bytes[f] += pieces[f].expression.dump().size();
            faces[f]["expressions"].push_back(std::move(pieces[f].expression));
        }
    }
    auto kept = ordered_json::array();
    std::size_t total = 0;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (faces[f].is_null()) continue;
        if (!kept.empty() && total + bytes[f] > options.most_bytes) {
            remarks.push_back(
                fmt::format("{}: its face would make the page too large; 'mimik report OUT --target {}' "
                            "makes a page of it",
                            choice.faces[f].target, choice.faces[f].target));
            continue;
        }
        total += bytes[f];
        kept.push_back(std::move(faces[f]));
    }
    return ordered_json{{"schema", 1},
                        {"step_mm", page_step_mm},
                        {"no_value", page_no_value},
                        {"methods", choice.methods},
                        {"faces", kept}}
        .dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace mimik::report
