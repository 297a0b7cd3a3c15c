#include "facs/facs_catalogue.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

#include "base/content_hash.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "facs/arkit_shapes.h"
#include "facs/reference_face.h"
#include "facs/toml_depth.h"
#include "geometry/landmarks.h"

namespace mimik::facs {

namespace {

constexpr std::string_view embedded_catalogue =
#include "facs/facs_toml.inc"
    ;
constexpr std::string_view embedded_thesis_catalogue =
#include "facs/facs_thesis_toml.inc"
    ;

std::string upper(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return text;
}

// Far more than a catalogue has; a file of another kind must not fill the memory with complaints.
constexpr std::size_t most_findings = 1000, most_points = 1000, deepest = 32;  // a catalogue goes 4 deep
constexpr double largest_weight = 10.0;

struct TooManyFindings {};

/// Collects findings while it reads; a value that is missing or wrong leaves its default.
class Reader {
public:
    explicit Reader(std::vector<LintFinding>& findings) : findings_(findings) {}

    void error(const toml::node& node, const std::string& what) { add(true, node, what); }
    void warn(const toml::node& node, const std::string& what) { add(false, node, what); }
    [[nodiscard]] std::ptrdiff_t errors() const {
        return std::count_if(findings_.begin(), findings_.end(), [](const LintFinding& f) { return f.error; });
    }

