#include "synthesis/posed_expression.h"

#include <algorithm>
#include <cctype>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "database/scan_id.h"

namespace mimik::synthesis {
namespace {

/// Shapes without side stand for both sides ("mouthSmile" = mouthSmile_L and mouthSmile_R) where the shape has sides.
struct ActionUnit {
    int number;
    std::vector<ShapeWeight> main_shapes;
    std::vector<ShapeWeight> co_activated;
};

// Main shapes after the authors' own list of ICT-FaceKit, except AU10 (the geometry of mouthUpperUp fits it, that of
// mouthShrugUpper is the upper lip's share of AU17). Weights: a posed smile reaches 0.70 of the scanned maximum, single
// small muscles 0.80 to 0.95.
const std::vector<ActionUnit>& action_units() {
    static const std::vector<ActionUnit> units = {
        {1, {{"browInnerUp", .90}}, {{"browOuterUp", .15, .09}, {"eyeWide", .10, .07}}},
        {2, {{"browOuterUp", .90}}, {{"browInnerUp", .18, .10}, {"eyeWide", .12, .07}}},
        {4, {{"browDown", .95}}, {{"eyeSquint", .20, .10}, {"noseSneer", .06, .06}}},
        {5, {{"eyeWide", .90}}, {{"browInnerUp", .10, .07}, {"browOuterUp", .08, .06}}},
        {6, {{"cheekSquint", .90}}, {{"eyeSquint", .15, .08}, {"mouthSmile", .08, .06}}},
        {7, {{"eyeSquint", .90}}, {{"cheekSquint", .12, .08}, {"browDown", .08, .06}}},
        {9, {{"noseSneer", .90}}, {{"browDown", .15, .08}, {"mouthUpperUp", .12, .08}, {"cheekSquint", .10, .06}}},
        {10, {{"mouthUpperUp", .85}}, {{"noseSneer", .15, .08}, {"cheekSquint", .08, .06}}},
        {12, {{"mouthSmile", .70}}, {{"cheekSquint", .20, .12}, {"mouthDimple", .10, .08}, {"mouthStretch", .06, .06}}},
        {14, {{"mouthDimple", .90}}, {{"mouthPress", .14, .08}, {"mouthSmile", .08, .06}, {"mouthStretch", .06, .06}}},
        {15,
         {{"mouthFrown", .90}},
         {{"mouthShrugLower", .14, .08}, {"mouthStretch", .10, .07}, {"browDown", .06, .06}}},
        {16, {{"mouthLowerDown", .90}}, {{"mouthStretch", .10, .07}, {"mouthFrown", .06, .06}}},
        {17,
         {{"mouthShrugLower", .85}, {"mouthShrugUpper", .35}},
         {{"mouthFrown", .15, .08}, {"mouthPress", .10, .07}, {"browDown", .06, .06}}},
        {18, {{"mouthPucker", .85}}, {{"mouthFunnel", .10, .08}, {"mouthShrugUpper", .06, .06}}},
        {20,
         {{"mouthStretch", .90}},
         {{"mouthFrown", .12, .08}, {"mouthLowerDown", .12, .08}, {"mouthDimple", .08, .06}}},
        {22, {{"mouthFunnel", .80}}, {{"mouthPucker", .15, .08}, {"mouthShrugUpper", .06, .06}}},
        {23,
         {{"mouthPress", .50}, {"mouthRollLower", .20}, {"mouthRollUpper", .20}},
         {{"mouthPucker", .08, .06}, {"mouthShrugLower", .06, .06}}},
        {24, {{"mouthPress", .90}}, {{"mouthShrugLower", .12, .08}, {"mouthDimple", .08, .06}}},
        {25, {{"mouthLowerDown", .35}, {"mouthUpperUp", .25}}, {{"mouthSmile", .06, .06}, {"mouthStretch", .06, .06}}},
        {26, {{"jawOpen", .35}}, {{"mouthLowerDown", .08, .06}, {"mouthStretch", .06, .06}}},
        {27, {{"jawOpen", .80}}, {{"mouthStretch", .10, .07}, {"browInnerUp", .08, .06}}},
        {28,
         {{"mouthRollLower", .80}, {"mouthRollUpper", .80}},
         {{"mouthShrugLower", .12, .07}, {"mouthPress", .10, .07}}},
        {29, {{"jawForward", .85}}, {{"mouthLowerDown", .08, .06}, {"mouthShrugLower", .06, .06}}},
        {30, {{"jaw", .85}}, {{"mouthStretch", .08, .06}, {"mouthFrown", .06, .06}}},
        {34, {{"cheekPuff", .80}}, {{"mouthPress", .15, .08}, {"mouthPucker", .08, .06}}},
        {41, {{"eyeBlink", .40}}, {{"eyeSquint", .06, .06}}},
        {42, {{"eyeBlink", .75}}, {{"eyeSquint", .12, .08}, {"cheekSquint", .06, .06}}},
        {43, {{"eyeBlink", .95}}, {{"eyeSquint", .10, .07}, {"cheekSquint", .06, .06}}},
        {44, {{"eyeSquint", .85}, {"eyeBlink", .35}}, {{"cheekSquint", .15, .08}, {"browDown", .10, .07}}},
        {45, {{"eyeBlink", .95}}, {{"eyeSquint", .10, .07}, {"cheekSquint", .06, .06}}},
        {46, {{"eyeBlink", .95}}, {{"eyeSquint", .15, .08}, {"cheekSquint", .12, .08}}},
    };
    return units;
}

struct Emotion {
    std::string_view code;
    std::map<int, double> strengths;
};

// Table 3-3 of the thesis (p. 37); the same strengths where an AU is in both sets.
const std::vector<Emotion>& thesis_emotions() {
    static const std::vector<Emotion> all = {
        {"ANGER", {{4, 1.0}, {5, .3}, {7, .6}, {23, .9}, {25, .5}}},
        {"DISGUST", {{9, .8}, {17, .6}}},
        {"FEAR", {{1, .8}, {2, .5}, {4, .6}, {5, .8}, {20, .7}, {27, .6}}},
        {"HAPPY", {{6, .7}, {12, 1.0}}},
        {"SADNESS", {{1, .8}, {4, .5}, {15, .9}}},
        {"SURPRISE", {{1, .9}, {2, .9}, {5, .7}, {26, 1.0}}},
    };
    return all;
}

// Prototypes of the FACS manual and EMFACS; strengths so that no single part outshines its action unit.
const std::vector<Emotion>& emotions(std::string_view set = "emfacs") {
    if (set == "thesis") return thesis_emotions();
    static const std::vector<Emotion> all = {
        {"ANGER", {{4, 1.0}, {5, .3}, {7, .6}, {23, .9}}},
        {"DISGUST", {{9, .8}, {10, .6}, {17, .5}}},
        {"FEAR", {{1, .8}, {2, .5}, {4, .6}, {5, .8}, {20, .7}, {25, .7}}},
        {"HAPPY", {{6, .7}, {12, 1.0}, {25, .6}}},
        {"SADNESS", {{1, .8}, {4, .5}, {15, .9}}},
        {"SURPRISE", {{1, .9}, {2, .9}, {5, .7}, {26, 1.0}}},
    };
    return all;
}

bool has_sides(const std::string& shape) {
    static const std::set<std::string> central = {"mouthShrugLower", "mouthShrugUpper", "mouthPucker",    "mouthFunnel",
                                                  "jawOpen",         "mouthRollLower",  "mouthRollUpper", "jawForward",
                                                  "jawLeft",         "jawRight"};
    return !central.contains(shape);
}

/// Adds a shape (both sides, or one) to a list in which each shape stands once.
void add(std::vector<ShapeWeight>& list, const ShapeWeight& part, double strength, facs::Side side) {
    const auto put = [&](const std::string& name) {
        const auto found = std::find_if(list.begin(), list.end(), [&](const auto& w) { return w.shape == name; });
        if (found == list.end()) {
            list.push_back({name, strength * part.weight, strength * part.deviation});
        } else {
            found->weight += strength * part.weight;
            found->deviation = std::hypot(found->deviation, strength * part.deviation);
        }
    };
    if (part.shape == "jaw") return put(side == facs::Side::left ? "jawLeft" : "jawRight");
    if (!has_sides(part.shape)) return put(part.shape);
    if (side != facs::Side::right) put(part.shape + "_L");
    if (side != facs::Side::left) put(part.shape + "_R");
}

const std::string& known_codes() {
    static const std::string text = [] {
        std::vector<std::string> codes;
        for (const auto& unit : action_units()) codes.push_back(std::to_string(unit.number));
        for (const auto& emotion : emotions()) codes.emplace_back(emotion.code);
        return fmt::format("{}; L or R behind an AU for one side", fmt::join(codes, " "));
    }();
    return text;
}

/// "1 2" and "1-2" would be read as 12.
bool several_numbers(std::string_view text) {
    const auto digit = [](unsigned char c) { return std::isdigit(c) != 0; };
    const auto* begin = std::find_if(text.begin(), text.end(), digit);
    const auto* end = std::find_if_not(begin, text.end(), digit);
    return std::any_of(end, text.end(), digit);
}

}  // namespace

bool is_emotion_set(std::string_view name) { return name == "emfacs" || name == "thesis"; }

PosedExpression make_expression(std::string_view text, std::string_view set) {
    const auto parsed = facs::parse_expression(text);
    const auto code = parsed && !several_numbers(text) ? parsed->code() : std::string(text);
    PosedExpression expression;
    expression.code = code;
    if (code == "N") {
        expression.group = "N";
        return expression;
    }
    for (const auto& emotion : emotions(set)) {
        if (code != emotion.code) continue;
        expression.group = "E";
        expression.action_units = emotion.strengths;
        for (const auto& entry : emotion.strengths) {
            const auto unit = std::find_if(action_units().begin(), action_units().end(),
                                           [&](const auto& u) { return u.number == entry.first; });
            for (const auto& part : unit->main_shapes)
                add(expression.main_shapes, part, entry.second, facs::Side::both);
        }
        // Two shapes beyond the prototype, as with single action units.
        const auto unit = std::find_if(action_units().begin(), action_units().end(), [&](const auto& u) {
            return u.number ==
                   std::max_element(emotion.strengths.begin(), emotion.strengths.end(), [](auto& a, auto& b) {
                       return a.second < b.second;
                   })->first;
        });
        for (const auto& part : unit->co_activated) add(expression.co_activated, part, 1.0, facs::Side::both);
        return expression;
    }
    const database::ScanId id{"", "LFAU", code, 0};
    const auto number = id.action_unit();
    const auto unit = std::find_if(action_units().begin(), action_units().end(),
                                   [&](const auto& u) { return number && u.number == *number; });
    if (unit == action_units().end() || id.low_intensity())
        throw InputError(fmt::format("expression '{}' is not known; there are: {}", text, known_codes()));
    if (id.side() != facs::Side::both && !has_sides(unit->main_shapes.front().shape))
        throw InputError(fmt::format("expression '{}': AU{} moves the whole mouth and has no sides", text, *number));
    if (unit->main_shapes.front().shape == "jaw" && id.side() == facs::Side::both)
        throw InputError(
            fmt::format("expression '{}': the jaw moves to one side; give {}L or {}R", text, *number, *number));
    expression.group = facs::group_of_action_unit(*number);
    expression.action_units[*number] = 1.0;
    for (const auto& part : unit->main_shapes) add(expression.main_shapes, part, 1.0, id.side());
    for (const auto& part : unit->co_activated) add(expression.co_activated, part, 1.0, id.side());
    return expression;
}

std::vector<PosedExpression> make_expressions(std::string_view list, std::string_view emotion_set) {
    static const std::map<std::string_view, std::string_view> groups = {
        {"thesis", "1,2,4,12,14,15,17,20,12L,12R"},
        {"emotions", "ANGER,DISGUST,FEAR,HAPPY,SADNESS,SURPRISE"},
        {"further", "5,6,7,9,10,16,18,22,23,24,25,26,27,28,34,43"},
        {"all", "thesis,emotions,further"}};
    std::vector<PosedExpression> expressions;
    const auto append = [&](const auto& self, std::string_view text) -> void {
        while (!text.empty()) {
            const auto comma = text.find(',');
            const std::string_view word = text.substr(0, comma);
            text = comma == std::string_view::npos ? std::string_view{} : text.substr(comma + 1);
            if (word.empty()) continue;
            if (const auto group = groups.find(word); group != groups.end()) {
                self(self, group->second);
                continue;
            }
            PosedExpression made = make_expression(word, emotion_set);
            const bool there = std::any_of(expressions.begin(), expressions.end(), [&](const PosedExpression& e) {
                return e.group == made.group && e.code == made.code;
            });
            if (!there && made.group != "N") expressions.push_back(std::move(made));
        }
    };
    append(append, list);
    return expressions;
}

std::vector<std::string> missing_shapes(const PosedExpression& expression, const FaceModel& model) {
    const auto there = model.shapes();
    std::vector<std::string> missing;
    for (const auto& part : expression.main_shapes)
        if (std::find(there.begin(), there.end(), part.shape) == there.end()) missing.push_back(part.shape);
    return missing;
}

}  // namespace mimik::synthesis
