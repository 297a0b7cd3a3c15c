#include "modeling/expression_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "facs/expression_zone.h"
#include "facs/face_regions.h"
#include "geometry/face_axes.h"
#include "geometry/landmark_spline.h"
#include "geometry/point_index.h"
#include "geometry/surface_index.h"
#include "io/json_values.h"
#include "io/landmark_io.h"
#include "modeling/template_motion_json.h"
#include "preprocessing/kept_registrations.h"

namespace mimik::modeling {

using geometry::Landmarks;
using geometry::Point;
using geometry::Vector;
using preprocessing::AverageFace;
using preprocessing::Face;

const geometry::Transform& average_from_scan(const Face& face, Normalisation normalisation) {
    return normalisation == Normalisation::affine ? face.average_from_scan_affine : face.average_from_scan;
}

ModelOptions ModelOptions::sparse() {
    ModelOptions options;
    options.correspondence = Correspondence::sparse;
    return options;
}

ModelOptions ModelOptions::thesis() {
    auto options = sparse();
    options.normalisation = Normalisation::affine;
    options.kernel = geometry::SplineKernel::r2_log_r2;
    options.smoothing = 0.0;
    options.anchors = false;
    options.coverage_points = false;
    options.snap_to_vertices = true;
    options.place_on_average = false;
    return options;
}

void ModelOptions::check() const {
    if (!(smoothing >= 0))
        throw InputError(fmt::format("smoothing is {}; give 0 (pass through every landmark) or more", smoothing));
    if (spread_points < 0) throw InputError(fmt::format("spread_points is {}; give 0 (none) or more", spread_points));
    if (spread_points > 0 && (correspondence != Correspondence::dense || !place_on_average))
        throw InputError(
            "spread_points move as a template does, so they need the correspondence 'dense' and "
            "place_on_average");
    if (correspondence == Correspondence::dense && normalisation == Normalisation::affine)
        throw InputError("a dense model needs the frame 'similarity'; give that, or the correspondence 'sparse'");
}

double ExpressionModel::largest_displacement_mm() const {
    double largest = 0;
    for (const auto& point : points) largest = std::max(largest, point.displacement_mm.norm());
    return largest;
}

namespace {

/// A face's surface in the average frame, asked for nearest points one way or the other.
class NormalisedSurface {
public:
    NormalisedSurface(const geometry::QuadGrid& grid, const geometry::Transform& average_from_scan,
                      geometry::BridgedVertices bridged) {
        for (std::size_t v = 0; v < grid.size(); ++v) {
            vertices_.push_back(grid.inside(v) ? Point(average_from_scan * grid.vertices_mm[v]) : Point(Point::Zero()));
            if (grid.inside(v)) inside_.push_back(vertices_.back());
        }
        triangles_ = geometry::triangles(grid, bridged);
    }
    [[nodiscard]] Point nearest(const Point& query, bool vertex) {
        if (!vertex) return surface().closest(query).position_mm;
        if (!index_) index_.emplace(inside_);
        return inside_[index_->nearest(query).index];
    }
    [[nodiscard]] const geometry::SurfaceIndex& surface() {
        if (!surface_) surface_.emplace(vertices_, triangles_);
        return *surface_;
    }

private:
    std::vector<Point> vertices_, inside_;
    std::vector<geometry::Triangle> triangles_;
    std::optional<geometry::SurfaceIndex> surface_;  // the one that is asked for is made: each costs milliseconds
    std::optional<geometry::PointIndex> index_;
};

PlacedKinds placed_kinds(const ModelOptions& options) {
    return {.coverage = options.coverage_points, .anchors = options.anchors};
}

/// Wrinkle points are placed in any case: where they stand there is no coverage point.
bool wanted(facs::ControlKind kind, const ModelOptions& options) {
    return kind != facs::ControlKind::wrinkle || options.wrinkle_points;
}

/// Whether a unit of one half of the face has a zone centred in the other: a cheek raiser, upper face by FACS, moves
/// the cheek below the border.
bool crosses_border(const facs::SidedUnit& sided, const Landmarks& landmarks) {
    const facs::RegionBorder border(landmarks);
    return std::any_of(sided.unit->zone.begin(), sided.unit->zone.end(), [&](const auto& ellipse) {
        const double above_mm = border.above_mm(facs::place(ellipse.centre, landmarks, facs::Side::left));
        return sided.unit->lower_face ? above_mm > 0 : above_mm < 0;
    });
}

}  // namespace

ExpressionGauge::ExpressionGauge(const facs::FacsCatalogue& catalogue, const facs::Expression& expression,
                                 const AverageFace& average, const ModelOptions& options,
                                 std::shared_ptr<const preprocessing::KeptRegistrations> registrations)
    : catalogue_(catalogue), average_(average), expression_(expression), options_(options) {
    options_.check();
    const auto units = catalogue.units(expression);
    begun_.expression = expression;
    if (units.empty() && !options_.coverage_points)
        throw InputError(fmt::format(
            "expression '{}' has no muscle points, since it is a word that the catalogue lacks, and the thesis "
            "method has no others; take the default method, or name its units in a catalogue of your own",
            expression.code()));
    begun_.moves_upper_face = begun_.moves_lower_face = units.empty();
    for (const auto& sided : units) (sided.unit->lower_face ? begun_.moves_lower_face : begun_.moves_upper_face) = true;
    // Where anchors hold the rest of the face, nothing is cut off at the border that the unit does move.
    if (options_.anchors)
        for (const auto& sided : units)
            if (crosses_border(sided, average.landmarks)) begun_.moves_upper_face = begun_.moves_lower_face = true;
    begun_.normalisation = options_.normalisation;
    if (options_.correspondence == Correspondence::dense) {
        registrations_ = registrations ? std::move(registrations)
                                       : std::make_shared<const preprocessing::KeptRegistrations>(average);
        (void)registrations_->registration();  // an average face without a mouth is found out now
    }
    if (!options_.place_on_average) return;
    const geometry::SurfaceIndex surface(average.grid.vertices_mm, geometry::triangles(average.grid));
    on_average_ = place(average.landmarks, surface);
    if (options_.spread_points > 0) spread_over_zone();
}

ExpressionGauge::Placed ExpressionGauge::place(const Landmarks& landmarks,
                                               const geometry::SurfaceIndex& surface) const {
    const auto others = [&](auto&& wanted_unit) {
        std::vector<facs::UnitOnSide> units;
        for (const auto& unit : catalogue_.action_units())
            if (wanted_unit(unit)) units.push_back({unit.number, facs::Side::both, false});
        return units;
    };
    Placed placed;
    if (options_.other_points == OtherPoints::followed) {
        auto units = others([&](const facs::ActionUnit& unit) {
            return unit.lower_face ? begun_.moves_lower_face : begun_.moves_upper_face;
        });
        static_cast<PlacedControls&>(placed) = place_controls(catalogue_, facs::Expression::of_units(std::move(units)),
                                                              landmarks, surface, placed_kinds(options_));
        return placed;
    }
    static_cast<PlacedControls&>(placed) =
        place_controls(catalogue_, expression_, landmarks, surface, placed_kinds(options_));
    if (options_.other_points == OtherPoints::none) return placed;
    // A point that stands where one of the expression's own does would hold that still, too.
    const double apart_mm = catalogue_.sampling().min_separation * geometry::outer_eye_distance_mm(landmarks);
    const auto all = facs::Expression::of_units(others([](const auto&) { return true; }));
    for (auto& control :
         place_controls(catalogue_, all, landmarks, surface, {.coverage = false, .anchors = false}).controls) {
        const bool near = std::any_of(placed.controls.begin(), placed.controls.end(), [&](const ControlPoint& own) {
            return (own.position_mm - control.position_mm).norm() < apart_mm;
        });
        if (near || !wanted(control.kind, options_)) continue;
        control.name = "still " + control.name;
        control.kind = facs::ControlKind::anchor;
        placed.still.push_back(std::move(control));
    }
    return placed;
}

/// The farthest vertex from all that were chosen comes next, with its mirror image where that lies in the zone, too.
void ExpressionGauge::spread_over_zone() {
    const auto& face_template = registrations_->face_template();
    const auto& vertices = face_template.surface.vertices_mm;
    const facs::ExpressionZone zone(catalogue_, expression_, average_.landmarks);
    std::vector<double> off_mm(vertices.size(), -1.0);  // from the nearest chosen one; -1: not in the zone, or chosen
    Point middle = Point::Zero();
    std::size_t inside = 0;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        if (zone.distance(vertices[v]) > 0) continue;
        off_mm[v] = std::numeric_limits<double>::max();
        middle += vertices[v];
        ++inside;
    }
    const auto wanted_points = std::min(inside, static_cast<std::size_t>(options_.spread_points));
    const auto choose = [&](std::uint32_t chosen) {
        spread_.push_back(chosen);
        for (std::size_t v = 0; v < vertices.size(); ++v)
            if (off_mm[v] >= 0) off_mm[v] = std::min(off_mm[v], (vertices[v] - vertices[chosen]).norm());
        off_mm[chosen] = -1;
    };
    const auto next = [&] {
        if (!spread_.empty())
            return static_cast<std::uint32_t>(std::max_element(off_mm.begin(), off_mm.end()) - off_mm.begin());
        middle /= static_cast<double>(inside);
        std::uint32_t nearest = 0;
        double least = std::numeric_limits<double>::max();
        for (std::uint32_t v = 0; v < vertices.size(); ++v)
            if (const double d = (vertices[v] - middle).norm(); off_mm[v] >= 0 && d < least) {
                least = d;
                nearest = v;
            }
        return nearest;
    };
    while (spread_.size() < wanted_points) {
        const auto chosen = next();
        const double off = off_mm[chosen];
        choose(chosen);
        const auto mirrored = face_template.mirror[chosen];
        // Near the mid-line the two would stand closer together than the others.
        constexpr double least_share = 0.7;
        if (spread_.size() < wanted_points && off_mm[mirrored] >= least_share * off) choose(mirrored);
    }
}

