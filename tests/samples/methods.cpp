#include <gtest/gtest.h>

#include "tests/support/analytic_workspace.h"

// [sample]
// animation/methods/nearest_landmark.cpp
#include <cmath>
#include <map>

#include "animation/method.h"

namespace mimik::animation::methods {
namespace {

using geometry::DisplacementField;
using geometry::Vector;
using modeling::Normalisation;

constexpr double reach_mm = 15.0;  // a landmark speaks for the skin around it

/// What is kept of a source: how far each of its landmarks moved, on the average face.
class LandmarkMotion : public Lesson {
public:
    explicit LandmarkMotion(std::map<std::string, Vector> moved_mm) : moved_mm_(std::move(moved_mm)) {}
    [[nodiscard]] std::size_t bytes() const override { return moved_mm_.size() * 100; }
    [[nodiscard]] const std::map<std::string, Vector>& moved_mm() const { return moved_mm_; }

private:
    std::map<std::string, Vector> moved_mm_;
};

/// Every vertex follows the landmark that lies nearest, the less the farther it is.
class FollowNearest : public Transfer {
public:
    explicit FollowNearest(LessonPointer lesson) : lesson_(std::move(lesson)) {}

    [[nodiscard]] DisplacementField on(const PreparedTarget& target) const override {
        const auto& moved_mm = dynamic_cast<const LandmarkMotion&>(*lesson_).moved_mm();
        const auto& face = target.surface();
        const auto& average_from_target = target.average_from_target(Normalisation::similarity);
        const Eigen::Matrix3d target_from_average = average_from_target.linear().inverse();
        auto field = DisplacementField::still(face.size());
        field.answered = face.present;
        for (std::size_t v = 0; v < face.size(); ++v) {
            if (!face.present[v]) continue;
            double nearest_mm = INFINITY;
            for (const auto& mark : face.landmarks.all()) {
                const auto found = moved_mm.find(mark.name);
                const double distance_mm = (face.vertices_mm[v] - mark.position_mm).norm();
                if (found == moved_mm.end() || distance_mm >= nearest_mm) continue;
                nearest_mm = distance_mm;
                field.mm[v] = std::exp(-std::pow(distance_mm / reach_mm, 2)) * (target_from_average * found->second);
            }
        }
        return field;
    }

private:
    LessonPointer lesson_;
};

class LandmarkLearner : public Learner {
public:
    [[nodiscard]] LessonPointer study(const modeling::Performance& performance) const override {
        const auto& there = performance.expressive.landmarks;
        const auto moved = geometry::transformed(there, performance.neutral_from_expressive);
        const Eigen::Matrix3d average_from_neutral = performance.neutral.average_from_scan.linear();
        std::map<std::string, Vector> moved_mm;
        for (const auto& pair : geometry::pair_by_name(performance.neutral.landmarks, moved).pairs)
            moved_mm[pair.name] = average_from_neutral * (pair.target_mm - pair.source_mm);
        return std::make_shared<LandmarkMotion>(std::move(moved_mm));
    }
    [[nodiscard]] std::unique_ptr<const Transfer> learn(std::span<const LessonPointer> lessons) const override {
        return std::make_unique<FollowNearest>(lessons.front());
    }
};

class NearestLandmark : public Method {
public:
    [[nodiscard]] std::string name() const override { return "nearest-landmark"; }
    [[nodiscard]] SourceKind needs() const override { return SourceKind::one_source; }
    [[nodiscard]] std::unique_ptr<const Learner> learner(const LearningTask&) const override {
        return std::make_unique<LandmarkLearner>();
    }
};

}  // namespace

MethodPointer nearest_landmark_method() { return std::make_shared<NearestLandmark>(); }

}  // namespace mimik::animation::methods
// [end]

namespace mimik {

TEST(Samples, a_method_of_ones_own_moves_the_corner_of_a_larger_mouth_as_far_as_it_is_larger) {
    const auto average = test::analytic_average();
    const auto source = test::analytic_subject(average, 1.0, 6.0), target = test::analytic_subject(average, 1.1, 6.0);
    const auto smile = facs::builtin_catalogue().expression("12");
    const modeling::Performance performance{source.neutral, source.smiling, source.smiling.neutral_from_scan,
                                            std::nullopt, std::nullopt};
    const auto method = animation::methods::nearest_landmark_method();
    const auto transfer =
        animation::learn(*method, {smile, average, facs::builtin_catalogue()}, std::span(&performance, 1));
    const animation::PreparedTarget prepared(target.neutral);
    const auto field = transfer->on(prepared);
    const auto corner = target.neutral.landmarks.position_mm("mouth_corner_left");
    const auto tip = target.neutral.landmarks.position_mm("nose_tip");
    std::size_t at_corner = 0, at_tip = 0;
    const auto& face = prepared.surface();
    for (std::size_t v = 0; v < face.size(); ++v) {
        if (!face.present[v]) continue;
        if ((face.vertices_mm[v] - corner).norm() < (face.vertices_mm[at_corner] - corner).norm() || at_corner == 0)
            at_corner = v;
        if ((face.vertices_mm[v] - tip).norm() < (face.vertices_mm[at_tip] - tip).norm() || at_tip == 0) at_tip = v;
    }
    EXPECT_NEAR(field.mm[at_corner].norm(), 1.1 * 6.0, 0.1);  // 6 mm at unit scale; the vertex lies beside the mark
    EXPECT_LT(field.mm[at_tip].norm(), 0.1);
}

}  // namespace mimik
