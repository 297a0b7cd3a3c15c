#include "report/comparison_panels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "animation/model_method.h"
#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "evaluation/active_zone.h"
#include "evaluation/estimator.h"
#include "evaluation/performance.h"
#include "evaluation/surface_distance.h"
#include "geometry/landmark_spline.h"
#include "geometry/statistics.h"
#include "io/landmark_io.h"
#include "io/mesh_io.h"
#include "modeling/source_expression.h"
#include "report/drawn_face.h"
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

/// `name,x,y,z,kind` of the points of some kinds: muscle and wrinkle points as the thesis shows them (Figs 5-8, 5-9);
/// those that lie on no muscle in files of their own. @return whether there was any.
bool write_controls(const fs::path& file, const std::vector<ShownControl>& controls,
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
    void add_controls(PanelDescription& panel, const std::vector<ShownControl>& controls,
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

/// What makes another picture of the same people by the same method, each in a word:
/// "_r2logr_no-anchors_left_holes-gap".
std::string variant_suffix(const ComparisonRequest& request) {
    const auto method = animation::method_by_name(request.method_name);
    const auto* sparse = dynamic_cast<const animation::ModelMethod*>(method.get());
    auto suffix = modeling::variant_suffix(request.model, sparse ? sparse->model_options() : modeling::ModelOptions{});
    if (request.view != ComparisonRequest{}.view) suffix += "_" + request.view;
    if (request.holes != ComparisonRequest{}.holes) suffix += fmt::format("_holes-{}", to_string(request.holes));
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
std::set<std::string> coincident_landmarks(const std::vector<ShownPerson>& people) {
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
void add_person(FigureFolder& folder, const ShownPerson& person, const geometry::Landmarks& landmarks,
                const ComparisonRequest& request, double scale_mm, bool synthetic) {
    const auto stem = [&](const char* what) { return person.role + "_" + what; };
    const Point centre_mm = middle_of(person.neutral);

    std::vector<std::uint32_t> kept, kept_animated;
    Mesh neutral = drawn_surface(person.neutral.grid, request.holes, geometry::Transform::Identity(), &kept);
    Mesh animated = drawn_animation(person.animated, person.neutral, request.holes, &kept_animated);
    if (person.scored) {
        neutral.attributes.push_back(distance_attribute(*person.scored, person.neutral.grid.vertices_mm, kept));
        auto& distance = animated.attributes.emplace_back(
            distance_attribute(*person.scored, moved_vertices(person.neutral.grid, person.animated), kept_animated));
        // The dark inside of a mouth, which follows the kept vertices, has no distance.
        distance.values.resize(animated.vertices_mm.size(), std::numeric_limits<double>::quiet_NaN());
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

    io::write_mesh(folder.file(stem("real.ply")),
                   drawn_surface(person.real->grid, request.holes, person.real->neutral_from_scan));
    auto& third = folder.add_panel(stem("real.ply"),
                                   (synthetic ? "Synthetic scan of the " : "Scan of the ") + person.role, centre_mm);
    folder.add_controls(third, person.real_controls, stem("real_controls"));

    const auto coloured = [&](const char* mesh, const std::string& words, double mean_mm) {
        auto caption =
            fmt::format("{} to {}\nmean {:.2f} mm in the zone", words, synthetic ? "synthetic scan" : "scan", mean_mm);
        // A picture must not show a failure without a word.
        if (mean_mm > person.compared.zone_nothing_mm) caption += ":\nworse than doing nothing";
        auto& panel = folder.add_panel(stem(mesh), caption, centre_mm);
        panel.scalar = {.attribute = "distance_mm", .label = "distance, mm", .range = std::array{0.0, scale_mm}};
    };
    coloured("animated.ply", "Animated", person.compared.zone_mm);
    coloured("neutral.ply", "Neutral", person.compared.zone_nothing_mm);
}

}  // namespace

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

ComparisonFigure write_comparison_panels(const Workspace& workspace, const FacsCatalogue& catalogue,
                                         const ComparisonRequest& request, const fs::path& folder) {
    auto compared = compare_people(workspace, catalogue, request);
    const auto& people = compared.people;
    ComparisonFigure figure;
    figure.scale_mm = compared.scale_mm;
    figure.remarks = std::move(compared.remarks);
    figure.failures = std::move(compared.failures);
    for (const auto& person : people)
        if (person.scored) figure.people.push_back(person.compared);
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
    const Point centre_mm = middle_of(neutral);
    FigureFolder out(folder, request);
    std::vector<std::string> words;
    for (const auto& expression : expressions) {
        const auto model =
            modeling::model_from_workspace(workspace, catalogue, expression, source_of(request), request.model);
        words.push_back(expression_words(catalogue, expression));
        add_left_out(figure.remarks, model);
        add_unusable(figure.failures, model);
        for (const double magnitude : magnitudes) {
            const auto animated = animated_face(target, model, request, magnitude);
            add_remarks(figure.remarks, animated.remarks);
            const auto name = series_mesh(model.expression, magnitude);
            io::write_mesh(out.file(name), drawn_animation(animated, neutral, request.holes));
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
