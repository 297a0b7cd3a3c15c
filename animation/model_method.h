#pragma once

#include <string>

#include "animation/animate.h"
#include "animation/method.h"
#include "modeling/expression_model.h"

namespace mimik::animation {

/// Models of an expression (modeling/expression_model.h): control points and thin-plate splines, the thesis's way, or
/// a template's dense motion. The options say which.
class ModelMethod : public Method {
public:
    struct Setting {
        std::string name;
        SourceKind needs = SourceKind::one_source;
        modeling::ModelOptions model;
        AnimationOptions animation;
        std::string summary = {};  ///< one sentence; empty: the name
        MethodGroup group = MethodGroup::usual;
        /// Of its own points, in the place of the task's; null: the task's.
        const facs::FacsCatalogue& (*catalogue)() = nullptr;
    };
    /// The equations of the thesis, from one source: what its variants change.
    [[nodiscard]] static Setting thesis(std::string name, std::string summary);
    /// @throws InputError for bad options, or a mean whose points do not stand on the average face.
    explicit ModelMethod(Setting setting);

    [[nodiscard]] std::string name() const override { return setting_.name; }
    [[nodiscard]] std::string summary() const override {
        return setting_.summary.empty() ? setting_.name : setting_.summary;
    }
    [[nodiscard]] MethodGroup group() const override { return setting_.group; }
    [[nodiscard]] SourceKind needs() const override { return setting_.needs; }
    [[nodiscard]] std::string lessons_key() const override;
    [[nodiscard]] std::unique_ptr<const Learner> learner(const LearningTask& task) const override;

    /// Whose points it takes where nobody names a catalogue.
    [[nodiscard]] const facs::FacsCatalogue& catalogue() const {
        return setting_.catalogue ? setting_.catalogue() : facs::builtin_catalogue();
    }
    [[nodiscard]] const modeling::ModelOptions& model_options() const { return setting_.model; }
    [[nodiscard]] const AnimationOptions& animation_options() const { return setting_.animation; }

private:
    Setting setting_;
};

}  // namespace mimik::animation
