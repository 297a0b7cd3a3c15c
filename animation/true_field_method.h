#pragma once

#include <string>

#include "animation/method.h"

namespace mimik::animation {

/// Others' true motion, carried to the target by true correspondence: a bound that a synthetic database knows. The mean
/// of several sources weighs each alike.
class TrueFieldMethod : public Method {
public:
    TrueFieldMethod(std::string name, std::string title, SourceKind needs)
        : name_(std::move(name)), title_(std::move(title)), needs_(needs) {}

    [[nodiscard]] std::string name() const override { return name_; }
    [[nodiscard]] std::string title() const override { return title_; }
    [[nodiscard]] std::string summary() const override {
        return needs_ == SourceKind::one_source ? "The source's true motion in true correspondence"
                                                : "The mean of the others' true motions in true correspondence";
    }
    [[nodiscard]] MethodGroup group() const override { return MethodGroup::bound; }
    [[nodiscard]] SourceKind needs() const override { return needs_; }
    [[nodiscard]] bool needs_truth() const override { return true; }
    [[nodiscard]] std::string lessons_key() const override { return "true field"; }
    [[nodiscard]] std::unique_ptr<const Learner> learner(const LearningTask& task) const override;

private:
    std::string name_, title_;
    SourceKind needs_;
};

}  // namespace mimik::animation
