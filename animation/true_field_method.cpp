#include "animation/true_field_method.h"

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::animation {
namespace {

using geometry::Vector;
using Field = std::vector<Vector>;

/// On the true surface, whose vertex i is the same skin point on every face.
class TrueFieldLesson : public Lesson {
public:
    explicit TrueFieldLesson(Field field_mm) : field_mm_(std::move(field_mm)) {}
    [[nodiscard]] std::size_t bytes() const override { return field_mm_.size() * sizeof(Vector); }
    [[nodiscard]] const Field& field_mm() const { return field_mm_; }

private:
    Field field_mm_;  // head frame
};

class TrueFieldTransfer : public Transfer {
public:
    explicit TrueFieldTransfer(std::span<const LessonPointer> lessons) : lessons_(lessons.begin(), lessons.end()) {}
    [[nodiscard]] geometry::DisplacementField on(const PreparedTarget& target) const override {
        const auto& material = target.material_points();
        auto result = geometry::DisplacementField::still(target.surface().size());
        result.answered = target.surface().present;
        const auto count = static_cast<double>(lessons_.size());
        for (const auto& lesson : lessons_) {
            const auto& field_mm = dynamic_cast<const TrueFieldLesson&>(*lesson).field_mm();
            for (std::size_t v = 0; v < result.size(); ++v)
                if (result.answered[v]) result.mm[v] += material.at(field_mm, v) / count;
        }
        return result;
    }

private:
    std::vector<LessonPointer> lessons_;
};

class TrueFieldLearner : public Learner {
public:
    [[nodiscard]] LessonPointer study(const modeling::Performance& performance) const override {
        if (!performance.true_expression)
            throw InputError(fmt::format("{}: its true motion is not known; take a database of 'mimik synthesize'",
                                         performance.expressive.id.name()));
        auto field_mm = performance.true_expression->displacement_mm;
        field_mm.shrink_to_fit();  // it was read without knowing its length
        return std::make_shared<const TrueFieldLesson>(std::move(field_mm));
    }
    [[nodiscard]] std::unique_ptr<const Transfer> learn(std::span<const LessonPointer> lessons) const override {
        return std::make_unique<TrueFieldTransfer>(lessons);
    }
};

}  // namespace

std::unique_ptr<const Learner> TrueFieldMethod::learner(const LearningTask&) const {
    return std::make_unique<TrueFieldLearner>();
}

}  // namespace mimik::animation
