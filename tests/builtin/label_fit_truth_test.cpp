// Labels that are fitted to another face of the built-in model, whose vertices are those of the reference: the truth is
// known.

#include <array>

#include <gtest/gtest.h>

#include "animation/dense_label_fit.h"
#include "capture/label_fit.h"
#include "synthesis/performance.h"

namespace mimik::builtin {
namespace {

using geometry::Landmarks;
using geometry::Point;

class LabelFitTruth : public testing::Test {
protected:
    static void SetUpTestSuite() { shared_ = new Faces; }
    static void TearDownTestSuite() {
        delete shared_;
        shared_ = nullptr;
    }
    struct Faces {
        std::unique_ptr<synthesis::FaceModel> model = synthesis::make_builtin_face_model();
        synthesis::Performer source{*model, "source", 1}, person{*model, "target", 1};
        std::vector<geometry::Triangle> triangles{source.triangles().begin(), source.triangles().end()};
        geometry::SurfaceIndex reference{source.resting_mm(), triangles};
        preprocessing::FitTarget target{person.resting_mm(), triangles};
        Landmarks labels = source.labels(), truth, points;
        capture::LabelStart start = begin();

        capture::LabelStart begin() {
            std::vector<geometry::Landmark> all, some;
            for (const auto& label : labels.all()) {
                const auto at = reference.closest(label.position_mm);
                Point place = Point::Zero();
                for (std::size_t c = 0; c < 3; ++c)
                    place +=
                        at.barycentric[static_cast<Eigen::Index>(c)] * person.resting_mm()[triangles[at.triangle][c]];
                all.push_back({label.name, place, ""});
                for (const char* name : by_hand)
                    if (label.name == name) some.push_back(all.back());
            }
            truth = Landmarks(all);
            points = Landmarks(some);
            return capture::start_labels(reference, labels, target.surface(), points);
        }
    };
    static constexpr std::array by_hand = {
        "forehead_high",    "eye_outer_left", "eye_inner_left",    "eye_inner_right",
        "eye_outer_right",  "nose_tip",       "mouth_corner_left", "mouth_corner_right",
        "lip_upper_middle", "chin",           "jaw_outer_left",    "jaw_outer_right"};

    static double mean_error_mm(const Landmarks& labels) {
        double sum = 0;
        for (const auto& label : labels.all())
            if (!shared_->points.find(label.name))
                sum += (label.position_mm - shared_->truth.position_mm(label.name)).norm();
        return sum / static_cast<double>(labels.size() - by_hand.size());
    }
    static Faces* shared_;
};
LabelFitTruth::Faces* LabelFitTruth::shared_ = nullptr;

TEST_F(LabelFitTruth, the_energy_falls_and_no_label_strays) {
    const auto& faces = *shared_;
    const auto found = capture::fit_labels(faces.start, faces.labels, faces.target.surface(),
                                           capture::builtin_marker_set(), capture::SurfaceMinimiser::levenberg);
    EXPECT_LT(found.found.end.total, found.found.start.total);
    // Four such pairs have 2.4 mm in the mean.
    EXPECT_LT(mean_error_mm(found.labels), 3.0);
}

TEST_F(LabelFitTruth, dense_correspondence_is_nearer_to_the_truth_than_the_start) {
    const auto& faces = *shared_;
    const auto dense = animation::fit_labels_densely(faces.start, faces.source.resting_mm(), faces.triangles,
                                                     faces.labels, faces.target);
    EXPECT_LT(mean_error_mm(dense.labels), mean_error_mm(faces.start.labels()));
    EXPECT_LT(mean_error_mm(dense.labels), 2.4);  // four such pairs have 1.8 mm in the mean
}

}  // namespace
}  // namespace mimik::builtin