void ExpressionGauge::keep_spread_points(ExpressionModel& model) const {
    const auto& vertices = registrations_->face_template().surface.vertices_mm;
    std::erase_if(model.points, [](const ModelPoint& point) { return point.kind != facs::ControlKind::anchor; });
    for (const auto v : spread_)
        model.points.push_back(
            {fmt::format("spread_{}", v), facs::ControlKind::coverage, vertices[v], model.dense->motion_mm[v], 0.0});
    model.dense.reset();
}

struct NormalisedSource::Parts {
    std::string neutral, expressive;  // their scans' names
    geometry::Transform to_average, to_average_too;
    Landmarks neutral_marks, expressive_marks;
    NormalisedSurface neutral_surface, expressive_surface;
};

NormalisedSource::NormalisedSource(const Face& neutral, const Face& expressive, const ModelOptions& options) {
    const auto& to_average = average_from_scan(neutral, options.normalisation);
    const auto& to_average_too = average_from_scan(expressive, options.normalisation);
    const auto marks = [&](const Face& face) {
        return options.snap_to_vertices ? face.snapped_landmarks : face.landmarks;
    };
    parts_.reset(new Parts{neutral.id.name(), expressive.id.name(), to_average, to_average_too,
                           geometry::transformed(marks(neutral), to_average),
                           geometry::transformed(marks(expressive), to_average_too),
                           NormalisedSurface(neutral.grid, to_average, geometry::BridgedVertices::keep),
                           NormalisedSurface(expressive.grid, to_average_too, geometry::BridgedVertices::keep)});
}

