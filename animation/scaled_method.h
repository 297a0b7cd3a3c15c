#pragma once

#include <string>

#include "animation/method.h"

namespace mimik::animation {

/// Another method's motion, times a magnitude: one source at magnitude 1 exaggerates. Takes the other's lessons.
class ScaledMethod : public Method {
public:
    /// @throws InputError unless the magnitude is above 0
    ScaledMethod(std::string name, MethodPointer scaled, double magnitude);

    [[nodiscard]] std::string name() const override { return name_; }
    [[nodiscard]] std::string summary() const override;
    [[nodiscard]] MethodGroup group() const override { return scaled_->group(); }
    [[nodiscard]] SourceKind needs() const override { return scaled_->needs(); }
    [[nodiscard]] bool needs_truth() const override { return scaled_->needs_truth(); }
    [[nodiscard]] std::string lessons_key() const override { return scaled_->lessons_key(); }
    [[nodiscard]] std::unique_ptr<const Learner> learner(const LearningTask& task) const override;

private:
    std::string name_;
    MethodPointer scaled_;
    double magnitude_ = 1.0;
};

}  // namespace mimik::animation
