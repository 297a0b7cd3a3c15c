#include "builtin/builtin_expressions.h"

#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "builtin/template_on_mesh.h"
#include "geometry/face_surface.h"
#include "preprocessing/kept_registrations.h"
#include "preprocessing/normalisation.h"
#include "preprocessing/preprocess_scan.h"
#include "synthesis/face_model.h"
#include "synthesis/posed_expression.h"
#include "synthesis/subject.h"

namespace mimik::builtin {

using geometry::Point;
using geometry::Vector;

void BuiltinExpressionOptions::check() const {
    if (people < 2 || people > 100) throw InputError(fmt::format("people is {}; give 2 to 100", people));
}

namespace {

/// People differ, but each does exactly what is asked for.
synthesis::VarianceOptions exact_performers() {
    synthesis::VarianceOptions options;
    options.amplitude_person = options.amplitude_performance = options.shape = 0;
    options.asymmetry_person = options.asymmetry_performance = 0;
    options.co_activation = options.co_activation_spread = 0;
    options.field_magnitude = options.field_direction_deg = 0;
    options.micro_expression = 0;
    return options;
}

struct Person {
    synthesis::Subject subject;
    preprocessing::Face neutral;  ///< head frame
};

}  // namespace

struct BuiltinExpressions::Parts {
    std::uint64_t seed = 1;
    std::unique_ptr<synthesis::FaceModel> face_model = synthesis::make_builtin_face_model();
    std::vector<Person> people;
    preprocessing::AverageFace average;
    std::shared_ptr<const preprocessing::KeptRegistrations> registrations;
    database::MaterialPoints of_template;  ///< on the skin, whose vertices are the same on all people