NormalisedSource::~NormalisedSource() = default;
NormalisedSource::NormalisedSource(NormalisedSource&&) noexcept = default;

ExpressionModel ExpressionGauge::measure(const Face& neutral, const Face& expressive,
                                         std::vector<FollowedPoint>* followed) const {
    NormalisedSource source(neutral, expressive, options_);
    auto model = measure(source, followed);
    if (registrations_) {
        // Spread points are carried by splines, which know no skin.
        if (options_.spread_points > 0)
            model.dense = {registrations_, registrations_->motion(neutral, expressive).motion_mm};
        else
            model.dense = motion_on_template(registrations_, neutral, expressive);
        if (expressive.id.side() == facs::Side::both) keep_side(*model.dense, expression_);
        if (options_.spread_points > 0) keep_spread_points(model);
    }
    return model;
}

ExpressionModel ExpressionGauge::measure(NormalisedSource& source, std::vector<FollowedPoint>* followed) const {
    const auto& options = options_;
    const geometry::ThinPlateSplineOptions spline{.kernel = options.kernel, .smoothing = options.smoothing};
    auto& [neutral_name, expressive_name, to_average, to_average_too, neutral_marks, expressive_marks, neutral_surface,
           expressive_surface] = *source.parts_;
    ExpressionModel model = begun_;
    model.sources = {neutral_name, expressive_name};

    // Where the points stand on the model's own face, and where on this source's neutral face.
    Placed placed;
    std::vector<Point> controls_on_source, anchors_on_source;
    if (options.place_on_average) {
        placed = on_average_;
        model.landmarks = average_.landmarks;
        const auto source_from_average = geometry::landmark_spline(average_.landmarks, neutral_marks, spline);
        for (const auto& control : placed.controls)
            controls_on_source.push_back(
                neutral_surface.nearest(source_from_average(control.position_mm), options.snap_to_vertices));
        for (const auto& anchor : placed.anchors)
            anchors_on_source.push_back(
                neutral_surface.nearest(source_from_average(anchor.position_mm), options.snap_to_vertices));
    } else {
        placed = place(neutral_marks, neutral_surface.surface());
        model.landmarks = neutral_marks;
        for (auto& control : placed.controls) {
            control.position_mm = neutral_surface.nearest(control.position_mm, options.snap_to_vertices);
            controls_on_source.push_back(control.position_mm);
        }
        for (const auto& anchor : placed.anchors) anchors_on_source.push_back(anchor.position_mm);
    }
    // Eq. 5.8 needs the mouth of a source that moves the lower face; one that moves the upper does without.
    const bool mouth = model.landmarks.find("mouth_corner_left") && model.landmarks.find("mouth_corner_right");
    model.mouth_width_mm =
        geometry::mouth_width_mm(mouth || model.moves_lower_face ? model.landmarks : average_.landmarks);
    model.left_out = placed.left_out;

    geometry::LandmarkPairs pairs(neutral_marks, expressive_marks);
    for (const auto& merged : pairs.merged())
        model.left_out.push_back(fmt::format("{}: landmark {}", neutral_name, merged));
    for (const auto& name : pairs.only_in_from())
        model.left_out.push_back(fmt::format("{}: landmark '{}' is not on {}", neutral_name, name, expressive_name));
    for (const auto& name : pairs.only_in_to())
        model.left_out.push_back(fmt::format("{}: landmark '{}' is not on {}", expressive_name, name, neutral_name));
    for (std::size_t k = 0; options.anchors_in_both_maps && k < placed.anchors.size(); ++k)
        pairs.add(placed.anchors[k].name, anchors_on_source[k], anchors_on_source[k]);
    const auto expressive_from_neutral = pairs.fit(spline);

    // Exactly so many: an experiment holds the models of all its sources.
    const auto taken = std::count_if(placed.controls.begin(), placed.controls.end(),
                                     [&](const ControlPoint& control) { return wanted(control.kind, options); });
    model.points.reserve(static_cast<std::size_t>(taken) + placed.anchors.size() + placed.still.size());
    for (std::size_t k = 0; k < placed.controls.size(); ++k) {
        const auto& control = placed.controls[k];
        if (!wanted(control.kind, options)) continue;
        const Point carried = expressive_from_neutral(controls_on_source[k]);
        const Point found = expressive_surface.nearest(carried, options.snap_to_vertices);
        model.points.push_back(
            {control.name, control.kind, control.position_mm, found - controls_on_source[k], (found - carried).norm()});
        if (followed)
            followed->push_back({control.name, control.kind, to_average.inverse() * controls_on_source[k],
                                 to_average_too.inverse() * found});
    }
    for (const auto* held : {&placed.anchors, &placed.still})
        for (const auto& anchor : *held)
            model.points.push_back({anchor.name, facs::ControlKind::anchor, anchor.position_mm, Vector::Zero(), 0.0});
    return model;
}

