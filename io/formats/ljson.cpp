#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "io/formats/landmark_formats.h"
#include "io/json_values.h"

namespace mimik::io::formats {

using geometry::Point;

namespace {

using Json = nlohmann::json;

constexpr JsonLimits ljson_limits = {.most_values = 1'000'000};

const Json& list_of(const Json& object, const char* key, const std::string& where) {
    const auto it = object.is_object() ? object.find(key) : object.end();
    if (!object.is_object() || it == object.end() || !it->is_array())
        throw InputError(fmt::format("{} has no list '{}'; it is no menpo .ljson file", where, key));
    return *it;
}

std::string text_of(const Json& object, const char* key, std::string otherwise) {
    if (!object.is_object()) return otherwise;
    const auto it = object.find(key);
    return it != object.end() && it->is_string() ? it->get<std::string>() : otherwise;
}

/// Adds a point; one of nulls was not marked and is left out.
void add_point(RawLandmarks& raw, const std::string& label, const Json& point, const std::string& where,
               const std::string& name) {
    const auto described = fmt::format("{} ({})", where, base::in_quotes(label));
    if (!point.is_array() || point.size() != 3)
        throw InputError(fmt::format("{} is not a list of 3 numbers{}", described,
                                     point.is_array() && point.size() == 2 ? ", but of 2: marks in an image" : ""));
    Point position;
    std::size_t nulls = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto& value = point[axis];
        nulls += value.is_null() ? 1 : 0;
        if (value.is_null()) continue;
        if (!value.is_number() || !std::isfinite(value.get<double>()))
            throw InputError(fmt::format("{}: {} is no finite number", described, "xyz"[axis]));
        position[static_cast<Eigen::Index>(axis)] = value.get<double>();
    }
    if (nulls == 0)
        add_mark(raw, label, position, name);
    else
        ++raw.unmarked;
}

/// Labels are groups of points: a label of one point is its name, one of several gets numbers. Of the labels that a
/// point has, the one with the fewest points says most.
std::vector<std::string> names_by_masks(const Json& labels, std::size_t points, const std::string& where) {
    std::vector<std::string> names(points);
    std::vector<std::size_t> size_of_label(points, points + 1);
    for (std::size_t l = 0; l < labels.size(); ++l) {
        const auto& mask = list_of(labels[l], "mask", fmt::format("{}: labels[{}]", where, l));
        const auto label = text_of(labels[l], "label", "");
        std::vector<std::size_t> of_label;
        for (std::size_t k = 0; k < mask.size(); ++k) {
            const bool is_member = mask[k].is_boolean() ? mask[k].get<bool>() : mask[k] == 1;
            if (is_member && k < points) of_label.push_back(k);
        }
        const auto members = of_label.size();
        for (std::size_t m = 0; m < members; ++m) {
            const auto k = of_label[m];
            if (label.empty() || members >= size_of_label[k]) continue;
            size_of_label[k] = members;
            names[k] = members == 1 ? label : fmt::format("{}_{}", label, m + 1);
        }
    }
    for (std::size_t k = 0; k < points; ++k)
        if (names[k].empty()) names[k] = std::to_string(k + 1);
    return names;
}

void add_version_2(RawLandmarks& raw, const Json& group, const std::string& where, const std::string& name) {
    const auto landmarks = group.find("landmarks");
    if (landmarks == group.end()) throw InputError(fmt::format("{} has no 'landmarks'; it is no .ljson file", where));
    const auto& points = list_of(*landmarks, "points", where + ": landmarks");
    const auto labels = group.find("labels");
    const auto names =
        names_by_masks(labels != group.end() && labels->is_array() ? *labels : Json::array(), points.size(), where);
    for (std::size_t k = 0; k < points.size(); ++k)
        add_point(raw, names[k], points[k], fmt::format("{}: points[{}]", where, k), name);
}

void add_version_1(RawLandmarks& raw, const Json& groups, const std::string& name) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const auto where = fmt::format("{}: groups[{}]", name, g);
        const auto& marks = list_of(groups[g], "landmarks", where);
        const auto label = text_of(groups[g], "label", std::to_string(g + 1));
        for (std::size_t k = 0; k < marks.size(); ++k) {
            const auto place = fmt::format("{}: landmarks[{}]", where, k);
            const auto& point = list_of(marks[k], "point", place);
            add_point(raw, marks.size() == 1 ? label : fmt::format("{}_{}", label, k + 1), point, place, name);
        }
    }
}

}  // namespace

RawLandmarks decode_ljson(std::string_view text, const std::string& name) {
    const auto json = parse_json(text, name, ljson_limits);
    if (!json.is_object()) throw InputError(fmt::format("{}: holds no JSON object; it is no .ljson file", name));
    RawLandmarks raw;
    const auto groups = json.find("groups");
    if (groups == json.end()) {
        add_version_2(raw, json, name, name);
    } else if (groups->is_array()) {
        add_version_1(raw, *groups, name);
    } else if (groups->is_object() && groups->size() == 1) {
        add_version_2(raw, groups->begin().value(),
                      fmt::format("{}: group {}", name, base::in_quotes(groups->begin().key())), name);
    } else {
        throw InputError(fmt::format("{}: 'groups' holds {} groups of landmarks; keep one in a file of its own", name,
                                     groups->size()));
    }
    return raw;
}

}  // namespace mimik::io::formats
