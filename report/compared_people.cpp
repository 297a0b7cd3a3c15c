#include "report/compared_people.h"

#include <algorithm>

#include <fmt/format.h>

#include "animation/model_method.h"
#include "base/errors.h"
#include "base/text.h"
#include "evaluation/active_zone.h"
#include "evaluation/estimator.h"
#include "evaluation/performance.h"
#include "evaluation/surface_distance.h"
#include "geometry/statistics.h"

namespace mimik::report {

using animation::AnimatedFace;
using animation::PreparedTarget;
using facs::FacsCatalogue;
using geometry::Point;
using modeling::ExpressionModel;
using preprocessing::Face;
using preprocessing::Workspace;

AnimatedFace animated_face(const PreparedTarget& target, const ExpressionModel& model, const ComparisonRequest& request,
                           double magnitude) {
    const animation::WeightedExpression weighted{&model, magnitude};
    return animation::animate(target, std::span(&weighted, 1), request.animation);
}

animation::MethodPointer field_method(const ComparisonRequest& request) {
    auto method = animation::method_by_name(request.method_name);
    return dynamic_cast<const animation::ModelMethod*>(method.get()) ? nullptr : method;
}

modeling::ExpressionSource source_of(const ComparisonRequest& request) { return {request.source, {request.target}}; }

std::vector<Point> moved_vertices(const geometry::QuadGrid& grid, const AnimatedFace& animated) {
    auto moved = grid.vertices_mm;
    for (std::size_t v = 0; v < moved.size(); ++v) moved[v] += animated.field.mm[v];
    return moved;
}

geometry::VertexAttribute distance_attribute(const evaluation::ScoredTarget& scored,
                                             const std::vector<Point>& vertices_mm,
                                             const std::vector<std::uint32_t>& kept) {
    std::vector<std::uint8_t> counts(vertices_mm.size(), 0);
    for (const auto v : scored.vertices) counts[v] = vertices_mm[v].allFinite() ? 1 : 0;
    const auto distances = evaluation::distances_to_surface(vertices_mm, *scored.expressive, counts);
    geometry::VertexAttribute attribute{"distance_mm", 1, {}};
    for (const auto v : kept) attribute.values.push_back(distances.distance_mm[v]);
    return attribute;
}

void add_remarks(std::vector<std::string>& remarks, const std::vector<std::string>& more) {
    for (const auto& remark : more)
        if (std::find(remarks.begin(), remarks.end(), remark) == remarks.end()) remarks.push_back(remark);
}

void add_left_out(std::vector<std::string>& remarks, const ExpressionModel& model) {
    std::vector<std::string> more;
    for (const auto& reason : model.left_out) more.push_back(fmt::format("{}: {}", model.expression.name(), reason));
    add_remarks(remarks, more);
}

void add_unusable(std::vector<std::string>& failures, const ExpressionModel& model) {
    for (const auto& scan : model.unusable_scans)
        failures.push_back(fmt::format("{}: left out of the mean: {}", model.expression.name(), scan));
}

std::optional<double> ComparedPerson::explained() const {
    return zone_nothing_mm > 0 ? std::optional(1 - zone_mm / zone_nothing_mm) : std::nullopt;
}

namespace {

/// @throws InputError if the method does not learn from such a source.
void check_method(const ComparisonRequest& request) {
    const auto needs = animation::method_by_name(request.method_name)->needs();
    if (needs == animation::SourceKind::all_but_target && request.source != "mean")
        throw InputError(fmt::format("method '{}' learns from everybody but the target, source is '{}'; give mean",
                                     request.method_name, request.source));
    if (field_method(request) && needs == animation::SourceKind::one_source && request.source == "mean")
        throw InputError(fmt::format("method '{}' learns from one source; name a subject", request.method_name));
}

/// What such a method makes of the source's expression.
class LearnedMotion {
public:
    LearnedMotion(const Workspace& workspace, const FacsCatalogue& catalogue, const ComparisonRequest& request,
                  const animation::Method& method)
        : reader_(workspace), magnitude_(request.magnitude) {
        const auto learner =
            method.learner({request.expression, workspace.average(), catalogue, workspace.registrations()});
        std::vector<animation::LessonPointer> lessons;
        if (method.needs() != animation::SourceKind::none)
            for (const auto& scan :
                 modeling::source_scans(workspace, request.expression, {request.source, {request.target}}))
                lessons.push_back(learner->study(reader_.read(scan)));
        transfer_ = learner->learn(lessons);
    }
    [[nodiscard]] AnimatedFace on(const ShownPerson& person) const {
        std::optional<modeling::Performance> own;  // with its truth
        if (person.real) own = reader_.read(person.real->id);
        const PreparedTarget target(person.neutral, own && own->true_neutral ? &*own->true_neutral : nullptr);
        AnimatedFace animated;
        animated.field = animation::field_on(*transfer_, target);
        animated.lip_sides = transfer_->lip_sides(target);
        for (auto& displacement : animated.field.mm) displacement *= magnitude_;
        animated.extent = geometry::field_extent(target.surface(), animated.field.mm);
        return animated;
    }

private:
    evaluation::PerformanceReader reader_;
    double magnitude_;
    std::unique_ptr<const animation::Transfer> transfer_;
};

/// The average face as somebody who can be animated.
Face average_person(const Workspace& workspace) {
    const auto& average = workspace.average();
    Face face;
    face.grid = average.grid;
    face.landmarks = face.snapped_landmarks = average.landmarks;
    return face;
}

/// The real scan's distances, of the person as animated and of doing nothing.
void compare(ShownPerson& person, const Workspace& workspace, const evaluation::ActiveZone& zone) {
    if (!person.real) return;
    const auto neutral = geometry::face_surface(person.neutral.grid, person.neutral.landmarks);
    person.scored = evaluation::scored_target(neutral, person.real->grid, person.real->neutral_from_scan,
                                              evaluation::carry_zone(zone, workspace.average(), person.neutral));
    const auto refuse = [&](const char* what) {
        throw InputError(fmt::format("{} does not lie on {}{}; 'mimik preprocess --sheets' shows how it was aligned",
                                     person.real->id.name(), person.neutral.id.name(), what));
    };
    if (person.scored->vertices.empty()) refuse(": nothing of the neutral face sees it");
    if (person.scored->zone_size() == 0) refuse(" where the expression is: nothing of its zone sees it");
    const auto still = geometry::DisplacementField::still(neutral.size());
    const auto animated = evaluation::distances_to_real_scan({*person.scored, neutral, person.animated.field});
    const auto nothing = evaluation::distances_to_real_scan({*person.scored, neutral, still});
    const auto measured =
        std::count_if(neutral.measured.begin(), neutral.measured.end(), [](auto seen) { return seen != 0; });
    person.compared = {person.neutral.id.subject, animated.zone_mm,
                       nothing.zone_mm,           animated.face_mm,
                       nothing.face_mm,           static_cast<std::size_t>(measured) - person.scored->vertices.size()};
}

ShownPerson person_with_scan(const char* role, const Workspace& workspace, const std::string& subject,
                             const database::ScanId& scan) {
    ShownPerson person(role);
    person.neutral = workspace.face(workspace.neutral(subject));
    person.real = workspace.face(scan);
    return person;
}

/// The source with its own scan, and what the model says of it.
ShownPerson source_person(const Workspace& workspace, const FacsCatalogue& catalogue, const ComparisonRequest& request,
                          const database::ScanId& scan, ExpressionModel& model, std::vector<std::string>& remarks) {
    auto source = person_with_scan("source", workspace, request.source, scan);
    std::vector<modeling::FollowedPoint> followed;
    model = modeling::measure_expression(catalogue, request.expression, workspace.average(), source.neutral,
                                         *source.real, request.model, &followed, workspace.registrations());
    for (const auto& point : followed) {
        source.controls.push_back({point.name, point.kind, point.neutral_mm});
        source.real_controls.push_back({point.name, point.kind, source.real->neutral_from_scan * point.expressive_mm});
    }
    if (!base::equal_ignoring_case(scan.code, request.expression.code()))
        remarks.push_back(fmt::format("{} was taken from one side of {}", request.expression.code(), scan.name()));
    return source;
}

/// The average face in the place of a source.
ShownPerson average_in_place_of_source(const Workspace& workspace, const FacsCatalogue& catalogue,
                                       const ComparisonRequest& request, ExpressionModel& model,
                                       ComparedPeople& compared) {
    model = modeling::model_from_workspace(workspace, catalogue, request.expression, source_of(request), request.model);
    add_unusable(compared.failures, model);
    ShownPerson average("average");
    average.neutral = average_person(workspace);
    for (const auto& point : model.points) average.controls.push_back({point.name, point.kind, point.position_mm});
    return average;
}

ShownPerson target_person(const Workspace& workspace, const ComparisonRequest& request,
                          const std::optional<database::ScanId>& scan, std::vector<std::string>& remarks) {
    ShownPerson target("target");
    target.neutral = workspace.face(workspace.neutral(request.target));
    if (scan)
        target.real = workspace.face(*scan);
    else
        remarks.push_back(
            fmt::format("subject '{}' has no scan of expression '{}', so there is nothing to compare with",
                        request.target, request.expression.code()));
    return target;
}

}  // namespace

ComparedScans compared_scans(const Workspace& workspace, const FacsCatalogue& catalogue,
                             const ComparisonRequest& request) {
    workspace.refuse_hidden(request.target);
    check_method(request);
    modeling::check_source(workspace, source_of(request), request.model);
    (void)workspace.neutral(request.target);
    (void)catalogue.units(request.expression);
    ComparedScans scans;
    const auto sources = modeling::source_scans(workspace, request.expression, source_of(request));
    if (request.source != "mean") scans.source = sources.front();
    scans.target = workspace.scan_of(request.target, request.expression);
    return scans;
}

ComparedPeople compare_people(const Workspace& workspace, const FacsCatalogue& catalogue,
                              const ComparisonRequest& request) {
    const auto scans = compared_scans(workspace, catalogue, request);
    ComparedPeople compared;
    const auto zone = evaluation::shipped_active_zone(request.expression, workspace.average());

    auto& people = compared.people;
    ExpressionModel model;
    std::optional<LearnedMotion> motion;
    if (const auto method = field_method(request)) {
        motion.emplace(workspace, catalogue, request, *method);
        if (scans.source) people.push_back(person_with_scan("source", workspace, request.source, *scans.source));
    } else if (scans.source) {
        people.push_back(source_person(workspace, catalogue, request, *scans.source, model, compared.remarks));
    } else {
        people.push_back(average_in_place_of_source(workspace, catalogue, request, model, compared));
    }
    if (request.target != request.source)
        people.push_back(target_person(workspace, request, scans.target, compared.remarks));

    for (auto& person : people) {
        person.animated = motion ? motion->on(person)
                                 : animated_face(PreparedTarget(person.neutral), model, request, request.magnitude);
        if (person.role == "target")
            for (const auto& point : person.animated.points)
                person.controls.push_back({point.name, point.kind, point.position_mm});
        add_remarks(compared.remarks, person.animated.remarks);
        compare(person, workspace, zone);
        if (person.scored)
            compared.scale_mm = std::max(compared.scale_mm, geometry::quantile(person.scored->nothing_mm, 0.99));
    }
    add_left_out(compared.remarks, model);
    return compared;
}

}  // namespace mimik::report
