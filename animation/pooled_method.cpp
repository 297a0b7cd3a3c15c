#include "animation/pooled_method.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "animation/animate.h"
#include "animation/dense_field.h"
#include "base/quantile.h"
#include "modeling/expression_model.h"
#include "preprocessing/kept_registrations.h"

namespace mimik::animation {

using geometry::Point;
using geometry::Vector;
using modeling::ExpressionModel;

namespace {

struct PooledLesson : Lesson {
    ExpressionModel model;
    std::vector<Point> rest_mm;
    [[nodiscard]] std::size_t bytes() const override {
        constexpr std::size_t name_bytes = 32;
        return model.points.size() * (sizeof(modeling::ModelPoint) + name_bytes) + 2 * rest_mm.size() * sizeof(Vector);
    }
};
const PooledLesson& lesson_of(const LessonPointer& lesson) { return dynamic_cast<const PooledLesson&>(*lesson); }

class PooledTransfer : public Transfer {
public:
    PooledTransfer(std::span<const LessonPointer> lessons, ExpressionModel mean, Pool pool)
        : lessons_(lessons.begin(), lessons.end()), mean_(std::move(mean)), pool_(std::move(pool)) {}

    [[nodiscard]] geometry::DisplacementField on(const PreparedTarget& target) const override {
        std::vector<PooledSource> sources;
        for (const auto& lesson : lessons_) {
            const auto& one = lesson_of(lesson);
            sources.push_back({one.rest_mm, one.model.dense->motion_mm});
        }
        bool both_sides = true;
        for (const auto& unit : mean_.expression.units()) both_sides = both_sides && unit.side == facs::Side::both;
        auto model = mean_;
        model.dense->motion_mm =
            pool_(sources, {mean_.dense->face_template(), both_sides, template_on(target, mean_.dense->registrations)});
        return expression_field(target, model, {});
    }
    [[nodiscard]] std::vector<preprocessing::LipSide> lip_sides(const PreparedTarget& target) const override {
        return animation::lip_sides(target, *mean_.dense);
    }

private:
    std::vector<LessonPointer> lessons_;
    ExpressionModel mean_;
    Pool pool_;
};

class PooledLearner : public Learner {
public:
    PooledLearner(const LearningTask& task, Pool pool)
        : registrations_(task.registrations ? task.registrations
                                            : std::make_shared<const preprocessing::KeptRegistrations>(task.average)),
          gauge_(task.catalogue, task.expression, task.average, {}, registrations_),
          pool_(std::move(pool)) {}

    [[nodiscard]] LessonPointer study(const modeling::Performance& performance) const override {
        auto lesson = std::make_shared<PooledLesson>();
        lesson->model = gauge_.measure(performance.neutral, performance.expressive);
        lesson->rest_mm = registrations_->neutral(performance.neutral).vertices_mm;
        return lesson;
    }
    [[nodiscard]] std::unique_ptr<const Transfer> learn(std::span<const LessonPointer> lessons) const override {
        modeling::ExpressionMean mean;
        for (const auto& lesson : lessons) mean.add(lesson_of(lesson).model);
        return std::make_unique<PooledTransfer>(lessons, mean.mean(), pool_);
    }

private:
    std::shared_ptr<const preprocessing::KeptRegistrations> registrations_;
    modeling::ExpressionGauge gauge_;
    Pool pool_;
};

std::vector<Vector> weighted_motion(std::span<const PooledSource> sources, std::span<const double> weights) {
    std::vector<Vector> motion(sources.front().motion_mm.size(), Vector::Zero());
    double sum = 0;
    for (const double weight : weights) sum += weight;
    for (std::size_t k = 0; k < sources.size(); ++k)
        for (std::size_t v = 0; v < motion.size(); ++v) motion[v] += weights[k] / sum * sources[k].motion_mm[v];
    return motion;
}

}  // namespace

std::unique_ptr<const Learner> PooledMethod::learner(const LearningTask& task) const {
    return std::make_unique<PooledLearner>(task, setting_.pool);
}

std::vector<Vector> symmetric_motion(const preprocessing::FaceTemplate& face_template,
                                     std::span<const Vector> motion_mm) {
    std::vector<Vector> symmetric(motion_mm.begin(), motion_mm.end());
    for (std::size_t v = 0; v < symmetric.size(); ++v) {
        const Vector& other = motion_mm[face_template.mirror[v]];
        symmetric[v] = (motion_mm[v] + Vector(-other.x(), other.y(), other.z())) / 2;
    }
    return symmetric;
}

std::vector<Vector> near_motion(std::span<const PooledSource> sources, const PoolTask& task) {
    std::vector<double> distances_mm;
    for (const auto& source : sources) {
        double square = 0;
        for (std::size_t v = 0; v < task.rest_mm.size(); ++v)
            square += (source.rest_mm[v] - task.rest_mm[v]).squaredNorm();
        distances_mm.push_back(std::sqrt(square / static_cast<double>(task.rest_mm.size())));
    }
    const double width_mm = std::max(base::median(distances_mm), 1e-6);
    std::vector<double> weights;
    weights.reserve(distances_mm.size());
    for (const double distance : distances_mm) weights.push_back(std::exp(-0.5 * std::pow(distance / width_mm, 2)));
    return weighted_motion(sources, weights);
}

}  // namespace mimik::animation