    void only_keys(const toml::table& table, std::initializer_list<std::string_view> known) {
        for (const auto& [key, node] : table)
            if (std::find(known.begin(), known.end(), key.str()) == known.end())
                error(node, fmt::format("unknown key {}; known here: {}", base::in_quotes(key.str()),
                                        fmt::join(known, ", ")));
    }
    std::string text(const toml::table& table, const char* key, bool required = true) {
        const auto* node = table.get(key);
        if (!node) {
            if (required) error(table, fmt::format("'{}' is missing", key));
            return {};
        }
        if (const auto value = node->value<std::string>()) return *value;
        error(*node, fmt::format("'{}' is not a text", key));
        return {};
    }
    double number(const toml::node& node, const std::string& what) {
        if (const auto value = node.value<double>(); value && std::isfinite(*value)) return *value;
        error(node, what + " is not a number");
        return 0;
    }
    /// From 0 to 999.
    int small_number(const toml::node& node, const std::string& what) {
        const double value = number(node, what);
        if (value >= 0 && value < 1000 && value == std::floor(value)) return static_cast<int>(value);
        error(node, fmt::format("{} is {}, not a whole number of 0 to 999", what, value));
        return 0;
    }
    std::pair<double, double> two(const toml::table& table, const char* key, bool required) {
        const auto* node = table.get(key);
        if (!node) {
            if (required) error(table, fmt::format("'{}' is missing", key));
            return {0, 0};
        }
        const auto* list = node->as_array();
        if (!list || list->size() != 2) {
            error(*node, fmt::format("'{}' is not a list of two numbers [lateral, up]", key));
            return {0, 0};
        }
        return {number(*list->get(0), key), number(*list->get(1), key)};
    }
    Placement placement(const toml::table& table) {
        static const std::set<std::string, std::less<>> names = [] {
            std::set<std::string, std::less<>> all;
            for (const auto name : geometry::standard_landmark_names()) {
                all.emplace(name);
                for (const std::string_view side : {"_left", "_right"})
                    if (name.ends_with(side)) all.emplace(name.substr(0, name.size() - side.size()));
            }
            return all;
        }();
        Placement place;
        const auto* node = table.get("at");
        const auto* at = node ? node->as_table() : nullptr;
        if (!at || at->empty()) {
            error(node ? *node : table,
                  "'at' is missing: give landmarks and weights, e.g. at = { mouth_corner = 1.0 }");
            return place;
        }
        double sum = 0;
        for (const auto& [key, weight] : *at) {
            if (!names.contains(key.str()))
                error(weight, fmt::format("unknown landmark {}; known: {}", base::in_quotes(key.str()),
                                          fmt::join(names, ", ")));
            place.at.emplace_back(std::string(key.str()), number(weight, "a weight"));
            if (std::abs(place.at.back().second) > largest_weight)
                error(weight, fmt::format("weight {} is not between -{} and {}", place.at.back().second, largest_weight,
                                          largest_weight));
            sum += place.at.back().second;
        }
        check_sides(*at, place);
        if (std::abs(sum - 1.0) > 1e-6) error(*at, fmt::format("weights add up to {}, not 1", sum));
        std::tie(place.lateral, place.up) = two(table, "offset", false);
        if (std::hypot(place.lateral, place.up) > 1.5)
            error(table, "offset of more than 1.5 outer-eye distances is off the face");
        return place;
    }
    /// Places are written for the left side and mirrored: a landmark of one side would stay where it is.
    void check_sides(const toml::table& at, const Placement& place) {
        const auto weight_of = [&](const std::string& name) {
            for (const auto& [other, weight] : place.at)
                if (other == name) return weight;
            return 0.0;
        };
        for (const auto& [name, weight] : place.at)
            for (const auto& [side, other] : {std::pair("_left", "_right"), std::pair("_right", "_left")}) {
                if (!name.ends_with(side)) continue;
                const auto bare = name.substr(0, name.size() - std::string_view(side).size());
                if (weight_of(bare + other) != weight)
                    error(*at.get(name),
                          fmt::format("'{}' has no mirror image: write '{}', or '{}_left' and '{}_right' with equal "
                                      "weights for the point between them",
                                      name, bare, bare, bare));
            }
    }
    template <typename Visit>
    void tables(const toml::table& parent, const char* key, bool required, const Visit& visit) {
        const auto* node = parent.get(key);
        if (!node) {
            if (required) error(parent, fmt::format("'{}' is missing", key));
            return;
        }
        const auto* list = node->as_array();
        if (!list) return error(*node, fmt::format("'{}' is not a list of tables", key));
        for (const auto& item : *list) {
            if (const auto* table = item.as_table())
                visit(*table);
            else
                error(item, fmt::format("an entry of '{}' is not a table", key));
        }
    }

private:
    void add(bool is_error, const toml::node& node, const std::string& what) {
        const auto line = static_cast<unsigned>(node.source().begin.line);
        findings_.push_back({is_error, line, what});
        if (findings_.size() < most_findings) return;
        findings_.push_back({true, line, fmt::format("more than {} findings; is it a catalogue?", most_findings)});
        throw TooManyFindings();
    }
    std::vector<LintFinding>& findings_;
};

struct Parsed {
    Sampling sampling;
    std::vector<ActionUnit> units;
    std::vector<Emotion> emotions;
};

/// Lays a point on the reference face and says what would go wrong there.
void check_place(Reader& reader, const toml::table& entry, const CataloguePoint& point,
                 std::vector<std::pair<std::string, geometry::Point>>& placed) {
    const auto& marks = reference_landmarks();
    const auto shown_name = base::in_quotes(point.name);
    const geometry::Point p = place(point.placement, marks, Side::left);
    const bool central = point.placement.lateral == 0.0 &&
                         std::all_of(point.placement.at.begin(), point.placement.at.end(),
                                     [&](const auto& term) { return marks.find(term.first) != nullptr; });
    if (!on_reference_face(p))
        reader.warn(
            entry, fmt::format("point {} lies off the reference face, {:.0f} mm to the left of and {:.0f} mm above the "
                               "nose tip; make its offset smaller",
                               shown_name, p.x(), p.y()));
    if (!central && std::abs(p.x()) < 1.0)
        reader.error(entry,
                     fmt::format("point {} and its mirror image fall together on the midline; write it with midline "
                                 "landmarks and no lateral offset",
                                 shown_name));
    else if (p.x() < -1.0)
        reader.error(entry,
                     fmt::format("point {} lies on the subject's right half; write points for the left half, the right "
                                 "one is their mirror image",
                                 shown_name));
    for (const auto& [name, other] : placed)
        if ((other - p).head<2>().norm() < 1.0)
            reader.warn(
                entry, fmt::format("points {} and {} fall together on the reference face; one of them will be left out",
                                   shown_name, name));
    placed.emplace_back(shown_name, p);
}

ActionUnit read_unit(Reader& reader, const toml::table& table) {
    reader.only_keys(
        table, {"number", "name", "region", "sides", "muscles", "wrinkles", "arkit", "arkit_whole", "zone", "points"});
    ActionUnit unit;
    if (const auto* node = table.get("number"))
        unit.number = reader.small_number(*node, "number");
    else
        reader.error(table, "'number' is missing");
    if (unit.number < 1 || unit.number > 99)
        reader.error(table, fmt::format("AU number {} is not between 1 and 99", unit.number));
    unit.name = reader.text(table, "name");
    const auto region = reader.text(table, "region"), sides = reader.text(table, "sides");
    if (region != "upper" && region != "lower")
        reader.error(table, fmt::format("region {} is neither upper nor lower", base::in_quotes(region)));
    if (sides != "paired" && sides != "central")
        reader.error(table, fmt::format("sides {} is neither paired nor central", base::in_quotes(sides)));
    unit.lower_face = region != "upper";
    unit.central = sides == "central";
    unit.wrinkles = reader.text(table, "wrinkles", false);
    unit.arkit = reader.text(table, "arkit", false);
    unit.arkit_whole = reader.text(table, "arkit_whole", false);
    if (unit.central && !unit.arkit.empty())
        reader.error(table, fmt::format("AU{} is central and has no halves to name: use arkit_whole in place of arkit",
                                        unit.number));
    for (const auto& [key, shape] : {std::pair("arkit", unit.arkit), std::pair("arkit_whole", unit.arkit_whole)}) {
        const bool half = std::string_view(key) == "arkit";
        if (shape.empty() ||
            (half ? is_arkit_shape(shape + "Left") && is_arkit_shape(shape + "Right") : is_arkit_shape(shape)))
            continue;
        reader.error(*table.get(key), half
                                          ? fmt::format("ARKit has no blendshapes '{}Left' and '{}Right'", shape, shape)
                                          : fmt::format("ARKit has no blendshape '{}'", shape));
    }
    reader.tables(table, "muscles", true, [&](const toml::table& entry) {
        reader.only_keys(entry, {"name", "source", "reference"});
        Muscle muscle{reader.text(entry, "name"), reader.text(entry, "source"), reader.text(entry, "reference")};
        if (entry.get("reference") && base::trimmed(muscle.reference).empty())
            reader.error(*entry.get("reference"),
                         fmt::format("the reference of '{}' is empty; say where its part in this AU was published",
                                     muscle.name));
        unit.muscles.push_back(std::move(muscle));
    });
    reader.tables(table, "zone", true, [&](const toml::table& ellipse) {
        reader.only_keys(ellipse, {"at", "offset", "radii"});
        ZoneEllipse zone;
        zone.centre = reader.placement(ellipse);
        std::tie(zone.lateral_radius, zone.up_radius) = reader.two(ellipse, "radii", true);
        if (zone.lateral_radius <= 0 || zone.up_radius <= 0) reader.error(ellipse, "radii must be above 0");
        unit.zone.push_back(std::move(zone));
    });
    std::set<std::string> names;
    std::vector<std::pair<std::string, geometry::Point>> placed;
    bool moving_point = false;
    reader.tables(table, "points", true, [&](const toml::table& entry) {
        reader.only_keys(entry, {"name", "kind", "at", "offset"});
        if (unit.points.size() == most_points)
            return reader.error(entry, fmt::format("more than {} points", most_points));
        CataloguePoint point;
        point.name = reader.text(entry, "name");
        const auto kind = reader.text(entry, "kind");
        if (kind != "muscle" && kind != "wrinkle" && kind != "carried")
            reader.error(entry, fmt::format("kind {} is none of muscle, carried, wrinkle", base::in_quotes(kind)));
        point.kind = kind == "wrinkle"   ? ControlKind::wrinkle
                     : kind == "carried" ? ControlKind::carried
                                         : ControlKind::muscle;
        moving_point = moving_point || point.kind != ControlKind::wrinkle;
        const auto errors_before = reader.errors();
        point.placement = reader.placement(entry);
        if (reader.errors() == errors_before) check_place(reader, entry, point, placed);
        if (!names.insert(point.name).second)
            reader.error(entry, fmt::format("point {} stands twice in AU{}", base::in_quotes(point.name), unit.number));
        unit.points.push_back(std::move(point));
    });
    if (!moving_point) reader.error(table, fmt::format("AU{} has no muscle point and no carried one", unit.number));
    if (unit.zone.empty()) reader.error(table, fmt::format("AU{} has no zone", unit.number));
    return unit;
}

void read_document(Reader& reader, const toml::table& document, Parsed& parsed) {
    reader.only_keys(document, {"schema", "sampling", "au", "emotion"});
    if (document["schema"].value_or(0) != 1) reader.error(document, "schema is not 1");
    if (const auto* sampling = document["sampling"].as_table()) {
        reader.only_keys(*sampling, {"coverage_spacing", "anchor_spacing", "anchor_margin", "min_separation"});
        const auto take = [&](const char* key, double& value, double low, double high) {
            if (const auto* node = sampling->get(key)) {
                value = reader.number(*node, key);
                if (!(value >= low && value <= high))
                    reader.error(*node, fmt::format("{} is {}, not between {} and {}", key, value, low, high));
            }
        };
        take("coverage_spacing", parsed.sampling.coverage_spacing, 0.03, 1.0);
        take("anchor_spacing", parsed.sampling.anchor_spacing, 0.03, 1.0);
        take("anchor_margin", parsed.sampling.anchor_margin, 0.0, 1.0);
        take("min_separation", parsed.sampling.min_separation, 0.005, 0.5);
    } else if (const auto* other = document.get("sampling")) {
        reader.error(*other, "'sampling' is not a table; write [sampling] above its keys");
    }
    std::set<int> numbers;
    reader.tables(document, "au", true, [&](const toml::table& table) {
        parsed.units.push_back(read_unit(reader, table));
        if (!numbers.insert(parsed.units.back().number).second)
            reader.error(table, fmt::format("AU{} stands twice", parsed.units.back().number));
    });
    std::set<std::pair<std::string, std::string>> emotions;  // set and name
    reader.tables(document, "emotion", false, [&](const toml::table& table) {
        reader.only_keys(table, {"name", "units", "set"});
        Emotion emotion{upper(reader.text(table, "name")), {}};
        if (table.get("set")) emotion.set = reader.text(table, "set");
        if (!emotion.name.empty() && !emotions.insert({emotion.set, emotion.name}).second)
            reader.error(table, fmt::format("emotion {} stands twice", base::in_quotes(emotion.name)));
        if (const auto* list = table["units"].as_array())
            for (const auto& item : *list) {
                const auto number = reader.small_number(item, "units");
                if (!numbers.contains(number)) reader.error(item, fmt::format("AU{} is not in this catalogue", number));
                emotion.action_units.push_back(number);
            }
        if (emotion.action_units.empty()) reader.error(table, "'units' names no AU");
        parsed.emotions.push_back(std::move(emotion));
    });
}

Parsed read(const std::string& text, std::vector<LintFinding>& findings) {
    Parsed parsed;
    if (const auto line = line_too_deep(text, deepest); line > 0) {
        findings.push_back({true, static_cast<unsigned>(line),
                            fmt::format("brackets or parts of a key go deeper than {}; is it a catalogue?", deepest)});
        return parsed;
    }
    toml::table document;
    try {
        document = toml::parse(text);
    } catch (const toml::parse_error& e) {
        findings.push_back({true, static_cast<unsigned>(e.source().begin.line), std::string(e.description())});
        return parsed;
    }
    try {
        Reader reader(findings);
        read_document(reader, document, parsed);
    } catch (const TooManyFindings&) {  // the last of them says so
    }
    std::stable_sort(findings.begin(), findings.end(),
                     [](const LintFinding& a, const LintFinding& b) { return a.line < b.line; });
    return parsed;
}

}  // namespace

std::string_view to_string(ControlKind kind) {
    switch (kind) {
        case ControlKind::muscle:
            return "muscle";
        case ControlKind::carried:
            return "carried";
        case ControlKind::wrinkle:
            return "wrinkle";
        case ControlKind::coverage:
            return "coverage";
        case ControlKind::anchor:
            return "anchor";
    }
    return "muscle";
}

ControlKind parse_control_kind(const std::string& text) {
    for (const auto kind :
         {ControlKind::muscle, ControlKind::carried, ControlKind::wrinkle, ControlKind::coverage, ControlKind::anchor})
        if (text == to_string(kind)) return kind;
    throw InputError(
        fmt::format("kind {} is none of muscle, carried, wrinkle, coverage, anchor", base::in_quotes(text)));
}

namespace {

/// The units of a text that is one, or several in the spelling of combined scans: "12L", "A12", "A12LA15".
std::vector<UnitOnSide> units_named(std::string_view text) {
    // Nothing but letters and digits: "4-12" is not AU412.
    if (!std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isalnum(c) != 0; })) return {};
    auto units = parse_unit_codes(text);
    if (units.empty())
        if (const auto one = parse_expression(text); one && one->units().size() == 1)
            units.assign(one->units().begin(), one->units().end());
    return units;
}