    /// What a scanner without noise and shadows would see. @param code  of the expression
    [[nodiscard]] preprocessing::Face scan(const synthesis::Subject& subject, const std::vector<Point>& vertices_mm,
                                           const std::string& code) const {
        database::LoadedScan loaded;
        loaded.entry.id = {subject.name, code == "N" ? "N" : "E", code, 0};
        loaded.scan.points_mm = vertices_mm;
        loaded.scan.faces = face_model->faces();
        loaded.landmarks = landmarks(vertices_mm);
        return preprocessing::preprocess_scan(loaded);
    }
    [[nodiscard]] geometry::Landmarks landmarks(const std::vector<Point>& vertices_mm) const {
        std::vector<geometry::Landmark> marks;
        for (const auto& [name, vertex] : face_model->landmark_vertices())
            marks.push_back({name, vertices_mm[vertex], {}});
        return geometry::Landmarks(std::move(marks));
    }
    void draw_people(int count);
    void build_average();
    void place_template();
    /// A motion of a person's skin on the template, average frame.
    [[nodiscard]] std::vector<Vector> on_template(const Person& person, std::span<const Vector> field_mm) const;
};

void BuiltinExpressions::Parts::draw_people(int count) {
    people.resize(static_cast<std::size_t>(count));
    base::parallel_for_each(people.size(), [&](std::size_t k) {
        auto& person = people[k];
        person.subject = synthesis::draw_subject(*face_model, fmt::format("builtin{:03}", k), seed, exact_performers());
        person.neutral = scan(person.subject, person.subject.resting_mm, "N");
    });
}

void BuiltinExpressions::Parts::build_average() {
    std::vector<geometry::Landmarks> sets;
    for (const auto& person : people) sets.push_back(person.neutral.landmarks);
    double rms_mm = 0;
    const auto consensus =
        preprocessing::consensus_landmarks(sets, preprocessing::AverageFaceOptions{}.max_iterations, &rms_mm);
    average = preprocessing::build_average_face(
        people.size(), [&](std::size_t k) { return people[k].neutral; }, consensus);
    average.consensus_rms_mm = rms_mm;
    registrations = std::make_shared<const preprocessing::KeptRegistrations>(average);
}

void BuiltinExpressions::Parts::place_template() {
    std::vector<Point> mean_mm(people.front().subject.resting_mm.size(), Point::Zero());
    for (auto& person : people) {
        auto& average_from_head = person.neutral.average_from_scan;
        average_from_head = preprocessing::similarity_normalisation(person.neutral.landmarks, average.landmarks);
        for (std::size_t v = 0; v < mean_mm.size(); ++v)
            mean_mm[v] += average_from_head * person.subject.resting_mm[v] / static_cast<double>(people.size());
    }
    auto marks = landmarks(mean_mm);
    of_template = template_on_mesh(
        registrations->registration(),
        geometry::face_surface({std::move(mean_mm), face_model->faces(), {}, {}, {}}, std::move(marks)));
}

std::vector<Vector> BuiltinExpressions::Parts::on_template(const Person& person,
                                                           std::span<const Vector> field_mm) const {
    std::vector<Vector> motion_mm;
    motion_mm.reserve(of_template.triangles.size());
    for (std::size_t v = 0; v < of_template.triangles.size(); ++v)
        motion_mm.emplace_back(person.neutral.average_from_scan.linear() * of_template.at(field_mm, v));
    return motion_mm;
}

BuiltinExpressions::BuiltinExpressions(const BuiltinExpressionOptions& options) : parts_(std::make_unique<Parts>()) {
    options.check();
    parts_->seed = options.seed;
    parts_->draw_people(options.people);
    parts_->build_average();
    parts_->place_template();
}
BuiltinExpressions::~BuiltinExpressions() = default;

const preprocessing::AverageFace& BuiltinExpressions::average() const { return parts_->average; }

bool BuiltinExpressions::shows(const facs::Expression& expression) const {
    try {
        return synthesis::missing_shapes(synthesis::make_expression(expression.code()), *parts_->face_model).empty();
    } catch (const InputError&) {
        return false;
    }
}

modeling::ExpressionModel BuiltinExpressions::model(const facs::FacsCatalogue& catalogue,
                                                    const facs::Expression& expression,
                                                    const modeling::ModelOptions& options) const {
    if (!options.place_on_average)
        throw InputError("place_on_average is false, but the built-in expressions are a mean; set it to true");
    const auto& parts = *parts_;
    synthesis::PosedExpression posed;
    try {
        const auto& emotions = catalogue.emotions();
        const bool known = !emotions.empty() && synthesis::is_emotion_set(emotions.front().set);
        posed = synthesis::make_expression(expression.code(), known ? emotions.front().set : facs::usual_emotion_set);
    } catch (const InputError& e) {
        throw InputError(
            fmt::format("the built-in faces do not show {}: {}; give a workspace", expression.name(), e.what()));
    }
    // The points of the catalogue are followed from surface to surface as on any scans, the skin by its own vertices.
    auto of_points = options;
    of_points.correspondence = modeling::Correspondence::sparse;
    const modeling::ExpressionGauge gauge(catalogue, expression, parts.average, of_points);
    struct Shown {
        modeling::ExpressionModel model;
        std::vector<Vector> motion_mm;
    };
    modeling::ExpressionMean points;
    modeling::TemplateMotion dense{parts.registrations, {}};
    dense.motion_mm.assign(dense.face_template().size(), Vector::Zero());
    const auto count = static_cast<double>(parts.people.size());
    base::in_batches(
        parts.people.size(),
        [&](std::size_t k) -> Shown {
            const auto& person = parts.people[k];
            const auto performed = synthesis::perform(person.subject, posed, person.subject.name + "_" + posed.code,
                                                      parts.seed, exact_performers());
            auto expressive = parts.scan(person.subject, performed.vertices_mm, posed.code);
            expressive.average_from_scan = person.neutral.average_from_scan;
            return {gauge.measure(person.neutral, expressive), parts.on_template(person, performed.displacement_mm)};
        },
        [&](const Shown& shown) {
            points.add(shown.model);
            for (std::size_t v = 0; v < dense.motion_mm.size(); ++v) dense.motion_mm[v] += shown.motion_mm[v] / count;
        });
    auto model = points.mean();
    model.sources.clear();  // nobody was scanned
    if (options.correspondence == modeling::Correspondence::dense) {
        model.dense = std::move(dense);
        model.left_out.clear();  // of points, which move nothing then
    }
    return model;
}

}  // namespace mimik::builtin
