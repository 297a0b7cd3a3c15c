#include <array>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "io/formats/landmark_formats.h"
#include "io/formats/xml.h"

namespace mimik::io::formats {

using geometry::Landmarks;
using geometry::Point;

RawLandmarks decode_pp(std::string_view text, const std::string& name) {
    const auto document = parse_xml(text, name);
    const auto root = document->child("PickedPoints");
    if (!root) throw InputError(fmt::format("{}: has no element PickedPoints; it is not a MeshLab .pp file", name));
    RawLandmarks raw;
    for (const auto point : root.children("point")) {
        const auto active = point.attribute("active");
        if (active && std::string_view(active.value()) == "0") {
            ++raw.unmarked;
            continue;
        }
        const std::string_view label = base::trimmed(point.attribute("name").value());
        Point position;
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            constexpr std::array<const char*, 3> axes = {"x", "y", "z"};
            const auto* axis_name = axes[static_cast<std::size_t>(axis)];
            const auto attribute = point.attribute(axis_name);
            const auto value = base::parse_double(base::trimmed(attribute.value()));
            if (!value || !std::isfinite(*value))
                throw InputError(
                    fmt::format("{}: byte {}: point {}: {} is {}, not a finite number; pick the point again", name,
                                point.offset_debug(), base::in_quotes(label), axis_name,
                                attribute ? base::in_quotes(attribute.value()) : "missing"));
            position[axis] = *value;
        }
        add_mark(raw, label, position, name);
    }
    return raw;
}

std::string encode_pp(const Landmarks& landmarks) {
    pugi::xml_document document;
    document.append_child(pugi::node_doctype).set_value("PickedPoints");
    auto root = document.append_child("PickedPoints");
    for (const auto& mark : landmarks.all()) {
        auto point = root.append_child("point");
        const auto set = [&](const char* attribute, const std::string& value) {
            point.append_attribute(attribute).set_value(value.c_str());
        };
        set("x", fmt::format("{:.17g}", mark.position_mm.x()));
        set("y", fmt::format("{:.17g}", mark.position_mm.y()));
        set("z", fmt::format("{:.17g}", mark.position_mm.z()));
        set("name", mark.name);
        set("active", "1");
    }
    std::ostringstream out;
    document.save(out, " ", pugi::format_indent | pugi::format_no_declaration, pugi::encoding_utf8);
    return out.str();
}

}  // namespace mimik::io::formats