std::vector<UnitOnSide> prototype_of(const Emotion& emotion) {
    std::vector<UnitOnSide> units;
    for (const int number : emotion.action_units) units.push_back({number, Side::both, false});
    return units;
}

}  // namespace

FacsCatalogue::FacsCatalogue(Sampling sampling, std::vector<ActionUnit> units, std::vector<Emotion> emotions,
                             std::string name, std::string content_hash)
    : sampling_(sampling),
      units_(std::move(units)),
      all_emotions_(std::move(emotions)),
      name_(std::move(name)),
      content_hash_(std::move(content_hash)) {
    for (const auto& emotion : all_emotions_)
        if (emotion.set == usual_emotion_set) emotions_.push_back(emotion);
}

FacsCatalogue FacsCatalogue::with_emotions(const std::string& set) const {
    auto other = *this;
    other.emotions_.clear();
    std::set<std::string> sets;
    for (const auto& emotion : all_emotions_) {
        sets.insert(emotion.set);
        if (emotion.set == set) other.emotions_.push_back(emotion);
    }
    if (other.emotions_.empty())
        throw InputError(
            fmt::format("emotions '{}' are not in the {}; there are: {}", set, name_, fmt::join(sets, ", ")));
    // A model of an emotion was made by its units: those of another set are not the same.
    if (set != usual_emotion_set && !content_hash_.empty()) other.content_hash_ = content_hash_ + "-" + set;
    return other;
}