ExpressionModel measure_expression(const facs::FacsCatalogue& catalogue, const facs::Expression& expression,
                                   const AverageFace& average, const Face& neutral, const Face& expressive,
                                   const ModelOptions& options, std::vector<FollowedPoint>* followed,
                                   std::shared_ptr<const preprocessing::KeptRegistrations> registrations) {
    return ExpressionGauge(catalogue, expression, average, options, std::move(registrations))
        .measure(neutral, expressive, followed);
}

void ExpressionMean::add(const ExpressionModel& model) {
    if (!sum_) {
        sum_ = model;
        models_ = 1;
        for (std::size_t k = 0; k < model.points.size(); ++k) place_[model.points[k].name] = k;
        count_.assign(model.points.size(), 1.0);
        return;
    }
    auto& sum = *sum_;
    if (model.expression != sum.expression || model.normalisation != sum.normalisation)
        throw InputError(
            fmt::format("{} and {} do not go together in a mean", sum.expression.name(), model.expression.name()));
    for (const auto& mark : sum.landmarks.all())
        if (const auto* other = model.landmarks.find(mark.name);
            !other || (other->position_mm - mark.position_mm).norm() > 1e-9)
            throw InputError(
                fmt::format("{}: models of {} and {} stand on different faces; model them on the average face",
                            sum.expression.name(), sum.sources.front(), model.sources.front()));
    if (sum.dense.has_value() != model.dense.has_value() ||
        (sum.dense && (sum.dense->motion_mm.size() != model.dense->motion_mm.size() ||
                       sum.dense->follows_skin != model.dense->follows_skin)))
        throw InputError(fmt::format("{}: models of {} and {} stand on different templates; model them anew",
                                     sum.expression.name(), sum.sources.front(), model.sources.front()));
    if (sum.dense)
        for (std::size_t v = 0; v < sum.dense->motion_mm.size(); ++v)
            sum.dense->motion_mm[v] += model.dense->motion_mm[v];
    ++models_;
    sum.sources.insert(sum.sources.end(), model.sources.begin(), model.sources.end());
    for (const auto& reason : model.left_out)
        if (std::find(sum.left_out.begin(), sum.left_out.end(), reason) == sum.left_out.end())
            sum.left_out.push_back(reason);
    for (const auto& point : model.points) {
        const auto found = place_.find(point.name);
        if (found == place_.end()) {
            place_[point.name] = sum.points.size();
            sum.points.push_back(point);
            count_.push_back(1.0);
            continue;
        }
        auto& total = sum.points[found->second];
        total.displacement_mm += point.displacement_mm;
        total.projection_mm += point.projection_mm;
        count_[found->second] += 1.0;
    }
}

