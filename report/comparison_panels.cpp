#include "report/comparison_panels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "animation/face_export.h"
#include "animation/model_method.h"
#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "evaluation/active_zone.h"
#include "evaluation/estimator.h"
#include "evaluation/performance.h"
#include "evaluation/surface_distance.h"
#include "geometry/box.h"
#include "geometry/landmark_spline.h"
#include "geometry/statistics.h"
#include "io/landmark_io.h"
#include "io/mesh_io.h"
#include "modeling/source_expression.h"
#include "report/figure_description.h"

namespace mimik::report {

using animation::AnimatedFace;
using animation::PreparedTarget;
using facs::ControlKind;
using facs::FacsCatalogue;
using geometry::Mesh;
using geometry::Point;
using modeling::ExpressionModel;
using preprocessing::Face;
using preprocessing::Workspace;
namespace fs = std::filesystem;

namespace {

constexpr const char* description_file = "figure.json";
constexpr int panel_width_px = 320, panel_height_px = 400;

struct NamedControl {
    std::string name;
    ControlKind kind;
    Point position_mm;
};

/// One row of the figure.
struct Person {
    explicit Person(std::string part) : role(std::move(part)) {}
    std::string role;  ///< "source", "target", "average"
    Face neutral;
    AnimatedFace animated;
    std::vector<NamedControl> controls;       ///< on the neutral face
    std::vector<NamedControl> real_controls;  ///< on the real scan, frame of the neutral one
    std::optional<Face> real;
    std::optional<evaluation::ScoredTarget> scored;
    ComparedPerson compared;
};

AnimatedFace animated_face(const PreparedTarget& target, const ExpressionModel& model, const ComparisonRequest& request,
                           double magnitude) {
    const animation::WeightedExpression weighted{&model, magnitude};
    return animation::animate(target, std::span(&weighted, 1), request.animation);
}

/// A method that is no model of control points. Null: the request's own options make the motion.
animation::MethodPointer field_method(const ComparisonRequest& request) {
    auto method = animation::method_by_name(request.method_name);
    return dynamic_cast<const animation::ModelMethod*>(method.get()) ? nullptr : method;
}

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
    [[nodiscard]] AnimatedFace on(const Person& person) const {
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

std::vector<Point> moved_vertices(const geometry::QuadGrid& grid, const AnimatedFace& animated) {
    auto moved = grid.vertices_mm;
    for (std::size_t v = 0; v < moved.size(); ++v) moved[v] += animated.field.mm[v];
    return moved;
}

/// Hidden subjects are no sources anyway.
modeling::ExpressionSource source_of(const ComparisonRequest& request) { return {request.source, {request.target}}; }

/// The average face as somebody who can be animated.
Face average_person(const Workspace& workspace) {
    const auto& average = workspace.average();
    Face face;
    face.grid = average.grid;
    face.landmarks = face.snapped_landmarks = average.landmarks;
    return face;
}

/// Middle of what is drawn of a neutral face: where all panels of that person look.
Point centre_of(const geometry::QuadGrid& grid, geometry::BridgedVertices bridged) {
    return geometry::box_of(geometry::to_mesh(grid, bridged).vertices_mm).center();
}

/// `name,x,y,z,kind` of the points of some kinds: muscle and wrinkle points as the thesis shows them (Figs 5-8, 5-9);
/// those that lie on no muscle in files of their own. @return whether there was any.
bool write_controls(const fs::path& file, const std::vector<NamedControl>& controls,
                    std::initializer_list<ControlKind> kinds) {
    std::string text = "name,x,y,z,kind\n";
    bool any = false;
    for (const auto& control : controls) {
        if (std::find(kinds.begin(), kinds.end(), control.kind) == kinds.end()) continue;
        any = true;
        text += fmt::format("{},{:.17g},{:.17g},{:.17g},{}\n", base::csv_field(control.name), control.position_mm.x(),
                            control.position_mm.y(), control.position_mm.z(), facs::to_string(control.kind));
    }
    if (any) base::write_atomically(file, text);
    return any;
}

/// Distances per vertex of a mesh made from a grid: NaN, drawn in grey, where no distance can be had.
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

/// A figure being made: the files of its panels lie beside its description.
class FigureFolder {
public:
    FigureFolder(fs::path folder, const ComparisonRequest& request)
        : folder_(std::move(folder)), view_(figures::parse_view(request.view)) {
        remove_earlier();
    }

    [[nodiscard]] fs::path file(const std::string& name) const { return folder_ / name; }
    /// A panel that shows `mesh` with its middle at `centre_mm`.
    PanelDescription& add_panel(const std::string& mesh, const std::string& caption, const Point& centre_mm) {
        const auto place = letter(description_.panels.size());
        auto& panel = description_.panels.emplace_back();
        panel.mesh = file(mesh);
        panel.caption = fmt::format("({}) {}", place, caption);
        panel.view = view_;
        panel.centre_mm = centre_mm;
        return panel;
    }
    void add_controls(PanelDescription& panel, const std::vector<NamedControl>& controls,
                      const std::string& stem) const {
        if (write_controls(file(stem + ".csv"), controls, {ControlKind::muscle, ControlKind::wrinkle}))
            panel.controls = file(stem + ".csv");
        const auto carried = file(stem + "_carried.csv");
        if (write_controls(carried, controls, {ControlKind::carried}))
            panel.markers.push_back({carried, "carried controls", {0xb0, 0x70, 0xc0}, 1.6});
        // Smaller and paler than the catalogue's own points: there are many, and they only fill the zone.
        const auto coverage = file(stem + "_coverage.csv");
        if (write_controls(coverage, controls, {ControlKind::coverage}))
            panel.markers.push_back({coverage, "coverage controls", {0x8c, 0x8c, 0x8c}, 1.2});
    }
    /// @return the file's path
    fs::path finish(const std::string& title, int columns, double scale_bar_mm) {
        auto& page = description_.page;
        page.title = title;
        page.columns = columns;
        page.panel_width_px = panel_width_px;
        page.panel_height_px = panel_height_px;
        page.font_size_px = 17;
        page.scale_bar_mm = scale_bar_mm;
        page.legend = true;
        write_figure_description(file(description_file), description_);
        return file(description_file);
    }
    [[nodiscard]] std::size_t panels() const { return description_.panels.size(); }

private:
    /// a ... z, aa, ab, ...
    static std::string letter(std::size_t k) {
        const std::string last(1, static_cast<char>('a' + k % 26));
        return k < 26 ? last : letter(k / 26 - 1) + last;
    }
    /// Files of an earlier figure there: only what its description names, and what lies in the folder itself.
    void remove_earlier() const {
        std::error_code ignored;
        if (!fs::is_regular_file(file(description_file), ignored)) return;
        const auto remove = [&](const fs::path& named) {
            if (!named.empty() && named.parent_path() == folder_) fs::remove(named, ignored);
        };
        try {
            for (const auto& panel : read_figure_description(file(description_file)).panels) {
                for (const auto& named : {panel.mesh, panel.landmarks, panel.controls}) remove(named);
                for (const auto& marker : panel.markers) remove(marker.file);
            }
        } catch (const std::exception&) {
            return;  // somebody else's: what it names is not known
        }
        fs::remove(file(description_file), ignored);
    }

    fs::path folder_;
    figures::View view_;
    FigureDescription description_;
};

/// What makes another picture of the same people by the same method, each in a word: "_r2logr_no-anchors_left_bridged".
std::string variant_suffix(const ComparisonRequest& request) {
    const auto method = animation::method_by_name(request.method_name);
    const auto* sparse = dynamic_cast<const animation::ModelMethod*>(method.get());
    auto suffix = modeling::variant_suffix(request.model, sparse ? sparse->model_options() : modeling::ModelOptions{});
    if (request.view != ComparisonRequest{}.view) suffix += "_" + request.view;
    if (request.bridged == geometry::BridgedVertices::keep) suffix += "_bridged";
    return suffix;
}

/// Mesh of a series; a magnitude that reads the same has the same file.
std::string series_mesh(const facs::Expression& expression, double magnitude) {
    return fmt::format("{}_m{:g}.ply", expression.name(), magnitude);
}

std::string expression_words(const FacsCatalogue& catalogue, const facs::Expression& expression) {
    const auto units = catalogue.units(expression);
    auto words = expression.name();
    if (units.size() == 1 && words.starts_with("AU")) words += " " + units.front().unit->name;
    return words;
}

std::string source_words(const ComparisonRequest& request) {
    return request.source == "mean" ? "the mean of the others" : request.source;
}

/// Faces that nobody has are called so in every picture.
std::string synthetic_words(const Workspace& workspace) {
    return workspace.made_with_truth() ? " (synthetic faces)" : "";
}

std::string magnitude_words(double magnitude) {
    return magnitude == 1.0 ? std::string() : fmt::format(", m = {:g}", magnitude);
}

/// Landmarks that lie on an earlier one on either person (closed lips): a spline through both has no answer, so
/// nobody's file has them, and the files of two people go into 'mimik warp' as they are.
std::set<std::string> coincident_landmarks(const std::vector<Person>& people) {
    std::set<std::string> names;
    for (const auto& person : people) {
        std::vector<Point> kept_mm;
        for (const auto& mark : person.neutral.landmarks.all()) {
            if (names.contains(mark.name)) continue;
            const bool lies_on_one = std::any_of(kept_mm.begin(), kept_mm.end(), [&](const Point& p) {
                return (p - mark.position_mm).norm() < geometry::LandmarkPairs::coincident_mm;
            });
            if (lies_on_one)
                names.insert(mark.name);
            else
                kept_mm.push_back(mark.position_mm);
        }
    }
    return names;
}

geometry::Landmarks without(const geometry::Landmarks& landmarks, const std::set<std::string>& names) {
    std::vector<geometry::Landmark> marks(landmarks.all().begin(), landmarks.all().end());
    std::erase_if(marks, [&](const auto& mark) { return names.contains(mark.name); });
    return geometry::Landmarks(std::move(marks));
}

/// Panels of one person, in the order of the thesis, then the coloured ones.
void add_person(FigureFolder& folder, const Person& person, const geometry::Landmarks& landmarks,
                const ComparisonRequest& request, double scale_mm, bool synthetic) {
    const auto stem = [&](const char* what) { return person.role + "_" + what; };
    const Point centre_mm = centre_of(person.neutral.grid, request.bridged);

    std::vector<std::uint32_t> kept, kept_animated;
    Mesh neutral = geometry::to_mesh(person.neutral.grid, request.bridged, &kept);
    Mesh animated = animation::to_mesh(person.animated, person.neutral, {.bridged = request.bridged}, &kept_animated);
    if (person.scored) {
        neutral.attributes.push_back(distance_attribute(*person.scored, person.neutral.grid.vertices_mm, kept));
        animated.attributes.push_back(
            distance_attribute(*person.scored, moved_vertices(person.neutral.grid, person.animated), kept_animated));
    }
    io::write_mesh(folder.file(stem("neutral.ply")), neutral);
    io::write_mesh(folder.file(stem("animated.ply")), animated);
    io::write_landmarks(folder.file(stem("landmarks.csv")), landmarks);

    const auto who =
        person.role == "average" ? std::string("average face") : person.role + " " + person.neutral.id.subject;
    auto& first =
        folder.add_panel(stem("neutral.ply"), (person.role == "average" ? "The " : "Neutral ") + who, centre_mm);
    first.landmarks = folder.file(stem("landmarks.csv"));
    folder.add_controls(first, person.controls, stem("controls"));
    folder.add_panel(stem("animated.ply"), "Animated " + who, centre_mm);
    if (!person.real) return;

    auto real = person.real->grid;
    for (auto& p : real.vertices_mm) p = person.real->neutral_from_scan * p;
    io::write_mesh(folder.file(stem("real.ply")), geometry::to_mesh(real, request.bridged));
    auto& third = folder.add_panel(
        stem("real.ply"), (synthetic ? "Synthetic scan of the " : "Real scan of the ") + person.role, centre_mm);
    folder.add_controls(third, person.real_controls, stem("real_controls"));

    const auto coloured = [&](const char* mesh, const std::string& words, double mean_mm) {
        auto caption =
            fmt::format("{} to {} scan\nmean {:.2f} mm in the zone", words, synthetic ? "synthetic" : "real", mean_mm);
        // A picture must not show a failure without a word.
        if (mean_mm > person.compared.zone_nothing_mm) caption += ":\nworse than doing nothing";
        auto& panel = folder.add_panel(stem(mesh), caption, centre_mm);
        panel.scalar = {.attribute = "distance_mm", .label = "distance, mm", .range = std::array{0.0, scale_mm}};
    };
    coloured("animated.ply", "Animated", person.compared.zone_mm);
    coloured("neutral.ply", "Neutral", person.compared.zone_nothing_mm);
}

/// The real scan's distances, of the person as animated and of doing nothing.
void compare(Person& person, const Workspace& workspace, const evaluation::ActiveZone& zone) {
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
    person.compared = {person.neutral.id.subject,
                       animated.zone_mm,
                       nothing.zone_mm,
                       animated.face_mm.value_or(0),
                       nothing.face_mm.value_or(0),
                       static_cast<std::size_t>(measured) - person.scored->vertices.size()};
}

void add_remarks(std::vector<std::string>& remarks, const std::vector<std::string>& more) {
    for (const auto& remark : more)
        if (std::find(remarks.begin(), remarks.end(), remark) == remarks.end()) remarks.push_back(remark);
}

void add_left_out(ComparisonFigure& figure, const ExpressionModel& model) {
    std::vector<std::string> remarks;
    for (const auto& reason : model.left_out) remarks.push_back(fmt::format("{}: {}", model.expression.name(), reason));
    add_remarks(figure.remarks, remarks);
}

void add_unusable(ComparisonFigure& figure, const ExpressionModel& model) {
    for (const auto& scan : model.unusable_scans)
        figure.failures.push_back(fmt::format("{}: left out of the mean: {}", model.expression.name(), scan));
}

}  // namespace

std::optional<double> ComparedPerson::explained() const {
    return zone_nothing_mm > 0 ? std::optional(1 - zone_mm / zone_nothing_mm) : std::nullopt;
}

std::string comparison_name(const ComparisonRequest& request) {
    const double m = request.magnitude;
    return fmt::format("{}_{}{}_on_{}_{}{}", request.expression.name(),
                       m == 1.0 ? std::string() : fmt::format("m{:g}_", m), request.source, request.target,
                       request.method_name, variant_suffix(request));
}

std::string series_name(const ComparisonRequest& request, std::span<const facs::Expression> expressions) {
    std::vector<std::string> names;
    for (const auto& expression : expressions) names.push_back(expression.name());
    return fmt::format("{}_series_{}_on_{}_{}{}", fmt::join(names, "_"), request.source, request.target,
                       request.method_name, variant_suffix(request));
}

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

namespace {

Person person_with_scan(const char* role, const Workspace& workspace, const std::string& subject,
                        const database::ScanId& scan) {
    Person person(role);
    person.neutral = workspace.face(workspace.neutral(subject));
    person.real = workspace.face(scan);
    return person;
}

/// The source with its own scan, and what the model says of it.
Person source_person(const Workspace& workspace, const FacsCatalogue& catalogue, const ComparisonRequest& request,
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
Person average_in_place_of_source(const Workspace& workspace, const FacsCatalogue& catalogue,
                                  const ComparisonRequest& request, ExpressionModel& model, ComparisonFigure& figure) {
    model = modeling::model_from_workspace(workspace, catalogue, request.expression, source_of(request), request.model);
    add_unusable(figure, model);
    Person average("average");
    average.neutral = average_person(workspace);
    for (const auto& point : model.points) average.controls.push_back({point.name, point.kind, point.position_mm});
    return average;
}

Person target_person(const Workspace& workspace, const ComparisonRequest& request,
                     const std::optional<database::ScanId>& scan, std::vector<std::string>& remarks) {
    Person target("target");
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

ComparisonFigure write_comparison_panels(const Workspace& workspace, const FacsCatalogue& catalogue,
                                         const ComparisonRequest& request, const fs::path& folder) {
    const auto scans = compared_scans(workspace, catalogue, request);
    ComparisonFigure figure;
    const auto zone = evaluation::shipped_active_zone(request.expression, workspace.average());

    std::vector<Person> people;
    ExpressionModel model;
    std::optional<LearnedMotion> motion;
    if (const auto method = field_method(request)) {
        motion.emplace(workspace, catalogue, request, *method);
        if (scans.source) people.push_back(person_with_scan("source", workspace, request.source, *scans.source));
    } else if (scans.source) {
        people.push_back(source_person(workspace, catalogue, request, *scans.source, model, figure.remarks));
    } else {
        people.push_back(average_in_place_of_source(workspace, catalogue, request, model, figure));
    }
    if (request.target != request.source)
        people.push_back(target_person(workspace, request, scans.target, figure.remarks));

    for (auto& person : people) {
        person.animated = motion ? motion->on(person)
                                 : animated_face(PreparedTarget(person.neutral), model, request, request.magnitude);
        if (person.role == "target")
            for (const auto& point : person.animated.points)
                person.controls.push_back({point.name, point.kind, point.position_mm});
        add_remarks(figure.remarks, person.animated.remarks);
        compare(person, workspace, zone);
        if (!person.scored) continue;
        figure.scale_mm = std::max(figure.scale_mm, geometry::quantile(person.scored->nothing_mm, 0.99));
        figure.people.push_back(person.compared);
    }
    add_left_out(figure, model);

    FigureFolder out(folder, request);
    const auto coincident = coincident_landmarks(people);
    for (const auto& person : people)
        add_person(out, person, without(person.neutral.landmarks, coincident), request, figure.scale_mm,
                   workspace.made_with_truth());
    for (const auto& person : figure.people)
        if (person.zone_mm > person.zone_nothing_mm)
            figure.remarks.push_back(fmt::format("{} on {}: worse than doing nothing ({:.2f} mm, {:.2f} mm)",
                                                 request.expression.name(), person.subject, person.zone_mm,
                                                 person.zone_nothing_mm));
    figure.panels = out.panels();
    // A row per person where both have a real scan; else what there is, without gaps.
    const bool rows = people.size() == 1 || (people.front().real && people.back().real);
    const int columns = rows ? 5 : static_cast<int>(figure.panels + 1) / 2;
    figure.description =
        out.finish(fmt::format("{}: {} on {}, {} method{}{}", expression_words(catalogue, request.expression),
                               source_words(request), request.target, request.method_name,
                               magnitude_words(request.magnitude), synthetic_words(workspace)),
                   columns, 50);
    return figure;
}

void check_series(const Workspace& workspace, const FacsCatalogue& catalogue, const ComparisonRequest& request,
                  std::span<const facs::Expression> expressions, std::span<const double> magnitudes) {
    if (field_method(request))
        throw InputError(fmt::format("method '{}' has no control points; a series takes thesis, default or the like",
                                     request.method_name));
    if (expressions.empty() || magnitudes.empty())
        throw InputError(fmt::format("a series of {} at {}; give one or more of each",
                                     base::counted(expressions.size(), "expression"),
                                     base::counted(magnitudes.size(), "magnitude")));
    auto each = request;
    std::set<std::string> meshes;
    for (const auto& expression : expressions) {
        for (const double magnitude : magnitudes) {
            if (!std::isfinite(magnitude) || magnitude < 0)
                throw InputError(
                    fmt::format("magnitude {} of the series: give numbers of 0 (neutral) or more", magnitude));
            if (!meshes.insert(series_mesh(expression, magnitude)).second)
                throw InputError(
                    fmt::format("expression '{}' at magnitude {} stands twice in the series, or as near "
                                "as makes no difference; give each once",
                                expression.code(), magnitude));
        }
        each.expression = expression;
        (void)compared_scans(workspace, catalogue, each);
    }
}

ComparisonFigure write_magnitude_series(const Workspace& workspace, const FacsCatalogue& catalogue,
                                        const ComparisonRequest& request, std::span<const facs::Expression> expressions,
                                        std::span<const double> magnitudes, const fs::path& folder) {
    check_series(workspace, catalogue, request, expressions, magnitudes);
    ComparisonFigure figure;
    const auto neutral = workspace.face(workspace.neutral(request.target));
    const PreparedTarget target(neutral);
    const Point centre_mm = centre_of(neutral.grid, request.bridged);
    FigureFolder out(folder, request);
    std::vector<std::string> words;
    for (const auto& expression : expressions) {
        const auto model =
            modeling::model_from_workspace(workspace, catalogue, expression, source_of(request), request.model);
        words.push_back(expression_words(catalogue, expression));
        add_left_out(figure, model);
        add_unusable(figure, model);
        for (const double magnitude : magnitudes) {
            const auto animated = animated_face(target, model, request, magnitude);
            add_remarks(figure.remarks, animated.remarks);
            const auto name = series_mesh(model.expression, magnitude);
            io::write_mesh(out.file(name), animation::to_mesh(animated, neutral, {.bridged = request.bridged}));
            out.add_panel(name, fmt::format("{}, m = {:g}", model.expression.name(), magnitude), centre_mm);
        }
    }
    figure.panels = out.panels();
    figure.description =
        out.finish(fmt::format("{} by magnitude: {} on {}, {} method{}", fmt::join(words, "; "), source_words(request),
                               request.target, request.method_name, synthetic_words(workspace)),
                   static_cast<int>(magnitudes.size()), 50);
    return figure;
}

}  // namespace mimik::report