const ActionUnit* FacsCatalogue::find(int number) const {
    const auto it =
        std::find_if(units_.begin(), units_.end(), [&](const ActionUnit& unit) { return unit.number == number; });
    return it == units_.end() ? nullptr : &*it;
}

Expression FacsCatalogue::expression(const std::string& text) const {
    const auto parsed = parse_expression(text);
    const auto& code = parsed ? parsed->code() : text;  // "joy" and "E_HAPPY" are HAPPY
    for (const auto& spelling : {upper(text), code})
        for (const auto& emotion : emotions_)
            if (emotion.name == spelling) return Expression::of_word("E", emotion.name, prototype_of(emotion));
    auto units = units_named(code);
    if (units.empty()) {
        std::vector<std::string> emotions;
        for (const auto& emotion : emotions_) emotions.push_back(emotion.name);
        throw InputError(fmt::format("expression '{}' is neither an AU (12, AU4_L, 4L, A12A15) nor an emotion ({})",
                                     text, fmt::join(emotions, ", ")));
    }
    for (const auto& part : units) {
        const auto* unit = find(part.unit);
        if (!unit) {
            std::vector<int> numbers;
            for (const auto& known : units_) numbers.push_back(known.number);
            throw InputError(fmt::format("expression '{}': AU{} is not in the catalogue; there are: {}", text,
                                         part.unit, fmt::join(numbers, ", ")));
        }
        if (unit->central && part.side != Side::both)
            throw InputError(fmt::format("expression '{}': AU{} ({}) moves both sides at once; leave the side out",
                                         text, unit->number, unit->name));
    }
    return Expression::of_units(std::move(units));
}

