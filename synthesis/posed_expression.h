#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "synthesis/face_model.h"

namespace mimik::synthesis {

/// One elementary motion in an expression.
struct ShapeWeight {
    std::string shape;     ///< "mouthSmile_L"
    double weight = 0;     ///< 1 = the shape at full strength
    double deviation = 0;  ///< standard deviation of the weight from performance to performance; 0: a main shape
};

/// An action unit, a one-sided one or an emotion as a person is asked to pose it.
struct PosedExpression {
    std::string group;                     ///< "LFAU", "UFAU", "E"; the neutral face has group and code "N"
    std::string code;                      ///< "12", "12L", "HAPPY"; sides are the subject's own
    std::vector<ShapeWeight> main_shapes;  ///< what the action unit is
    /// What moves with it in untrained people: 2 to 4 shapes of 6-20 % +- 6-12 %.
    std::vector<ShapeWeight> co_activated;
    std::map<int, double> action_units;  ///< AU -> strength; what an expert would score
};

/// As facs::parse_expression reads it, in any case: "12", "AU12_L", "LFAU_12L", "HAPPY", "E_ANGER".
/// @throws InputError listing the codes there are.
/// @param emotions  the set of prototypes: "emfacs", or "thesis" (its Table 3-3)
[[nodiscard]] PosedExpression make_expression(std::string_view code, std::string_view emotions = "emfacs");

/// "thesis" = AUs 1 2 4 12 14 15 17 20, 12L, 12R; "emotions"; "further" = AUs 5 6 7 9 10 16 18 22-28 34 43; "all"; or a
/// single code. Commas separate; each expression once, in the order asked for.
[[nodiscard]] std::vector<PosedExpression> make_expressions(std::string_view list,
                                                            std::string_view emotions = "emfacs");
[[nodiscard]] bool is_emotion_set(std::string_view name);

/// Main shapes of the expression that the model lacks; an expression with such a shape cannot be made.
[[nodiscard]] std::vector<std::string> missing_shapes(const PosedExpression& expression, const FaceModel& model);

}  // namespace mimik::synthesis
