#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/text.h"
#include "io/formats/landmark_formats.h"
#include "io/json_values.h"

namespace mimik::io::formats {

using geometry::Landmarks;
using geometry::Point;

namespace {

using Json = nlohmann::json;

// Slicer's own files have some 40 values per point.
constexpr JsonLimits slicer_limits = {.most_values = 1'000'000};

std::string text_of(const Json& object, const char* key, const std::string& otherwise) {
    const auto it = object.find(key);
    return it != object.end() && it->is_string() ? it->get<std::string>() : otherwise;
}

/// Where the fields of a point are. If no comment says so, as in Slicer 4.
struct FcsvColumns {
    std::size_t x = 1, y = 2, z = 3;
    std::optional<std::size_t> id = 0, label = 11;
};

FcsvColumns fcsv_columns(const base::LineReader& lines, std::string_view list, const std::string& name) {
    base::LineReader columns(list, name);
    std::vector<std::string> fields;
    if (columns.next()) base::split_csv_line(columns, fields);
    const auto find = [&](std::string_view column) -> std::optional<std::size_t> {
        for (std::size_t i = 0; i < fields.size(); ++i)
            if (base::equal_ignoring_case(fields[i], column)) return i;
        return std::nullopt;
    };
    const auto place = [&](std::string_view column) {
        if (const auto found = find(column)) return *found;
        lines.fail(fmt::format("the list of columns has no '{}'", column));
    };
    return {place("x"), place("y"), place("z"), find("id"), find("label")};
}

/// "# key = value" of a comment. Spreadsheets fill comments up with separators, too.
struct Comment {
    std::string_view key, value;
};

Comment comment_of(std::string_view line) {
    line.remove_prefix(1);
    const auto equals = line.find('=');
    if (equals == std::string_view::npos) return {};
    auto value = base::trimmed(line.substr(equals + 1));
    while (value.ends_with(',') || value.ends_with(';')) value = base::trimmed(value.substr(0, value.size() - 1));
    return {base::trimmed(line.substr(0, equals)), value};
}

}  // namespace

RawLandmarks decode_fcsv(std::string_view text, const std::string& name) {
    base::LineReader lines(text, name);
    RawLandmarks raw;
    raw.either_frame = true;
    std::vector<std::string> fields;
    FcsvColumns columns;
    while (lines.next_not_blank()) {
        const auto line = base::trimmed(lines.line());
        if (line.starts_with('#')) {
            const auto [key, value] = comment_of(line);
            try {
                if (base::equal_ignoring_case(key, "CoordinateSystem")) raw.frame = parse_body_frame(value);
            } catch (const InputError& e) {
                lines.fail(fmt::format("CoordinateSystem is {}", e.what()));
            }
            if (base::equal_ignoring_case(key, "columns")) columns = fcsv_columns(lines, value, name);
            continue;
        }
        base::split_csv_line(lines, fields);
        if (std::all_of(fields.begin(), fields.end(), [](const std::string& field) { return field.empty(); })) continue;
        const auto last = std::max({columns.x, columns.y, columns.z});
        if (fields.size() <= last)
            lines.fail(
                fmt::format("has {}; a point needs at least {}", base::counted(fields.size(), "field"), last + 1));
        const auto field = [&](std::optional<std::size_t> column) {
            return column && *column < fields.size() ? fields[*column] : std::string();
        };
        auto named = field(columns.label);
        if (named.empty()) named = field(columns.id);
        Point position;
        Eigen::Index axis = 0;
        for (const auto column : {columns.x, columns.y, columns.z}) {
            const auto value = base::parse_double(fields[column]);
            if (!value || !std::isfinite(*value))
                lines.fail(fmt::format("{} of point {} is {}, not a finite number; place the point again", "xyz"[axis],
                                       base::in_quotes(named), base::in_quotes(fields[column])));
            position[axis++] = *value;
        }
        add_mark(raw, named, position, name);
    }
    return raw;
}

RawLandmarks decode_mrk_json(std::string_view text, const std::string& name) {
    const auto json = parse_json(text, name, slicer_limits);
    if (!json.is_object() || !json.contains("markups") || !json["markups"].is_array() || json["markups"].empty() ||
        !json["markups"][0].is_object())
        throw InputError(fmt::format("{}: has no list 'markups'; it is not a Slicer .mrk.json file", name));
    if (json["markups"].size() > 1)
        throw InputError(fmt::format("{}: 'markups' holds {}; save each list of points to a file of its own", name,
                                     base::counted(json["markups"].size(), "list")));
    const auto& markup = json["markups"][0];
    RawLandmarks raw;
    raw.either_frame = true;
    const auto frame = markup.find("coordinateSystem");
    try {
        raw.frame = parse_body_frame(frame != markup.end() && frame->is_number_integer()
                                         ? frame->dump()
                                         : text_of(markup, "coordinateSystem", "LPS"));
    } catch (const InputError& e) {
        throw InputError(fmt::format("{}: coordinateSystem is {}", name, e.what()));
    }
    if (const auto unit = text_of(markup, "coordinateUnits", ""); !unit.empty()) {
        try {
            raw.unit = parse_length_unit(unit);
        } catch (const InputError& e) {
            throw InputError(fmt::format("{}: coordinateUnits: {}", name, e.what()));
        }
    }
    const auto points = markup.find("controlPoints");
    if (points == markup.end() || !points->is_array())
        throw InputError(fmt::format("{}: 'markups[0]' has no list 'controlPoints'", name));
    std::size_t index = 0;
    for (const auto& point : *points) {
        const auto where = fmt::format("{}: controlPoints[{}]", name, index++);
        if (!point.is_object()) throw InputError(fmt::format("{} is not an object", where));
        if (text_of(point, "positionStatus", "defined") != "defined") {
            ++raw.unmarked;
            continue;
        }
        auto label = text_of(point, "label", "");
        if (label.empty()) label = text_of(point, "id", "");
        const auto position = point.find("position");
        Point p;
        if (position == point.end() || !position->is_array() || position->size() != 3)
            throw InputError(
                fmt::format("{} ({}): position is not a list of 3 numbers", where, base::in_quotes(label)));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto& value = (*position)[axis];
            if (!value.is_number() || !std::isfinite(value.get<double>()))
                throw InputError(fmt::format("{} ({}): position[{}] is {}, not a finite number; place the point again",
                                             where, base::in_quotes(label), axis,
                                             base::in_quotes(value.is_number() ? "inf" : value.type_name())));
            p[static_cast<Eigen::Index>(axis)] = value.get<double>();
        }
        add_mark(raw, label, p, name);
    }
    return raw;
}