ExpressionModel ExpressionMean::mean() const {
    if (!sum_) throw InputError("a mean expression needs at least one model");
    ExpressionModel mean = *sum_;
    for (std::size_t k = 0; k < mean.points.size(); ++k) {
        mean.points[k].displacement_mm /= count_[k];
        mean.points[k].projection_mm /= count_[k];
    }
    if (mean.dense)
        for (auto& motion : mean.dense->motion_mm) motion /= static_cast<double>(models_);
    return mean;
}

std::string variant_suffix(const ModelOptions& options, const ModelOptions& usual) {
    std::string suffix;
    for (const auto& [name, value, usual_value, is_switch] : base::field_differences(options, usual)) {
        // Another kernel than the usual one passes through every landmark: its name says so much.
        if (name == "smoothing" && options.kernel != usual.kernel && options.smoothing == 0) continue;
        auto words = name;
        std::replace(words.begin(), words.end(), '_', '-');
        if (is_switch)
            suffix += (value == "on" ? "_" : "_no-") + words;
        else
            // "frame" is what model files have always called the normalisation.
            suffix += "_" + (name == "kernel" || name == "frame" ? value : words + "-" + value);
    }
    return suffix;
}

namespace {

constexpr const char* model_file_kind = "mimik expression model";

nlohmann::json provenance_to_json(const ModelProvenance& provenance) {
    nlohmann::json json = io::fields_to_json(provenance.options);
    json["mimik"] = provenance.mimik_version;
    json["method"] = provenance.method;
    json["catalogue"] = {{"name", provenance.catalogue}, {"hash", provenance.catalogue_hash}};
    json["average_face"] = provenance.average_face;
    return json;
}

ModelProvenance provenance_from_json(const nlohmann::json& json) {
    using io::read_field;
    ModelProvenance provenance;
    // Older files know sparse models alone, and none of the steps between the thesis and the default.
    auto options = json;
    const auto of_old = io::fields_to_json(ModelOptions::sparse());
    for (const char* name : {"correspondence", "anchors_in_both_maps", "other_points", "spread_points"})
        if (!options.contains(name)) options[name] = of_old[name];
    provenance.mimik_version = read_field<std::string>(json, "mimik");
    provenance.method = read_field<std::string>(json, "method");
    io::read_fields(options, provenance.options);
    read_field(json, "catalogue", [&](const nlohmann::json& catalogue) {
        provenance.catalogue = read_field<std::string>(catalogue, "name");
        provenance.catalogue_hash = read_field<std::string>(catalogue, "hash");
        return 0;
    });
    provenance.average_face = read_field<std::string>(json, "average_face");
    return provenance;
}

}  // namespace

