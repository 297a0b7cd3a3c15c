#include "geometry/expression_cloning.h"

#include "animation/template_method.h"

namespace mimik::animation::methods {
namespace {

class ExpressionCloning : public TemplateTransfer {
public:
    explicit ExpressionCloning(const preprocessing::FaceTemplate& face_template)
        : triangles_(face_template.surface.triangles) {}
    [[nodiscard]] std::vector<geometry::Vector> motion(const TemplateExpression& source,
                                                       const TemplateTarget& target) const override {
        return geometry::cloned_motion(source.rest_mm, source.motion_mm, target.rest_mm, triangles_);
    }

private:
    std::vector<geometry::Triangle> triangles_;
};

}  // namespace

/// Noh and Neumann 2001, sections 4.1 and 4.2. The dense correspondence is the template's, in the place of the paper's
/// radial basis functions and cylindrical projection.
MethodPointer expression_cloning_method() {
    return std::make_shared<TemplateMethod>(
        TemplateMethod::Setting{.name = "expression-cloning",
                                .summary = "Expression cloning (Noh and Neumann 2001) on the template",
                                .needs = SourceKind::one_source,
                                .group = MethodGroup::published,
                                .make = [](const preprocessing::FaceTemplate& made) {
                                    return std::make_shared<const ExpressionCloning>(made);
                                }});
}

}  // namespace mimik::animation::methods