std::string encode_fcsv(const Landmarks& landmarks) {
    std::string text =
        "# Markups fiducial file version = 4.11\n# CoordinateSystem = LPS\n"
        "# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\n";
    std::size_t id = 1;
    for (const auto& mark : landmarks.all())
        fmt::format_to(std::back_inserter(text), "{},{:.17g},{:.17g},{:.17g},0,0,0,1,1,1,0,{},,\n", id++,
                       mark.position_mm.x(), mark.position_mm.y(), mark.position_mm.z(), base::csv_field(mark.name));
    return text;
}

std::string encode_mrk_json(const Landmarks& landmarks) {
    using Ordered = nlohmann::ordered_json;
    Ordered points = Ordered::array();
    std::size_t id = 1;
    for (const auto& mark : landmarks.all())
        points.push_back({{"id", std::to_string(id++)},
                          {"label", mark.name},
                          {"description", ""},
                          {"associatedNodeID", ""},
                          {"position", {mark.position_mm.x(), mark.position_mm.y(), mark.position_mm.z()}},
                          {"orientation", {-1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0}},
                          {"selected", true},
                          {"locked", false},
                          {"visibility", true},
                          {"positionStatus", "defined"}});
    const Ordered json = {
        {"@schema",
         "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/"
         "markups-schema-v1.0.3.json#"},
        {"markups",
         {{{"type", "Fiducial"}, {"coordinateSystem", "LPS"}, {"coordinateUnits", "mm"}, {"controlPoints", points}}}}};
    // A label that is not UTF-8 must not make the file unreadable.
    return json.dump(1, ' ', false, Ordered::error_handler_t::replace) + '\n';
}

}  // namespace mimik::io::formats
