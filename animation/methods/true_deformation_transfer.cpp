#include <numeric>

#include <fmt/format.h>

#include "animation/method.h"
#include "base/errors.h"
#include "geometry/deformation_transfer.h"

namespace mimik::animation::methods {
namespace {

using geometry::Point;
using geometry::Vector;

/// Every vertex of the true surface is tied to the source's motion, so weakly that it says where each piece (skin, each
/// eyeball) is as a whole, and next to nothing of its shape.
constexpr double anchor_weight = 1e-4;

/// A source's true neutral surface and motion, head frame.
class TrueLesson : public Lesson {
public:
    TrueLesson(std::vector<Point> rest_mm, std::vector<Vector> motion_mm)
        : rest_mm_(std::move(rest_mm)), motion_mm_(std::move(motion_mm)) {}
    [[nodiscard]] std::size_t bytes() const override { return 2 * rest_mm_.size() * sizeof(Vector); }
    [[nodiscard]] const std::vector<Point>& rest_mm() const { return rest_mm_; }
    [[nodiscard]] const std::vector<Vector>& motion_mm() const { return motion_mm_; }

private:
    std::vector<Point> rest_mm_;
    std::vector<Vector> motion_mm_;
};

std::vector<Point> in_head_frame(const database::TrueScan& scan) {
    const auto head_from_scanner = scan.scanner_from_head.inverse(Eigen::Isometry);
    std::vector<Point> points;
    points.reserve(scan.vertices_mm.size());
    for (const auto& p : scan.vertices_mm) points.push_back(head_from_scanner * p);
    return points;
}

/// The true surface of a target, factorised.
struct TrueTarget {
    geometry::DeformationTransferMesh mesh;
    geometry::DeformationTransfer transfer;
};

std::shared_ptr<const void> factorised(const database::TrueScan& truth) {
    std::vector<std::uint32_t> all(truth.vertices_mm.size());
    std::iota(all.begin(), all.end(), 0U);
    const geometry::DeformationTransferMesh mesh(all.size(), geometry::triangulate(truth.faces), all,
                                                 {.anchor_weight = anchor_weight});
    return std::make_shared<const TrueTarget>(
        TrueTarget{mesh, geometry::DeformationTransfer(mesh, in_head_frame(truth))});
}

class TrueTransfer : public Transfer {
public:
    TrueTransfer(LessonPointer lesson, std::shared_ptr<const int> owner)
        : lesson_(std::move(lesson)), owner_(std::move(owner)) {}
    [[nodiscard]] geometry::DisplacementField on(const PreparedTarget& target) const override {
        const auto& material = target.material_points();
        const auto kept = target.kept(owner_, [&] { return factorised(*target.truth()); });
        const auto& [mesh, transfer] = *static_cast<const TrueTarget*>(kept.get());
        const auto& lesson = dynamic_cast<const TrueLesson&>(*lesson_);
        const auto motion =
            transfer.motion(geometry::deformation_gradients(lesson.rest_mm(), lesson.motion_mm(), mesh.triangles()),
                            lesson.motion_mm());
        auto field = geometry::DisplacementField::still(target.surface().size());
        field.answered = target.surface().present;
        for (std::size_t v = 0; v < field.size(); ++v)
            if (field.answered[v]) field.mm[v] = material.at(motion, v);
        return field;
    }

private:
    LessonPointer lesson_;
    std::shared_ptr<const int> owner_;
};

class TrueLearner : public Learner {
public:
    [[nodiscard]] LessonPointer study(const modeling::Performance& performance) const override {
        if (!performance.true_neutral || !performance.true_expression)
            throw InputError(fmt::format("{}: its true motion is not known; take a database of 'mimik synthesize'",
                                         performance.expressive.id.name()));
        return std::make_shared<const TrueLesson>(in_head_frame(*performance.true_neutral),
                                                  performance.true_expression->displacement_mm);
    }
    [[nodiscard]] std::unique_ptr<const Transfer> learn(std::span<const LessonPointer> lessons) const override {
        return std::make_unique<TrueTransfer>(lessons.front(), owner_);
    }

private:
    std::shared_ptr<const int> owner_ = std::make_shared<const int>(0);  // of the factors that targets keep
};

/// Deformation transfer between true surfaces, whose vertices correspond: what its template costs it.
class TrueDeformationTransfer : public Method {
public:
    [[nodiscard]] std::string name() const override { return "true-deformation-transfer"; }
    [[nodiscard]] std::string summary() const override { return "Deformation transfer in true correspondence"; }
    [[nodiscard]] MethodGroup group() const override { return MethodGroup::bound; }
    [[nodiscard]] SourceKind needs() const override { return SourceKind::one_source; }
    [[nodiscard]] bool needs_truth() const override { return true; }
    [[nodiscard]] std::unique_ptr<const Learner> learner(const LearningTask&) const override {
        return std::make_unique<TrueLearner>();
    }
};

}  // namespace

MethodPointer true_deformation_transfer_method() { return std::make_shared<TrueDeformationTransfer>(); }

}  // namespace mimik::animation::methods
