#include "animation/method.h"
#include "geometry/landmark_spline.h"

namespace mimik::animation::methods {
namespace {

using geometry::Landmarks;
using geometry::Point;
using modeling::Normalisation;

/// A source's landmarks at rest and with the expression, average frame.
class LandmarkLesson : public Lesson {
public:
    LandmarkLesson(Landmarks neutral, Landmarks expressive)
        : neutral_(std::move(neutral)), expressive_(std::move(expressive)) {}
    [[nodiscard]] std::size_t bytes() const override { return 2 * neutral_.size() * sizeof(geometry::Landmark); }
    [[nodiscard]] const Landmarks& neutral() const { return neutral_; }
    [[nodiscard]] const Landmarks& expressive() const { return expressive_; }

private:
    Landmarks neutral_, expressive_;
};

class LandmarkTransfer : public Transfer {
public:
    explicit LandmarkTransfer(LessonPointer lesson) : lesson_(std::move(lesson)) {}
    [[nodiscard]] geometry::DisplacementField on(const PreparedTarget& target) const override {
        const auto& lesson = dynamic_cast<const LandmarkLesson&>(*lesson_);
        const auto& [average_from_target, landmarks, snapped, vertices_mm, surface] =
            target.normalised(Normalisation::similarity);
        geometry::LandmarkPairs controls;
        for (const auto& pair : geometry::pair_by_name(lesson.neutral(), lesson.expressive()).pairs)
            if (const auto* mark = landmarks.find(pair.name))
                controls.add(pair.name, mark->position_mm, mark->position_mm + (pair.target_mm - pair.source_mm));
        const auto warp = controls.fit();
        const Eigen::Matrix3d target_from_average = average_from_target.linear().inverse();
        auto field = geometry::DisplacementField::still(target.surface().size());
        field.answered = target.surface().present;
        for (std::size_t v = 0; v < field.size(); ++v)
            if (field.answered[v]) field.mm[v] = target_from_average * (warp(vertices_mm[v]) - vertices_mm[v]);
        return field;
    }

private:
    LessonPointer lesson_;
};

class LandmarkLearner : public Learner {
public:
    [[nodiscard]] LessonPointer study(const modeling::Performance& performance) const override {
        const auto& [neutral, expressive] = std::pair<const preprocessing::Face&, const preprocessing::Face&>(
            performance.neutral, performance.expressive);
        return std::make_shared<const LandmarkLesson>(
            geometry::transformed(neutral.landmarks, neutral.average_from_scan),
            geometry::transformed(expressive.landmarks, expressive.average_from_scan));
    }
    [[nodiscard]] std::unique_ptr<const Transfer> learn(std::span<const LessonPointer> lessons) const override {
        return std::make_unique<LandmarkTransfer>(lessons.front());
    }
};

/// The landmarks alone as controls of one spline over the whole face: no point that holds still, no cut.
class LandmarkMethod : public Method {
public:
    [[nodiscard]] std::string name() const override { return "landmarks"; }
    [[nodiscard]] std::string summary() const override { return "One spline through the 22 landmarks as they move"; }
    [[nodiscard]] MethodGroup group() const override { return MethodGroup::simple; }
    [[nodiscard]] SourceKind needs() const override { return SourceKind::one_source; }
    [[nodiscard]] std::unique_ptr<const Learner> learner(const LearningTask&) const override {
        return std::make_unique<LandmarkLearner>();
    }
};

}  // namespace

MethodPointer landmarks_method() { return std::make_shared<LandmarkMethod>(); }

}  // namespace mimik::animation::methods