std::optional<Expression> FacsCatalogue::find_expression(const std::string& text) const {
    try {
        return expression(text);
    } catch (const InputError&) {
        return std::nullopt;
    }
}

std::vector<SidedUnit> FacsCatalogue::units(const Expression& expression) const {
    // A word that was read without a catalogue has no units yet: of a scan's name, or of a model's file.
    if (expression.own_word() && !find_expression(expression.code())) return {};
    const auto known = expression.units().empty() ? this->expression(expression.code()) : expression;
    std::vector<SidedUnit> units;
    for (const auto& part : known.units()) {
        const auto* unit = find(part.unit);
        if (!unit)
            throw InputError(
                fmt::format("expression '{}': AU{} is not in the {}", expression.code(), part.unit, name_));
        units.push_back({unit, part.side});
    }
    return units;
}

bool FacsCatalogue::knows(const Expression& expression) const {
    try {
        const auto known = units(expression);
        return !known.empty() && std::none_of(known.begin(), known.end(), [](const SidedUnit& part) {
            return part.unit->central && part.side != Side::both;
        });
    } catch (const InputError&) {
        return false;
    }
}

std::string arkit_shape(const FacsCatalogue& catalogue, const Expression& expression) {
    // A blendshape at 1 is the full motion: a scan of low intensity is none.
    if (expression.units().size() != 1 || expression.units().front().low_intensity) return {};
    const auto* unit = catalogue.find(expression.units().front().unit);
    const auto side = expression.units().front().side;
    if (!unit) return {};
    if (side == Side::both) return unit->arkit_whole;
    return unit->arkit.empty() ? std::string() : unit->arkit + (side == Side::left ? "Left" : "Right");
}

