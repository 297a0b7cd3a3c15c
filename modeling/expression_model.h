#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/fields.h"
#include "facs/facs_catalogue.h"
#include "geometry/landmarks.h"
#include "geometry/thin_plate_spline.h"
#include "modeling/control_points.h"
#include "modeling/template_motion.h"
#include "preprocessing/average_face.h"
#include "preprocessing/face.h"

namespace mimik::modeling {

/// Which normalisation a model's numbers are in.
enum class Normalisation {
    similarity,  ///< average face by a similarity of the neutral: the expression is kept (default)
    affine       ///< Eqs 5.1-5.4, each scan on its own (thesis)
};
[[nodiscard]] constexpr const char* to_string(Normalisation normalisation) {
    return normalisation == Normalisation::affine ? "affine" : "similarity";
}
[[nodiscard]] const geometry::Transform& average_from_scan(const preprocessing::Face& face,
                                                           Normalisation normalisation);

/// How a model says where the skin goes.
enum class Correspondence {
    sparse,  ///< control points alone; a spline between them (thesis)
    dense    ///< every vertex of a template that is bent on to the scans, beside the control points
};
[[nodiscard]] constexpr const char* to_string(Correspondence correspondence) {
    return correspondence == Correspondence::dense ? "dense" : "sparse";
}

/// What becomes of control points that belong to other AUs than the expression's.
enum class OtherPoints {
    none,      ///< they are left out (thesis)
    followed,  ///< those of the expression's half of the face are followed as measured, as its own are
    still      ///< they hold still, those of both halves
};
[[nodiscard]] constexpr const char* to_string(OtherPoints points) {
    return points == OtherPoints::none ? "none" : points == OtherPoints::followed ? "followed" : "still";
}

struct ModelOptions {
    Correspondence correspondence = Correspondence::dense;
    Normalisation normalisation = Normalisation::similarity;
    geometry::SplineKernel kernel = geometry::SplineKernel::r;
    /// Of the landmark splines, unit of the kernel. Landmarks are marked to 0.5-1 mm only, and of 0, 10, 30 mm the last
    /// measured best.
    double smoothing = 30.0;
    bool anchors = true;            ///< points that the AU leaves alone hold still in the neutral-to-expressive map
    bool wrinkle_points = true;     ///< thesis 5.5.2
    bool coverage_points = true;    ///< further points that cover the active zone evenly
    bool snap_to_vertices = false;  ///< move points to the nearest vertex (thesis) instead of the nearest surface point
    bool place_on_average = true;   ///< controls are placed on the average face and carried over; else on the source
    bool anchors_in_both_maps = true;  ///< anchors hold still from neutral to expressive, too; else in the warp alone
    OtherPoints other_points = OtherPoints::none;
    /// As many points, spread evenly over the zone, take the place of all control points, move as the template does
    /// there, and are all that is kept of a dense model; 0: none. Anchors stay.
    int spread_points = 0;

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("correspondence", self.correspondence);
        visit("frame", self.normalisation);
        visit("kernel", self.kernel);
        visit("smoothing", self.smoothing);
        visit("anchors", self.anchors);
        visit("wrinkle_points", self.wrinkle_points);
        visit("coverage_points", self.coverage_points);
        visit("snap_to_vertices", self.snap_to_vertices);
        visit("place_on_average", self.place_on_average);
        visit("anchors_in_both_maps", self.anchors_in_both_maps);
        visit("other_points", self.other_points);
        visit("spread_points", self.spread_points);
    }
    /// Control points alone, as they measured best.
    [[nodiscard]] static ModelOptions sparse();
    /// The equations of the thesis: affine frame, r^2 ln r^2, no anchors, no coverage points, nearest vertices.
    [[nodiscard]] static ModelOptions thesis();
    [[nodiscard]] bool operator==(const ModelOptions&) const = default;
    void check() const;
};
static_assert(base::lists_every_field<ModelOptions>());

/// The fields in which a model's options differ from the usual ones, for names of files: "_r2logr_no-anchors".
[[nodiscard]] std::string variant_suffix(const ModelOptions& options, const ModelOptions& usual);

/// How a stored model came about.
struct ModelProvenance {
    std::string mimik_version;
    std::string method;  ///< "default" or "thesis": what the options began as
    ModelOptions options;
    std::string catalogue, catalogue_hash;  ///< FacsCatalogue::name and content_hash
    std::string average_face;               ///< average_fingerprint
    [[nodiscard]] bool operator==(const ModelProvenance&) const = default;
};
/// What differs, apart from version and method's name: "kernel r2logr, here r". Empty: nothing.
[[nodiscard]] std::vector<std::string> differences(const ModelProvenance& stored, const ModelProvenance& here);

/// One control point of a model: where it is on the model's own neutral face, and where the expression takes it.
struct ModelPoint {
    std::string name;
    facs::ControlKind kind = facs::ControlKind::muscle;
    geometry::Point position_mm = geometry::Point::Zero();
    geometry::Vector displacement_mm = geometry::Vector::Zero();  ///< Eq. 5.6; zero for anchors
    double projection_mm = 0.0;  ///< how far the spline's answer lay from the expressive surface
};

