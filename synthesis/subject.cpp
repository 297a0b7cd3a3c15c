#include "synthesis/subject.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/random_stream.h"
#include "synthesis/smooth_field.h"

namespace mimik::synthesis {
namespace {

using geometry::Point;
using geometry::Vector;

double landmark_distance(const FaceModel& model, const std::vector<Point>& face, const char* a, const char* b) {
    const auto& marks = model.landmark_vertices();
    return (face[marks.at(a)] - face[marks.at(b)]).norm();
}

/// Full strength is 1; nobody goes far past it, however the factors multiply.
constexpr double most_motion = 1.2;

/// As many deviations as a face can follow (VarianceOptions).
double clipped(double standard_normal) { return std::clamp(standard_normal, -2.0, 2.0); }
/// Median 1, `deviation` in natural logarithms (0.15 is close to 15 %).
double clipped_log_normal(base::RandomStream& random, double deviation) {
    return std::exp(deviation * clipped(random.normal()));
}

bool upper_face(const std::string& shape) { return shape.starts_with("brow") || shape.starts_with("eye"); }

void range(const char* field, double value, double low, double high) {
    if (!(value >= low && value <= high))
        throw InputError(fmt::format("{} is {}; give {} to {}", field, value, low, high));
}

/// Turns and stretches the displacements smoothly over the face: a change that no combination of shapes can make.
void distort(std::vector<Vector>& displacement, const std::vector<Point>& face, std::uint64_t seed,
             const VarianceOptions& options) {
    if (options.field_magnitude == 0 && options.field_direction_deg == 0) return;
    // A fixed box, larger than any head, so that the draws do not depend on the face.
    const SmoothField field(seed, 4, options.field_length_mm, Point::Constant(-300), Point::Constant(300));
    // Two of the three components of the turn change the direction: their root mean square is the option.
    const double turn = options.field_direction_deg * std::numbers::pi / 180.0 / std::numbers::sqrt2;
    for (std::size_t i = 0; i < displacement.size(); ++i) {
        if (displacement[i].squaredNorm() < 1e-12) continue;
        const auto value = field.at(face[i]);
        const Vector axis = turn * Vector(clipped(value[1]), clipped(value[2]), clipped(value[3]));
        const double angle = axis.norm();
        if (angle > 0) displacement[i] = Eigen::AngleAxisd(angle, axis / angle) * displacement[i];
        displacement[i] *= std::max(0.0, 1.0 + options.field_magnitude * clipped(value[0]));
    }
}

}  // namespace

void VarianceOptions::check() const {
    range("identity", identity, 0, 3);
    range("amplitude_person", amplitude_person, 0, 1);
    range("amplitude_performance", amplitude_performance, 0, 1);
    range("shape", shape, 0, 1);
    range("asymmetry_person", asymmetry_person, 0, 0.5);
    range("asymmetry_performance", asymmetry_performance, 0, 0.5);
    range("co_activation", co_activation, 0, 5);
    range("co_activation_spread", co_activation_spread, 0, 5);
    range("size_coupling", size_coupling, 0, 2);
    range("field_length_mm", field_length_mm, 5, 500);
    range("field_magnitude", field_magnitude, 0, 1);
    range("field_direction_deg", field_direction_deg, 0, 45);
    range("micro_expression", micro_expression, 0, 0.2);
}

Subject draw_subject(const FaceModel& model, const std::string& name, std::uint64_t seed,
                     const VarianceOptions& options) {
    options.check();
    Subject subject;
    subject.name = name;
    const Sex sex = base::RandomStream(seed, name + "/sex").uniform() < 0.5 ? Sex::female : Sex::male;
    subject.model = &model;
    subject.identity = model.draw_identity(base::stream_seed(seed, name + "/identity"), sex, options.identity);
    subject.resting_mm = model.neutral_mm(subject.identity);
    base::RandomStream person(seed, name + "/person");
    subject.amplitude = clipped_log_normal(person, options.amplitude_person);
    subject.asymmetry = options.asymmetry_person * clipped(person.normal());

    const auto mean = model.neutral_mm(model.draw_identity(0, sex, 0.0));
    const auto ratio = [&](const char* a, const char* b) {
        return landmark_distance(model, subject.resting_mm, a, b) / landmark_distance(model, mean, a, b);
    };
    subject.mouth_width_ratio = ratio("mouth_corner_left", "mouth_corner_right");
    subject.eye_distance_ratio = ratio("eye_outer_left", "eye_outer_right");

    subject.shapes = model.shapes();
    std::sort(subject.shapes.begin(), subject.shapes.end());
    subject.shape_displacements_mm = model.shape_displacements_mm(subject.identity, subject.shapes);
    return subject;
}

PosedFace perform(const Subject& subject, const PosedExpression& expression, const std::string& scan_name,
                  std::uint64_t seed, const VarianceOptions& options) {
    options.check();
    PosedFace result;
    base::RandomStream amplitude(seed, scan_name + "/amplitude");
    base::RandomStream asymmetry(seed, scan_name + "/asymmetry");
    result.amplitude = subject.amplitude * clipped_log_normal(amplitude, options.amplitude_performance);
    result.asymmetry = subject.asymmetry + options.asymmetry_performance * clipped(asymmetry.normal());

    const auto side_factor = [&](const std::string& shape) {
        return shape.ends_with("_L") ? 1.0 + result.asymmetry : shape.ends_with("_R") ? 1.0 - result.asymmetry : 1.0;
    };
    for (const auto& part : expression.main_shapes) {
        if (!std::binary_search(subject.shapes.begin(), subject.shapes.end(), part.shape))
            throw InputError(fmt::format("{}: the face model has no shape '{}'", scan_name, part.shape));
        base::RandomStream random(seed, fmt::format("{}/shape/{}", scan_name, part.shape));
        result.weights[part.shape] +=
            part.weight * result.amplitude * side_factor(part.shape) * clipped_log_normal(random, options.shape);
    }
    for (const auto& part : expression.co_activated) {
        if (!std::binary_search(subject.shapes.begin(), subject.shapes.end(), part.shape)) continue;
        // Both sides of a co-activated shape are driven together; the asymmetry makes the difference.
        std::string stem = part.shape;
        if (stem.ends_with("_L") || stem.ends_with("_R")) stem.resize(stem.size() - 2);
        base::RandomStream random(seed, fmt::format("{}/co/{}", scan_name, stem));
        const double drawn = options.co_activation * part.weight +
                             options.co_activation_spread * part.deviation * clipped(random.normal());
        result.weights[part.shape] += std::max(0.0, drawn) * result.amplitude * side_factor(part.shape);
    }

    const std::size_t vertices = subject.resting_mm.size();
    result.displacement_mm.assign(vertices, Vector::Zero());
    const auto displacements = [&](const std::string& shape) -> const std::vector<Vector>& {
        const auto at = std::lower_bound(subject.shapes.begin(), subject.shapes.end(), shape);
        return subject.shape_displacements_mm[static_cast<std::size_t>(at - subject.shapes.begin())];
    };
    for (const auto& [shape, weight] : result.weights) {
        const double ratio = upper_face(shape) ? subject.eye_distance_ratio : subject.mouth_width_ratio;
        const double scaled = std::min(most_motion, weight * (1.0 + options.size_coupling * (ratio - 1.0)));
        const auto& full = displacements(shape);
        for (std::size_t i = 0; i < vertices; ++i) result.displacement_mm[i] += scaled * full[i];
    }
    distort(result.displacement_mm, subject.resting_mm, base::stream_seed(seed, scan_name + "/field"), options);

    if (options.micro_expression > 0) {
        for (std::size_t s = 0; s < subject.shapes.size(); ++s) {
            base::RandomStream random(seed, fmt::format("{}/micro/{}", scan_name, subject.shapes[s]));
            const double weight = options.micro_expression * clipped(random.normal());
            for (std::size_t i = 0; i < vertices; ++i)
                result.displacement_mm[i] += weight * subject.shape_displacements_mm[s][i];
        }
    }
    // An eye asked to shut, as AU 43 does, ends shut however weakly the rest of the face goes along.
    constexpr double shut = 0.9;
    Contact contact;
    for (const auto& part : expression.main_shapes) {
        contact.left_eye_closed = contact.left_eye_closed || (part.shape == "eyeBlink_L" && part.weight >= shut);
        contact.right_eye_closed = contact.right_eye_closed || (part.shape == "eyeBlink_R" && part.weight >= shut);
    }
    subject.model->settle(subject.resting_mm, contact, result.displacement_mm);
    result.vertices_mm.resize(vertices);
    for (std::size_t i = 0; i < vertices; ++i)
        result.vertices_mm[i] = subject.resting_mm[i] + result.displacement_mm[i];
    return result;
}

}  // namespace mimik::synthesis