std::string arkit_name(const FacsCatalogue& catalogue, const Expression& expression) {
    const auto shape = arkit_shape(catalogue, expression);
    return shape.empty() ? expression.name() : shape;
}

std::string_view builtin_catalogue_text() { return embedded_catalogue; }

const FacsCatalogue& builtin_catalogue() {
    static const FacsCatalogue catalogue = parse_catalogue(std::string(embedded_catalogue), "built-in catalogue");
    return catalogue;
}

std::string_view thesis_catalogue_text() { return embedded_thesis_catalogue; }

const FacsCatalogue& thesis_catalogue() {
    static const FacsCatalogue catalogue =
        parse_catalogue(std::string(embedded_thesis_catalogue), "built-in catalogue of the thesis");
    return catalogue;
}

std::vector<LintFinding> lint_catalogue(const std::string& text) {
    std::vector<LintFinding> findings;
    (void)read(text, findings);
    return findings;
}

FacsCatalogue parse_catalogue(const std::string& text, const std::string& name) {
    std::vector<LintFinding> findings;
    auto parsed = read(text, findings);
    std::string errors;
    int count = 0;
    for (const auto& finding : findings)
        if (finding.error && ++count <= 5)
            errors += fmt::format("{}{}:{}: {}", errors.empty() ? "" : "; ", name, finding.line, finding.what);
    if (count > 5) errors += fmt::format("; and {} more ('mimik catalogue FILE --lint' lists all)", count - 5);
    if (count > 0) throw InputError(errors);
    base::ContentHash hash;
    hash.add(text);
    return {parsed.sampling, std::move(parsed.units), std::move(parsed.emotions), name, hash.text()};
}

FacsCatalogue read_catalogue(const std::filesystem::path& file) {
    return parse_catalogue(base::read_text(file, 1 << 22), file.string());
}

TypedMagnitude split_magnitude(const std::string& typed) {
    TypedMagnitude split;
    const auto colon = typed.rfind(':');
    split.text = typed.substr(0, colon);
    if (colon != std::string::npos) {
        const char* begin = typed.data() + colon + 1;
        const char* end = typed.data() + typed.size();
        const auto [stop, fault] = std::from_chars(begin, end, split.magnitude);
        if (fault != std::errc{} || stop != end || !std::isfinite(split.magnitude) || split.magnitude < 0)
            throw InputError(
                fmt::format("'{}': the magnitude after ':' is not a number of 0 or more, such as 12:0.5", typed));
    }
    if (split.text.empty())
        throw InputError(fmt::format("'{}' names no AU or emotion; give for example 12 or 4L:0.5", typed));
    return split;
}

}  // namespace mimik::facs