std::vector<std::string> differences(const ModelProvenance& stored, const ModelProvenance& here) {
    std::vector<std::string> found;
    for (auto& [name, stored_value, here_value, is_switch] : base::field_differences(stored.options, here.options)) {
        std::replace(name.begin(), name.end(), '_', ' ');
        found.push_back(fmt::format("{} {}, here {}", name, stored_value, here_value));
    }
    if (stored.catalogue_hash != here.catalogue_hash)
        found.push_back(fmt::format("catalogue {} ({}), here {} ({})", stored.catalogue, stored.catalogue_hash,
                                    here.catalogue, here.catalogue_hash));
    if (stored.average_face != here.average_face)
        found.push_back(fmt::format("average face {}, here {}", stored.average_face, here.average_face));
    return found;
}

void check_expression_model(const ExpressionModel& model) {
    if (model.points.empty()) throw InputError("there is no point in it; make the model again with 'mimik model'");
    if (!(std::isfinite(model.mouth_width_mm) && model.mouth_width_mm > 0))
        throw InputError(fmt::format("mouth_width_mm is {}; it must be above 0", model.mouth_width_mm));
    for (const auto& mark : model.landmarks.all())
        if (!mark.position_mm.allFinite())
            throw InputError(fmt::format("landmark '{}' is at no finite position", mark.name));
    std::set<std::string_view> names;
    for (const auto& point : model.points) {
        if (!names.insert(point.name).second)
            throw InputError(fmt::format("point '{}' stands in it twice; leave one out", point.name));
        if (!point.position_mm.allFinite() || !point.displacement_mm.allFinite())
            throw InputError(fmt::format("position or displacement of point '{}' is not finite", point.name));
    }
}

