#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "animation/method.h"
#include "preprocessing/face_template.h"

namespace mimik::animation {

/// An expression of one source on the template: average frame of the source, magnitude 1.
struct TemplateExpression {
    std::vector<geometry::Point> rest_mm;     ///< the template on its neutral face
    std::vector<geometry::Vector> motion_mm;  ///< per vertex
    double average_scale = 1.0;               ///< average frame's mm per mm of the source's scanner
};

/// A target as the template sees it.
struct TemplateTarget {
    const PreparedTarget& face;
    std::span<const geometry::Point> rest_mm;  ///< the template on its neutral face, average frame of the target
    double average_scale = 1.0;                ///< average frame's mm per mm of the target
};

/// How a motion of the template on one face becomes one on another. Of one template. From any thread.
class TemplateTransfer {
public:
    virtual ~TemplateTransfer() = default;
    /// @return per vertex, average frame of the target
    [[nodiscard]] virtual std::vector<geometry::Vector> motion(const TemplateExpression& source,
                                                               const TemplateTarget& target) const = 0;
};

/// Methods whose source and target are both given by the template that is bent on to their scans (dense
/// correspondence), and that differ in how its motion is carried from one to the other. Of several sources the results
/// are averaged. The target's vertices move as dense_field() says; lids do not slide, which no paper says.
class TemplateMethod : public Method {
public:
    struct Setting {
        std::string name, summary;
        SourceKind needs = SourceKind::one_source;
        MethodGroup group = MethodGroup::published;
        std::function<std::shared_ptr<const TemplateTransfer>(const preprocessing::FaceTemplate&)> make;
    };
    explicit TemplateMethod(Setting setting) : setting_(std::move(setting)) {}

    [[nodiscard]] std::string name() const override { return setting_.name; }
    [[nodiscard]] std::string summary() const override { return setting_.summary; }
    [[nodiscard]] MethodGroup group() const override { return setting_.group; }
    [[nodiscard]] SourceKind needs() const override { return setting_.needs; }
    [[nodiscard]] std::string lessons_key() const override { return "template"; }
    [[nodiscard]] std::unique_ptr<const Learner> learner(const LearningTask& task) const override;

private:
    Setting setting_;
};

/// Sumner and Popovic 2004 on the template: the rim, where the template ends on temples, neck and forehead, goes where
/// the source's rim goes (in the average frame), which says where the face is; the cut between the lips is free.
[[nodiscard]] std::shared_ptr<const TemplateTransfer> deformation_transfer(
    const preprocessing::FaceTemplate& face_template);

}  // namespace mimik::animation
