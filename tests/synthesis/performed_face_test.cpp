#include <array>
#include <cmath>
#include <list>
#include <map>

#include <gtest/gtest.h>

#include "synthesis/builtin_sheet.h"
#include "synthesis/scanner.h"
#include "synthesis/subject.h"

// What single shapes of the mean face cannot show: sums of shapes with all variances, on drawn people.

namespace mimik::synthesis {
namespace {

using geometry::Point;

struct Columns {
    std::map<std::uint32_t, std::array<std::size_t, 2>> lips, lids;  ///< upper and lower margin per column
};

struct Performed {
    std::string scan, code;
    const Subject* subject = nullptr;
    std::uint64_t seed = 0;
    std::vector<Point> vertices_mm;
};

/// Every expression of two people, performed once for all tests.
class PerformedFace : public testing::Test {
protected:
    static void SetUpTestSuite() {
        sheet_ = make_sheet();
        for (std::size_t i = 0; i < sheet_.vertices.size(); ++i) {
            const auto& p = sheet_.vertices[i];
            if (p.v == place::stomion && std::abs(p.s) < place::mouth_corner)
                columns_.lips[p.column][sheet_.lower_lip_side[i] ? 1 : 0] = i;
            if (std::abs(p.across_eye) >= 1) continue;
            if (p.v == place::upper_lid) columns_.lids[p.column][0] = i;
            if (p.v == place::lower_lid) columns_.lids[p.column][1] = i;
        }
        auto expressions = make_expressions("all");
        expressions.insert(expressions.begin(), make_expression("N"));
        model_ = make_builtin_face_model();
        for (const auto& [name, seed] : {std::pair{"bs001", 3U}, std::pair{"bs000", 8U}}) {
            const auto& subject = subjects_.emplace_back(draw_subject(*model_, name, seed));
            for (const auto& expression : expressions) {
                const std::string scan = std::string(name) + "_" + expression.group + "_" + expression.code + "_0";
                auto done = perform(subject, expression, scan, seed);
                performances_.push_back({scan, expression.code, &subject, seed, std::move(done.vertices_mm)});
            }
        }
    }
    static void TearDownTestSuite() {
        performances_.clear();
        subjects_.clear();
        model_.reset();
    }
    static double gap_mm(const std::vector<Point>& face, const std::array<std::size_t, 2>& pair) {
        return face[pair[0]].y() - face[pair[1]].y();
    }

    inline static std::unique_ptr<FaceModel> model_;
    inline static Sheet sheet_;
    inline static Columns columns_;
    inline static std::list<Subject> subjects_;
    inline static std::vector<Performed> performances_;
};

TEST_F(PerformedFace, lips_and_lids_never_pass_each_other_and_au_43_closes_the_eyes) {
    ASSERT_GT(columns_.lips.size(), 40U);
    ASSERT_GT(columns_.lids.size(), 50U);
    constexpr double rounding = 1e-9;  // mm, of sums of millimetres
    for (const auto& done : performances_) {
        double lips = 1, lids = 1, open = 0;
        for (const auto& entry : columns_.lips) lips = std::min(lips, gap_mm(done.vertices_mm, entry.second));
        for (const auto& entry : columns_.lids) {
            lids = std::min(lids, gap_mm(done.vertices_mm, entry.second));
            open = std::max(open, gap_mm(done.vertices_mm, entry.second));
        }
        EXPECT_GE(lips, -rounding) << done.scan;
        EXPECT_GE(lids, -rounding) << done.scan;
        if (done.code == "43")
            EXPECT_LE(open, rounding) << done.scan;
        else
            EXPECT_GT(open, 2) << done.scan;  // the narrowest squint leaves a few millimetres
    }
}

TEST_F(PerformedFace, skin_of_the_front_does_not_fold_over_nor_travel_farther_than_a_face_can) {
    const auto triangles = geometry::triangulate(model_->faces());
    for (const auto& done : performances_) {
        const auto& face = done.vertices_mm;
        int away = 0;
        for (const auto& t : triangles) {
            const auto& p = sheet_.vertices[t[0]];
            const double a = std::abs(p.s);
            const bool lid = std::abs(p.across_eye) < 1.45 && p.v > -26 && p.v < 12;
            const bool lip = a < 30 && p.v < -64 && p.v > -92;  // corners and pressed lips turn in
            // Below -98 an open jaw shows its underside.
            if (a > 66 || p.v < -98 || lid || lip) continue;
            if ((face[t[1]] - face[t[0]]).cross(face[t[2]] - face[t[0]]).z() <= 0) ++away;
        }
        EXPECT_EQ(away, 0) << done.scan;
        double most = 0;
        for (std::size_t i = 0; i < face.size(); ++i)
            most = std::max(most, (face[i] - done.subject->resting_mm[i]).norm());
        // The strongest shape of the cheek moves 16.3 mm; the greatest weight is 1.2 and the field adds at most 30 %:
        // 25.4, and a little for what moves along. A jaw opens by 39 mm and more in large faces.
        EXPECT_LT(most, done.code == "27" ? 55 : 26) << done.scan;
    }
}

TEST_F(PerformedFace, every_expression_keeps_the_landmarks_that_alignment_needs) {
    for (const auto& done : performances_) {
        const auto made = scan_face(*model_, done.vertices_mm, face_window(*model_, done.subject->resting_mm),
                                    done.scan, done.seed, {});
        for (const char* name : {"eye_inner_left", "eye_inner_right", "eye_outer_left", "eye_outer_right",
                                 "mouth_corner_left", "mouth_corner_right", "nose_tip", "chin"})
            EXPECT_TRUE(made.landmarks.find(name)) << done.scan << " " << name;
    }
}

}  // namespace
}  // namespace mimik::synthesis
