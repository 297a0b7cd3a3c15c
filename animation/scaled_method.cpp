#include "animation/scaled_method.h"

#include <cmath>

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::animation {
namespace {

class ScaledTransfer : public Transfer {
public:
    ScaledTransfer(std::unique_ptr<const Transfer> scaled, double magnitude)
        : scaled_(std::move(scaled)), magnitude_(magnitude) {}
    [[nodiscard]] geometry::DisplacementField on(const PreparedTarget& target) const override {
        auto field = scaled_->on(target);
        for (auto& displacement : field.mm) displacement *= magnitude_;
        return field;
    }
    [[nodiscard]] std::vector<preprocessing::LipSide> lip_sides(const PreparedTarget& target) const override {
        return scaled_->lip_sides(target);
    }

private:
    std::unique_ptr<const Transfer> scaled_;
    double magnitude_;
};

class ScaledLearner : public Learner {
public:
    ScaledLearner(std::unique_ptr<const Learner> scaled, double magnitude)
        : scaled_(std::move(scaled)), magnitude_(magnitude) {}
    [[nodiscard]] LessonPointer study(const modeling::Performance& performance) const override {
        return scaled_->study(performance);
    }
    [[nodiscard]] std::unique_ptr<const Transfer> learn(std::span<const LessonPointer> lessons) const override {
        return std::make_unique<ScaledTransfer>(scaled_->learn(lessons), magnitude_);
    }

private:
    std::unique_ptr<const Learner> scaled_;
    double magnitude_;
};

}  // namespace

ScaledMethod::ScaledMethod(std::string name, MethodPointer scaled, double magnitude)
    : name_(std::move(name)), scaled_(std::move(scaled)), magnitude_(magnitude) {
    if (!(magnitude > 0 && std::isfinite(magnitude)))
        throw InputError(fmt::format("method '{}': magnitude is {}; give more than 0", name_, magnitude));
}

std::string ScaledMethod::summary() const {
    return fmt::format("{} at magnitude {}: one source at 1 exaggerates", scaled_->name(), magnitude_);
}

std::unique_ptr<const Learner> ScaledMethod::learner(const LearningTask& task) const {
    return std::make_unique<ScaledLearner>(scaled_->learner(task), magnitude_);
}

}  // namespace mimik::animation
