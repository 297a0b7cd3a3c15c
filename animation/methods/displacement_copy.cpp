#include "animation/template_method.h"

namespace mimik::animation::methods {
namespace {

class Copy : public TemplateTransfer {
public:
    [[nodiscard]] std::vector<geometry::Vector> motion(const TemplateExpression& source,
                                                       const TemplateTarget& target) const override {
        auto motion = source.motion_mm;
        for (auto& way : motion) way *= target.average_scale / source.average_scale;
        return motion;
    }
};

}  // namespace

/// The source's millimetres on the target, whatever the size of both: heads are turned alike, nothing else is done.
MethodPointer displacement_copy_method() {
    return std::make_shared<TemplateMethod>(TemplateMethod::Setting{
        .name = "displacement-copy",
        .summary = "The source's millimetres, vertex by vertex, neither turned nor scaled",
        .needs = SourceKind::one_source,
        .group = MethodGroup::simple,
        .make = [](const preprocessing::FaceTemplate&) { return std::make_shared<const Copy>(); }});
}

}  // namespace mimik::animation::methods
