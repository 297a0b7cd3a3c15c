#pragma once

#include <vector>

#include "base/fields.h"
#include "preprocessing/face.h"
#include "preprocessing/face_template.h"
#include "preprocessing/nonrigid_fit.h"

namespace mimik::preprocessing {

struct TemplateRegistrationOptions {
    NonrigidFitOptions neutral = {.first_smoothness = 10, .stages = 3};
    NonrigidFitOptions expressive = {.bend_mm = 0.5, .stillness = 0.003};
    double landmark_smoothing = 5.0;  ///< of the splines that give the start, mm: kernel r
    /// A vertex holds still at the start where the neutral surface about it, so far around, lies on the expressive one.
    double still_around_mm = 7.0;
    double still_within_mm = 0.3;      ///< and so near
    double still_off_marks_mm = 12.0;  ///< and no landmark that moved by over 1 mm is so near
    /// So near a landmark that moved, what may have slid along itself does not count as still:
    double still_doubt_mm = 25.0;
    double still_relief = 0.006;  ///< smallest eigenvalue of the mean of n n^T of the normals about a vertex that shows
    double still_spacing_mm = 8.0;  ///< of the controls that hold still
    double still_motion_mm = 0.4;   ///< motion d becomes d d^2 / (d^2 + this^2): what is noise goes
    /// Stillness rises to so many times its weight between these distances from the landmarks that moved.
    double far_from_mm = 20.0, far_to_mm = 45.0, far_stillness = 12.0;
    /// Both distances grow by this share for every 10 mm that a landmark moves beyond the first: a jaw that drops moves
    /// the skin up to the ears.
    double far_growth = 0.5;
    /// Lips that part by more than this go to half ellipses through their landmarks at the start.
    double arcs_from_parting_mm = 4.0;
    /// A fit with fewer of the template's vertices on the scan is refused. Faces of three worlds have 0.88 and more.
    double least_matched = 0.5;

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("neutral", self.neutral);
        visit("expressive", self.expressive);
        visit("landmark_smoothing", self.landmark_smoothing);
        visit("still_around_mm", self.still_around_mm);
        visit("still_within_mm", self.still_within_mm);
        visit("still_off_marks_mm", self.still_off_marks_mm);
        visit("still_doubt_mm", self.still_doubt_mm);
        visit("still_relief", self.still_relief);
        visit("still_spacing_mm", self.still_spacing_mm);
        visit("far_from_mm", self.far_from_mm);
        visit("far_to_mm", self.far_to_mm);
        visit("far_stillness", self.far_stillness);
        visit("far_growth", self.far_growth);
        visit("arcs_from_parting_mm", self.arcs_from_parting_mm);
        visit("least_matched", self.least_matched);
        visit("still_motion_mm", self.still_motion_mm);
    }
    void check() const;
};
static_assert(base::lists_every_field<TemplateRegistrationOptions>());

/// The template bent on to one scan.
struct RegisteredTemplate {
    std::vector<geometry::Point> vertices_mm;  ///< average frame of the subject: Face::average_from_scan
    geometry::VertexMask matched;              ///< the vertex lies on the scan
    double matched_share = 0.0;
    double residual_rms_mm = 0.0;
};

/// The motion of an expression on the template, and how it was found.
struct RegisteredMotion {
    std::vector<geometry::Vector> motion_mm;  ///< per vertex of the template, average frame of the subject
    geometry::VertexMask matched;
    std::size_t still_controls = 0;  ///< where the data show that nothing moved
    double matched_share = 0.0;
    double residual_rms_mm = 0.0;
};

/// Dense correspondence between faces: the template of an average face is bent on to every scan. From any thread.
class TemplateRegistration {
public:
    explicit TemplateRegistration(FaceTemplate face_template, const TemplateRegistrationOptions& options = {});
    [[nodiscard]] const FaceTemplate& face_template() const { return template_; }
    /// On to a neutral scan. @throws NumericalError if less than `least_matched` of the template
    /// comes to lie on the scan; InputError if it has no surface.
    [[nodiscard]] RegisteredTemplate neutral(const Face& face) const;
    /// On to anybody's surface. @param landmarks  same frame, of which the size is about that of the average face
    [[nodiscard]] RegisteredTemplate neutral(const FitTarget& surface, const geometry::Landmarks& landmarks) const;
    /// From there on to an expressive scan of the same subject. @throws as neutral().
    [[nodiscard]] RegisteredMotion motion(const Face& neutral, const RegisteredTemplate& registered,
                                          const Face& expressive) const;

private:
    void judge(const NonrigidFit& fit) const;
    [[nodiscard]] std::vector<FitMark> marks(const geometry::Landmarks& landmarks) const;
    [[nodiscard]] std::vector<geometry::Point> start(const geometry::Landmarks& from, const geometry::Landmarks& to,
                                                     std::span<const geometry::Point> still_mm,
                                                     std::span<const geometry::Point> vertices_mm) const;

    FaceTemplate template_;
    TemplateRegistrationOptions options_;
    std::vector<double> lip_shares_;  ///< per vertex of the template
    geometry::VertexMask lip_rims_;   ///< likewise
    NonrigidFitter fitter_;
};

}  // namespace mimik::preprocessing
