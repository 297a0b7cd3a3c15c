#include <array>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "synthesis/builtin_sheet.h"
#include "synthesis/scanner.h"
#include "synthesis/subject.h"

// What single shapes of the mean face cannot show: sums of shapes with all variances, on drawn people.

namespace mimik::synthesis {
namespace {

using geometry::Point;

/// What is checked of every performance.
class Checks {
public:
    Checks() {
        for (std::size_t i = 0; i < sheet_.vertices.size(); ++i) {
            const auto& p = sheet_.vertices[i];
            if (p.v == place::stomion && std::abs(p.s) < place::mouth_corner)
                lips_[p.column][sheet_.lower_lip_side[i] ? 1 : 0] = i;
            if (std::abs(p.across_eye) >= 1) continue;
            if (p.v == place::upper_lid) lids_[p.column][0] = i;
            if (p.v == place::lower_lid) lids_[p.column][1] = i;
        }
        EXPECT_GT(lips_.size(), 40U);
        EXPECT_GT(lids_.size(), 50U);
    }

    [[nodiscard]] const FaceModel& model() const { return *model_; }

    void lips_and_lids_never_pass_each_other_and_au_43_closes_the_eyes(const std::vector<Point>& face,
                                                                       const std::string& code) const {
        constexpr double rounding = 1e-9;  // mm, of sums of millimetres
        const auto gap_mm = [&](const auto& entry) { return face[entry.second[0]].y() - face[entry.second[1]].y(); };
        double lips = 1, lids = 1, open = 0;
        for (const auto& entry : lips_) lips = std::min(lips, gap_mm(entry));
        for (const auto& entry : lids_) {
            lids = std::min(lids, gap_mm(entry));
            open = std::max(open, gap_mm(entry));
        }
        EXPECT_GE(lips, -rounding);
        EXPECT_GE(lids, -rounding);
        if (code == "43")
            EXPECT_LE(open, rounding);
        else
            EXPECT_GT(open, 2);  // the narrowest squint leaves a few millimetres
    }

    void skin_of_the_front_does_not_fold_over(const std::vector<Point>& face) const {
        int away = 0;
        for (const auto& t : triangles_) {
            const auto& p = sheet_.vertices[t[0]];
            const double a = std::abs(p.s);
            const bool lid = std::abs(p.across_eye) < 1.45 && p.v > -26 && p.v < 12;
            const bool lip = a < 30 && p.v < -64 && p.v > -92;  // corners and pressed lips turn in
            // Below -98 an open jaw shows its underside.
            if (a > 66 || p.v < -98 || lid || lip) continue;
            if ((face[t[1]] - face[t[0]]).cross(face[t[2]] - face[t[0]]).z() <= 0) ++away;
        }
        EXPECT_EQ(away, 0);
    }

    void skin_does_not_travel_farther_than_a_face_can(const std::vector<geometry::Vector>& displacement_mm,
                                                      const std::string& code) const {
        double most = 0;
        for (const auto& d : displacement_mm) most = std::max(most, d.norm());
        // The strongest shape of the cheek moves 16.3 mm; the greatest weight is 1.2 and the field adds at most 30 %:
        // 25.4, and a little for what moves along. A jaw opens by 39 mm and more in large faces.
        EXPECT_LT(most, code == "27" ? 55 : 26);
    }

    void alignment_has_its_landmarks(const std::vector<Point>& face, const Subject& subject, const std::string& scan,
                                     std::uint64_t seed) const {
        const auto made = scan_face(*model_, face, face_window(*model_, subject.resting_mm), scan, seed, {});
        for (const char* name : {"eye_inner_left", "eye_inner_right", "eye_outer_left", "eye_outer_right",
                                 "mouth_corner_left", "mouth_corner_right", "nose_tip", "chin"})
            EXPECT_TRUE(made.landmarks.find(name)) << name;
    }

private:
    std::unique_ptr<FaceModel> model_ = make_builtin_face_model();
    Sheet sheet_ = make_sheet();
    std::vector<geometry::Triangle> triangles_ = geometry::triangulate(model_->faces());
    std::map<std::uint32_t, std::array<std::size_t, 2>> lips_, lids_;  ///< upper and lower margin per column
};

// One test, because performing takes most of the time.
TEST(PerformedFace, no_expression_folds_the_skin_crosses_lips_or_lids_or_hides_the_landmarks_of_alignment) {
    const Checks check;
    auto expressions = make_expressions("all");
    expressions.insert(expressions.begin(), make_expression("N"));
    for (const auto& [name, seed] : {std::pair{"bs001", 3U}, std::pair{"bs000", 8U}}) {
        const auto subject = draw_subject(check.model(), name, seed);
        for (const auto& expression : expressions) {
            const std::string scan = std::string(name) + "_" + expression.group + "_" + expression.code + "_0";
            SCOPED_TRACE(scan);
            const auto done = perform(subject, expression, scan, seed);
            check.lips_and_lids_never_pass_each_other_and_au_43_closes_the_eyes(done.vertices_mm, expression.code);
            check.skin_of_the_front_does_not_fold_over(done.vertices_mm);
            check.skin_does_not_travel_farther_than_a_face_can(done.displacement_mm, expression.code);
            check.alignment_has_its_landmarks(done.vertices_mm, subject, scan, seed);
        }
    }
}

}  // namespace
}  // namespace mimik::synthesis