std::string encode_expression_model(const ExpressionModel& model) {
    using io::to_json;
    auto points = nlohmann::json::array();
    for (const auto& point : model.points)
        points.push_back({{"name", point.name},
                          {"kind", to_string(point.kind)},
                          {"position_mm", to_json(point.position_mm)},
                          {"displacement_mm", to_json(point.displacement_mm)},
                          {"projection_mm", point.projection_mm}});
    nlohmann::json document = {{"schema", 1},
                               {"kind", model_file_kind},
                               {"expression", model.expression.name()},
                               {"moves_upper_face", model.moves_upper_face},
                               {"moves_lower_face", model.moves_lower_face},
                               {"frame", to_string(model.normalisation)},
                               {"units", "mm"},
                               {"sources", model.sources},
                               {"mouth_width_mm", model.mouth_width_mm},
                               {"landmarks", to_json(model.landmarks)},
                               {"points", points},
                               {"left_out", model.left_out},
                               {"unusable_scans", model.unusable_scans}};
    if (model.dense) document["dense"] = template_motion_to_json(*model.dense);
    if (model.provenance) document["provenance"] = provenance_to_json(*model.provenance);
    return io::json_text(document);
}

void write_expression_model(const std::filesystem::path& file, const ExpressionModel& model) {
    base::write_atomically(file, encode_expression_model(model));
}

ExpressionModel decode_expression_model(std::string_view text, const std::string& name) {
    using io::read_field;
    constexpr const char* mend = "make the model again with 'mimik model'";
    return io::read_json_document(text, name, mend, [&](const nlohmann::json& document) {
        ExpressionModel model;
        if (!document.contains("kind"))
            throw InputError(name + ": is no expression model; give a file of 'mimik model'");
        if (const auto kind = read_field<std::string>(document, "kind"); kind != model_file_kind)
            throw InputError(fmt::format("it is {}, not '{}'; give a file of 'mimik model'", base::in_quotes(kind),
                                         model_file_kind));
        model.expression = read_field(document, "expression", [](const nlohmann::json& value) {
            const auto word = value.get<std::string>();
            const auto expression = facs::parse_expression(word);
            if (!expression || expression->neutral())
                throw InputError(fmt::format("{} is no expression such as AU12", base::in_quotes(word)));
            return *expression;
        });
        model.moves_upper_face = read_field<bool>(document, "moves_upper_face");
        model.moves_lower_face = read_field<bool>(document, "moves_lower_face");
        model.normalisation = read_field(document, "frame", io::enum_from_json<Normalisation>);
        model.sources = read_field<std::vector<std::string>>(document, "sources");
        model.mouth_width_mm = read_field<double>(document, "mouth_width_mm");
        model.landmarks = io::landmarks_from_json(document, "landmarks");
        io::read_list(document, "points", [&](const nlohmann::json& point) {
            if (model.points.size() == io::most_landmarks)  // a spline goes through them, too
                throw InputError(fmt::format("more than the {} points that are read", io::most_landmarks));
            model.points.push_back({read_field<std::string>(point, "name"),
                                    facs::parse_control_kind(read_field<std::string>(point, "kind")),
                                    read_field(point, "position_mm", io::vector_from_json),
                                    read_field(point, "displacement_mm", io::vector_from_json),
                                    read_field<double>(point, "projection_mm")});
        });
        model.left_out = read_field<std::vector<std::string>>(document, "left_out");
        // Older files have neither.
        if (document.contains("unusable_scans"))
            model.unusable_scans = read_field<std::vector<std::string>>(document, "unusable_scans");
        if (document.contains("dense")) model.dense = read_field(document, "dense", template_motion_from_json);
        if (document.contains("provenance"))
            model.provenance = read_field(document, "provenance", provenance_from_json);
        check_expression_model(model);
        return model;
    });
}

ExpressionModel read_expression_model(const std::filesystem::path& file) {
    return decode_expression_model(base::read_text(file, io::most_json_bytes), file.string());
}

}  // namespace mimik::modeling
