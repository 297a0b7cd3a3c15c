#include "builtin/unit_fields.h"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "animation/animate.h"
#include "modeling/template_motion.h"

namespace mimik::builtin {

animation::UnitFields unit_fields(const BuiltinExpressions& expressions, const facs::FacsCatalogue& catalogue,
                                  const animation::PreparedTarget& target) {
    animation::UnitFields fields;
    const auto add = [&](const modeling::ExpressionModel& model) {
        fields.names.push_back(model.expression.name());
        fields.fields_mm.push_back(animation::expression_field(target, model, {}).mm);
    };
    for (const char* code : {"1",  "2",  "4",  "5",  "6",  "7",  "9",  "10", "12", "14", "15", "16",  "17",
                             "18", "20", "22", "23", "24", "25", "27", "28", "29", "34", "43", "30L", "30R"}) {
        const auto expression = catalogue.find_expression(code);
        if (!expression || !expressions.shows(*expression)) continue;
        auto both = expressions.model(catalogue, *expression);
        const auto left = catalogue.find_expression(std::string(code) + "L");
        const auto right = catalogue.find_expression(std::string(code) + "R");
        if (!left || !right || !both.dense || !expressions.shows(*left)) {
            add(both);
            continue;
        }
        for (const auto& side : {*left, *right}) {
            auto one = both;
            one.expression = side;
            modeling::keep_side(*one.dense, side);
            add(one);
        }
    }
    return fields;
}

}  // namespace mimik::builtin
