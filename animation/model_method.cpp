#include "animation/model_method.h"

#include <fmt/format.h>

#include "animation/dense_field.h"
#include "base/errors.h"
#include "base/fields.h"

namespace mimik::animation {
namespace {

using modeling::ExpressionModel;

class ModelLesson : public Lesson {
public:
    explicit ModelLesson(ExpressionModel model) : model_(std::move(model)) {}
    [[nodiscard]] std::size_t bytes() const override {
        constexpr std::size_t name_bytes = 32;  // most names are too long to stand in the string itself
        return model_.points.size() * (sizeof(modeling::ModelPoint) + name_bytes) +
               (model_.dense ? model_.dense->motion_mm.size() * sizeof(geometry::Vector) : 0);
    }
    [[nodiscard]] const ExpressionModel& model() const { return model_; }

private:
    ExpressionModel model_;
};

const ExpressionModel& model_of(const LessonPointer& lesson) {
    return dynamic_cast<const ModelLesson&>(*lesson).model();
}

class ModelTransfer : public Transfer {
public:
    ModelTransfer(LessonPointer lesson, const AnimationOptions& options)
        : lesson_(std::move(lesson)), options_(options) {}
    [[nodiscard]] geometry::DisplacementField on(const PreparedTarget& target) const override {
        const auto& model = model_of(lesson_);
        auto field = expression_field(target, model, options_);
        for (const auto& displacement : field.mm)
            if (!displacement.allFinite())
                throw NumericalError(
                    fmt::format("{}: a displacement is too large for a number", model.expression.name()));
        return field;
    }
    [[nodiscard]] std::vector<preprocessing::LipSide> lip_sides(const PreparedTarget& target) const override {
        const auto& dense = model_of(lesson_).dense;
        return dense ? animation::lip_sides(target, *dense) : std::vector<preprocessing::LipSide>();
    }

private:
    LessonPointer lesson_;
    AnimationOptions options_;
};

class ModelLearner : public Learner {
public:
    ModelLearner(const LearningTask& task, const ModelMethod::Setting& setting)
        : setting_(setting),
          gauge_(setting.catalogue ? setting.catalogue() : task.catalogue, task.expression, task.average, setting.model,
                 task.registrations) {}

    [[nodiscard]] LessonPointer study(const modeling::Performance& performance) const override {
        return std::make_shared<const ModelLesson>(gauge_.measure(performance.neutral, performance.expressive));
    }

    [[nodiscard]] std::unique_ptr<const Transfer> learn(std::span<const LessonPointer> lessons) const override {
        if (setting_.needs == SourceKind::one_source && lessons.size() == 1)
            return std::make_unique<ModelTransfer>(lessons.front(), setting_.animation);
        modeling::ExpressionMean mean;
        for (const auto& lesson : lessons) mean.add(model_of(lesson));
        return std::make_unique<ModelTransfer>(std::make_shared<const ModelLesson>(mean.mean()), setting_.animation);
    }

private:
    ModelMethod::Setting setting_;
    modeling::ExpressionGauge gauge_;
};

}  // namespace

ModelMethod::ModelMethod(Setting setting) : setting_(std::move(setting)) {
    setting_.model.check();
    setting_.animation.check();
    if (setting_.needs == SourceKind::all_but_target && !setting_.model.place_on_average)
        throw InputError(
            fmt::format("method '{}': a mean needs its points on the average face (place_on_average)", setting_.name));
}

ModelMethod::Setting ModelMethod::thesis(std::string name, std::string summary) {
    return {.name = std::move(name),
            .needs = SourceKind::one_source,
            .model = modeling::ModelOptions::thesis(),
            .animation = AnimationOptions::thesis(),
            .summary = std::move(summary),
            .group = MethodGroup::thesis};
}

std::string ModelMethod::lessons_key() const {
    return "model" + base::field_text(setting_.model) + (setting_.catalogue ? " by points of its own: " + name() : "");
}

std::unique_ptr<const Learner> ModelMethod::learner(const LearningTask& task) const {
    return std::make_unique<ModelLearner>(task, setting_);
}

}  // namespace mimik::animation
