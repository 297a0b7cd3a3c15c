#include "animation/template_method.h"

#include <algorithm>
#include <cmath>

#include "animation/dense_field.h"
#include "geometry/deformation_transfer.h"
#include "geometry/topology.h"
#include "modeling/template_motion.h"
#include "preprocessing/kept_registrations.h"

namespace mimik::animation {

using geometry::Vector;
using modeling::Normalisation;
using preprocessing::FaceTemplate;
using preprocessing::KeptRegistrations;

namespace {

/// Lengths in the average frame per length in the scan's.
double scale_of(const geometry::Transform& average_from_scan) {
    return std::cbrt(std::abs(average_from_scan.linear().determinant()));
}

class TemplateLesson : public Lesson {
public:
    explicit TemplateLesson(TemplateExpression expression) : expression_(std::move(expression)) {}
    [[nodiscard]] std::size_t bytes() const override { return 2 * expression_.rest_mm.size() * sizeof(Vector); }
    [[nodiscard]] const TemplateExpression& expression() const { return expression_; }

private:
    TemplateExpression expression_;
};

class LearnedTransfer : public Transfer {
public:
    LearnedTransfer(std::span<const LessonPointer> lessons, std::shared_ptr<const KeptRegistrations> registrations,
                    std::shared_ptr<const TemplateTransfer> transfer)
        : lessons_(lessons.begin(), lessons.end()),
          registrations_(std::move(registrations)),
          transfer_(std::move(transfer)) {}

    [[nodiscard]] geometry::DisplacementField on(const PreparedTarget& target) const override {
        const TemplateTarget bent{target, template_on(target, registrations_),
                                  scale_of(target.average_from_target(Normalisation::similarity))};
        modeling::TemplateMotion mean{registrations_, std::vector<Vector>(bent.rest_mm.size(), Vector::Zero())};
        for (const auto& lesson : lessons_) {
            const auto motion = transfer_->motion(dynamic_cast<const TemplateLesson&>(*lesson).expression(), bent);
            for (std::size_t v = 0; v < motion.size(); ++v)
                mean.motion_mm[v] += motion[v] / static_cast<double>(lessons_.size());
        }
        return dense_field(target, mean);
    }
    [[nodiscard]] std::vector<preprocessing::LipSide> lip_sides(const PreparedTarget& target) const override {
        return animation::lip_sides(target, {registrations_, {}});
    }

private:
    std::vector<LessonPointer> lessons_;
    std::shared_ptr<const KeptRegistrations> registrations_;
    std::shared_ptr<const TemplateTransfer> transfer_;
};

class TemplateLearner : public Learner {
public:
    TemplateLearner(const LearningTask& task, const TemplateMethod::Setting& setting)
        : expression_(task.expression),
          registrations_(task.registrations ? task.registrations
                                            : std::make_shared<const KeptRegistrations>(task.average)),
          transfer_(setting.make(registrations_->face_template())) {}

    [[nodiscard]] LessonPointer study(const modeling::Performance& performance) const override {
        const auto& neutral = performance.neutral;
        const auto& expressive = performance.expressive;
        modeling::TemplateMotion dense{registrations_, registrations_->motion(neutral, expressive).motion_mm};
        if (expressive.id.side() == facs::Side::both) keep_side(dense, expression_);
        return std::make_shared<const TemplateLesson>(TemplateExpression{registrations_->neutral(neutral).vertices_mm,
                                                                         std::move(dense.motion_mm),
                                                                         scale_of(neutral.average_from_scan)});
    }
    [[nodiscard]] std::unique_ptr<const Transfer> learn(std::span<const LessonPointer> lessons) const override {
        return std::make_unique<LearnedTransfer>(lessons, registrations_, transfer_);
    }

private:
    const facs::Expression& expression_;
    std::shared_ptr<const KeptRegistrations> registrations_;
    std::shared_ptr<const TemplateTransfer> transfer_;
};

/// Vertices where the template ends, but for the cut between the lips.
std::vector<std::uint32_t> rim_of(const FaceTemplate& face_template) {
    std::vector<std::uint32_t> rim;
    for (const auto& edge : geometry::border_edges(face_template.surface.triangles))
        rim.insert(rim.end(), edge.begin(), edge.end());
    std::sort(rim.begin(), rim.end());
    rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
    for (const auto* line : {&face_template.upper_lip_line, &face_template.lower_lip_line})
        for (const auto v : *line) std::erase(rim, v);
    return rim;
}

class GradientTransfer : public TemplateTransfer, public std::enable_shared_from_this<GradientTransfer> {
public:
    explicit GradientTransfer(const FaceTemplate& face_template)
        : mesh_(face_template.size(), face_template.surface.triangles, rim_of(face_template)) {}

    [[nodiscard]] std::vector<Vector> motion(const TemplateExpression& source,
                                             const TemplateTarget& target) const override {
        const auto kept = target.face.kept(shared_from_this(), [&]() -> std::shared_ptr<const void> {
            return std::make_shared<const geometry::DeformationTransfer>(mesh_, target.rest_mm);
        });
        std::vector<Vector> rim_mm;
        for (const auto v : mesh_.anchors()) rim_mm.push_back(source.motion_mm[v]);
        return static_cast<const geometry::DeformationTransfer*>(kept.get())
            ->motion(geometry::deformation_gradients(source.rest_mm, source.motion_mm, mesh_.triangles()), rim_mm);
    }

private:
    geometry::DeformationTransferMesh mesh_;
};

}  // namespace

std::unique_ptr<const Learner> TemplateMethod::learner(const LearningTask& task) const {
    return std::make_unique<TemplateLearner>(task, setting_);
}

std::shared_ptr<const TemplateTransfer> deformation_transfer(const FaceTemplate& face_template) {
    return std::make_shared<const GradientTransfer>(face_template);
}

}  // namespace mimik::animation