/// An Action Unit (or emotion) as control points and displacements in the average frame: all that is needed to put it
/// on any face. From one source, or the mean of several on the average face.
struct ExpressionModel {
    facs::Expression expression;
    bool moves_upper_face = false;
    bool moves_lower_face = true;
    Normalisation normalisation = Normalisation::similarity;
    std::vector<std::string> sources;           ///< scans that went in, neutral and expressive in turn
    geometry::Landmarks landmarks;              ///< of the model's neutral face, same frame as the points
    double mouth_width_mm = 0.0;                ///< between the mouth corners of that neutral face, same frame
    std::vector<ModelPoint> points;             ///< controls, then anchors
    std::vector<std::string> left_out;          ///< points that could not be placed or measured, with the reason
    std::vector<std::string> unusable_scans;    ///< of a mean: scans that should have gone in and could not, and why
    std::optional<TemplateMotion> dense;        ///< moves faces instead of the points, where there is one
    std::optional<ModelProvenance> provenance;  ///< of a stored one; older files have none

    [[nodiscard]] double largest_displacement_mm() const;
};

/// One control point of a model on the two scans that it was measured from, for figures and for those who want to know.
struct FollowedPoint {
    std::string name;
    facs::ControlKind kind = facs::ControlKind::muscle;
    geometry::Point neutral_mm = geometry::Point::Zero();     ///< scanner frame of the neutral scan
    geometry::Point expressive_mm = geometry::Point::Zero();  ///< scanner frame of the expressive scan
};

/// Both scans of a source in the frame of a model, with what is searched in them: made once by those who measure the
/// same source again and again. For one thread at a time.
class NormalisedSource {
public:
    /// @param options  the frame and whether points go to vertices; what is measured later must have the same
    NormalisedSource(const preprocessing::Face& neutral, const preprocessing::Face& expressive,
                     const ModelOptions& options);
    ~NormalisedSource();
    NormalisedSource(NormalisedSource&&) noexcept;

private:
    friend class ExpressionGauge;
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// Measures one expression on source after source: places its points on the source's neutral face, follows them to its
/// expressive scan (landmark spline of Eq. 5.5, then the nearest point of the expressive surface) and takes the
/// differences (Eq. 5.6). What all sources share, the points on the average face, is made once. Keeps references to
/// catalogue and average.
class ExpressionGauge {
public:
    /// @param expression  what the scans show, or one side of it.
    /// @param registrations  of this average face, for dense models: Workspace::registrations(); none: made anew, kept
    /// nowhere
    /// @throws InputError if landmarks are missing or a unit of the expression is not in the catalogue.
    ExpressionGauge(const facs::FacsCatalogue& catalogue, const facs::Expression& expression,
                    const preprocessing::AverageFace& average, const ModelOptions& options = {},
                    std::shared_ptr<const preprocessing::KeptRegistrations> registrations = nullptr);
    /// From any thread. @throws InputError if landmarks are missing; NumericalError from the spline or of a scan that
    /// the template does not come to lie on.
    [[nodiscard]] ExpressionModel measure(const preprocessing::Face& neutral, const preprocessing::Face& expressive,
                                          std::vector<FollowedPoint>* followed = nullptr) const;
    /// The same of a source that was made ready; a sparse model alone.
    [[nodiscard]] ExpressionModel measure(NormalisedSource& source,
                                          std::vector<FollowedPoint>* followed = nullptr) const;

private:
    /// The points of the expression, and what becomes of those of other AUs.
    struct Placed : PlacedControls {
        std::vector<ControlPoint> still;  ///< controls of other AUs that hold still in the warp
    };
    [[nodiscard]] Placed place(const geometry::Landmarks& landmarks, const geometry::SurfaceIndex& surface) const;
    void spread_over_zone();
    void keep_spread_points(ExpressionModel& model) const;

    const facs::FacsCatalogue& catalogue_;
    const preprocessing::AverageFace& average_;
    facs::Expression expression_;
    ModelOptions options_;
    ExpressionModel begun_;  ///< what every model of this expression has
    std::shared_ptr<const preprocessing::KeptRegistrations> registrations_;  ///< of a dense model
    Placed on_average_;                  ///< empty if the controls are placed on each source itself
    std::vector<std::uint32_t> spread_;  ///< vertices of the template that spread_points stand on
};

/// One source alone. @throws as ExpressionGauge.
[[nodiscard]] ExpressionModel measure_expression(
    const facs::FacsCatalogue& catalogue, const facs::Expression& expression, const preprocessing::AverageFace& average,
    const preprocessing::Face& neutral, const preprocessing::Face& expressive, const ModelOptions& options = {},
    std::vector<FollowedPoint>* followed = nullptr,
    std::shared_ptr<const preprocessing::KeptRegistrations> registrations = nullptr);

/// Source-independent AU (thesis 7.2): mean displacement of every point over models that stand on the average face, one
/// after another; holds their sum alone. A point that a model left out is averaged over the rest.
class ExpressionMean {
public:
    /// @throws InputError if the model does not go with the earlier ones.
    void add(const ExpressionModel& model);
    [[nodiscard]] ExpressionModel mean() const;  ///< @throws InputError of no model

private:
    std::optional<ExpressionModel> sum_;
    std::map<std::string, std::size_t> place_;  // of a point, by name
    std::vector<double> count_;                 // per point
    std::size_t models_ = 0;
};

/// @throws InputError if it is none that can be animated: no point, a name twice, a width of 0, a number that is not
/// finite.
void check_expression_model(const ExpressionModel& model);

/// JSON, schema 1: readable, 17 digits.
void write_expression_model(const std::filesystem::path& file, const ExpressionModel& model);
[[nodiscard]] ExpressionModel read_expression_model(const std::filesystem::path& file);
/// The same in memory; `name` stands for the file. @throws InputError naming file and field.
[[nodiscard]] std::string encode_expression_model(const ExpressionModel& model);
[[nodiscard]] ExpressionModel decode_expression_model(std::string_view text, const std::string& name);

}  // namespace mimik::modeling
