#include "animation/method.h"

namespace mimik::animation::methods {
namespace {

class Still : public Transfer {
public:
    [[nodiscard]] geometry::DisplacementField on(const PreparedTarget& target) const override {
        return geometry::DisplacementField::still(target.surface().size());
    }
};

class NothingToLearn : public Learner {
public:
    [[nodiscard]] LessonPointer study(const modeling::Performance&) const override { return nullptr; }
    [[nodiscard]] std::unique_ptr<const Transfer> learn(std::span<const LessonPointer>) const override {
        return std::make_unique<Still>();
    }
};

/// Doing nothing: the neutral face itself, which every other method has to beat.
class Nothing : public Method {
public:
    [[nodiscard]] std::string name() const override { return "nothing"; }
    [[nodiscard]] std::string title() const override { return "doing nothing"; }
    [[nodiscard]] std::string summary() const override { return "The neutral face itself"; }
    [[nodiscard]] MethodGroup group() const override { return MethodGroup::simple; }
    [[nodiscard]] SourceKind needs() const override { return SourceKind::none; }
    [[nodiscard]] std::unique_ptr<const Learner> learner(const LearningTask&) const override {
        return std::make_unique<NothingToLearn>();
    }
};

}  // namespace

MethodPointer nothing_method() { return std::make_shared<Nothing>(); }

}  // namespace mimik::animation::methods
