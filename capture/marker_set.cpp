#include "capture/marker_set.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "capture/control_surface.h"
#include "facs/reference_face.h"
#include "facs/toml_depth.h"

namespace mimik::capture {
namespace {

constexpr std::string_view embedded_set =
#include "capture/marker_set_toml.inc"
    ;

constexpr std::size_t most_findings = 1000, most_entries = 10'000, deepest = 32;
constexpr std::size_t least_group = 3;    // fewer say no rotation
constexpr double closest_mm = 3;          // two markers are wider
constexpr std::size_t most_openings = 8;  // two bits each, and room to spare

struct TooManyFindings {};

/// One table of the file: a marker of the middle, or of both sides.
struct Entry {
    const toml::table* table = nullptr;
    std::string name;
    bool paired = false, derived = false;
    facs::Placement placement;
    std::vector<std::string> group, along;
    std::string sibling, towards;
};

class Reader {
public:
    explicit Reader(std::vector<facs::LintFinding>& findings) : findings_(findings) {}

    MarkerSet read(const toml::table& document) {
        only_keys(document, {"schema", "marker", "derived", "surface", "opening"});
        if (document["schema"].value_or(0) != 1) error(document, "schema is not 1");
        for (const char* key : {"marker", "derived"}) read_tables(document, key);
        if (std::none_of(entries_.begin(), entries_.end(), [](const Entry& entry) { return !entry.derived; }))
            error(document, "there is no [[marker]]");
        collect_names();
        MarkerSet set;
        for (const auto& entry : entries_) check(entry);
        for (const auto& entry : entries_)
            for (const auto side : sides(entry)) add(entry, side, set);
        read_surface(document, set);
        read_openings(document, set);
        check_places();
        check_surface(document, set);
        return set;
    }

private:
    void add_finding(bool is_error, const toml::node& node, const std::string& what) {
        const auto line = static_cast<unsigned>(node.source().begin.line);
        findings_.push_back({is_error, line, what});
        if (findings_.size() < most_findings) return;
        findings_.push_back({true, line, fmt::format("more than {} findings; is it a marker set?", most_findings)});
        throw TooManyFindings();
    }
    void error(const toml::node& node, const std::string& what) { add_finding(true, node, what); }
    void only_keys(const toml::table& table, std::initializer_list<std::string_view> known) {
        for (const auto& [key, node] : table)
            if (std::find(known.begin(), known.end(), key.str()) == known.end())
                error(node, fmt::format("unknown key {}; known here: {}", base::in_quotes(key.str()),
                                        fmt::join(known, ", ")));
    }
    static std::vector<facs::Side> sides(const Entry& entry) {
        if (entry.paired) return {facs::Side::left, facs::Side::right};
        return {facs::Side::both};
    }
    static std::string full(const std::string& name, facs::Side side) {
        return side == facs::Side::both ? name : name + facs::side_suffix(side);
    }

    void read_tables(const toml::table& document, const char* key);
    std::string text(const toml::table& table, const char* key, bool required);
    std::vector<std::string> names(const toml::table& table, const char* key);
    facs::Placement placement(const toml::table& table);
    void collect_names();
    std::vector<std::string> resolved(const Entry& entry, const std::string& name, facs::Side side, bool report);
    std::vector<std::string> resolved(const Entry& entry, const std::vector<std::string>& list, facs::Side side);
    void check(const Entry& entry);
    void add(const Entry& entry, facs::Side side, MarkerSet& set);
    void check_places();
    std::vector<std::string> anywhere(const toml::node& node, const std::string& name, bool paired, facs::Side side);
    void read_surface(const toml::table& document, MarkerSet& set);
    void read_openings(const toml::table& document, MarkerSet& set);
    void check_surface(const toml::table& document, const MarkerSet& set);

    std::vector<facs::LintFinding>& findings_;
    std::vector<Entry> entries_;
    std::map<std::string, bool> names_;  ///< full names, and whether they are derived
};

std::string Reader::text(const toml::table& table, const char* key, bool required) {
    const auto* node = table.get(key);
    if (!node) {
        if (required) error(table, fmt::format("'{}' is missing", key));
        return {};
    }
    if (const auto value = node->value<std::string>()) return *value;
    error(*node, fmt::format("'{}' is not a text", key));
    return {};
}

std::vector<std::string> Reader::names(const toml::table& table, const char* key) {
    std::vector<std::string> list;
    const auto* node = table.get(key);
    if (!node) return list;
    const auto* array = node->as_array();
    if (!array || array->size() > most_entries) {
        error(*node, fmt::format("'{}' is not a list of names", key));
        return list;
    }
    for (const auto& item : *array) {
        if (const auto value = item.value<std::string>())
            list.push_back(*value);
        else
            error(item, fmt::format("an entry of '{}' is not a name", key));
    }
    return list;
}

facs::Placement Reader::placement(const toml::table& table) {
    facs::Placement place;
    const auto* at = table["at"].as_table();
    if (!at || at->empty()) {
        error(table, "'at' is missing: give landmarks and weights, such as at = { mouth_corner = 1.0 }");
        return place;
    }
    const auto& marks = facs::reference_landmarks();
    double sum = 0;
    for (const auto& [key, node] : *at) {
        const std::string name(key.str());
        if (!marks.find(name) && !marks.find(name + "_left"))
            error(node, fmt::format("there is no landmark {} (docs/landmarks.md)", base::in_quotes(name)));
        const auto weight = node.value<double>();
        if (!weight || !(std::abs(*weight) <= 10)) error(node, "a weight is not a number of -10 to 10");
        place.at.emplace_back(name, weight.value_or(0));
        sum += weight.value_or(0);
    }
    if (!(std::abs(sum - 1) <= 1e-6)) error(*at, fmt::format("weights add up to {}, not 1", sum));
    if (const auto* node = table.get("offset")) {
        const auto* list = node->as_array();
        const auto lateral = list && list->size() == 2 ? list->get(0)->value<double>() : std::nullopt;
        const auto up = list && list->size() == 2 ? list->get(1)->value<double>() : std::nullopt;
        if (!lateral || !up || !(std::hypot(*lateral, *up) <= 1.5))
            error(*node, "'offset' is not [lateral, up] of at most 1.5 outer-eye distances");
        place.lateral = lateral.value_or(0);
        place.up = up.value_or(0);
    }
    return place;
}

void Reader::read_tables(const toml::table& document, const char* key) {
    const auto* node = document.get(key);
    if (!node) return;
    const auto* list = node->as_array();
    if (!list || list->size() > most_entries) return error(*node, fmt::format("write [[{}]] above each of them", key));
    for (const auto& item : *list) {
        const auto* table = item.as_table();
        if (!table) {
            error(item, fmt::format("write [[{}]] above each of them", key));
            continue;
        }
        Entry entry;
        entry.table = table;
        entry.derived = std::string_view(key) == "derived";
        if (entry.derived)
            only_keys(*table, {"name", "sides", "at", "offset", "group", "sibling", "along", "towards"});
        else
            only_keys(*table, {"name", "sides", "at", "offset", "group"});
        entry.name = text(*table, "name", true);
        if (table->get("name") && base::trimmed(entry.name).empty()) error(*table, "'name' is empty");
        const auto side = text(*table, "sides", true);
        if (!side.empty() && side != "paired" && side != "middle")
            error(*table, fmt::format("sides {} is neither paired nor middle", base::in_quotes(side)));
        entry.paired = side == "paired";
        entry.placement = placement(*table);
        entry.group = names(*table, "group");
        entry.sibling = text(*table, "sibling", false);
        entry.along = names(*table, "along");
        entry.towards = text(*table, "towards", false);
        entries_.push_back(std::move(entry));
    }
}

void Reader::collect_names() {
    for (const auto& entry : entries_)
        for (const auto side : sides(entry))
            if (!entry.name.empty() && !names_.emplace(full(entry.name, side), entry.derived).second)
                error(*entry.table, fmt::format("{} is there twice", base::in_quotes(full(entry.name, side))));
}

/// The full names that a name in an entry stands for: of the same side, of the middle, or in the middle both sides.
std::vector<std::string> Reader::resolved(const Entry& entry, const std::string& name, facs::Side side, bool report) {
    const auto known = [&](const std::string& one) {
        const auto it = names_.find(one);
        return it != names_.end() && !it->second;
    };
    if (entry.paired && known(full(name, side))) return {full(name, side)};
    if (known(name)) {
        if (report && entry.paired && (name.ends_with("_left") || name.ends_with("_right")))
            error(*entry.table, fmt::format("{} has a side; places are written for the left and mirrored, leave it off",
                                            base::in_quotes(name)));
        return {name};
    }
    if (!entry.paired && known(name + "_left") && known(name + "_right")) return {name + "_right", name + "_left"};
    if (report) {
        const bool derived = names_.count(name) + names_.count(name + "_left") > 0;
        error(*entry.table, derived ? fmt::format("{} is derived itself; hang it on markers", base::in_quotes(name))
                                    : fmt::format("there is no marker {}", base::in_quotes(name)));
    }
    return {};
}

std::vector<std::string> Reader::resolved(const Entry& entry, const std::vector<std::string>& list, facs::Side side) {
    std::vector<std::string> all;
    for (const auto& name : list)
        for (auto& one : resolved(entry, name, side, false)) all.push_back(std::move(one));
    return all;
}

void Reader::check(const Entry& entry) {
    const auto side = sides(entry).front();
    for (const auto& list : {entry.group, entry.along})
        for (const auto& name : list) (void)resolved(entry, name, side, true);
    for (const auto& name : {entry.sibling, entry.towards})
        if (!name.empty()) (void)resolved(entry, name, side, true);
    const auto group = resolved(entry, entry.group, side);
    if (std::find(group.begin(), group.end(), full(entry.name, side)) != group.end())
        error(*entry.table, fmt::format("{} hangs on itself", base::in_quotes(entry.name)));
    if (std::set<std::string>(group.begin(), group.end()).size() != group.size())
        error(*entry.table, fmt::format("the group of {} names a marker twice", base::in_quotes(entry.name)));
    const bool framed = !entry.sibling.empty() || !entry.along.empty() || !entry.towards.empty();
    if (framed && !entry.group.empty())
        error(*entry.table, "has a group and a sibling; give one of them");
    else if (!framed && group.size() < least_group)
        error(*entry.table,
              fmt::format("the group of {} has {}; {} are the least that say a rotation", base::in_quotes(entry.name),
                          base::counted(group.size(), "marker"), least_group));
    if (!framed) return;
    const auto along = resolved(entry, entry.along, side);
    for (const auto& name : {entry.sibling, entry.towards})
        if (resolved(entry, name, side, false).size() > 1)
            error(*entry.table,
                  fmt::format("{} stands on both sides; say which, such as {}_left", base::in_quotes(name), name));
    if (entry.sibling.empty() || entry.towards.empty() || along.size() != 2)
        error(*entry.table, "a sibling needs along = [A, B] and towards = C: the markers that span its frame");
    else if (along[0] == along[1] ||
             resolved(entry, entry.towards, side, false) == resolved(entry, entry.sibling, side, false))
        error(*entry.table, "the markers of the sibling's frame are not three different ones");
}

void Reader::add(const Entry& entry, facs::Side side, MarkerSet& set) {
    const auto one = [&](const std::string& name) {
        const auto list = resolved(entry, name, side, false);
        return list.empty() ? std::string() : list.front();
    };
    if (!entry.derived) {
        set.markers.push_back({full(entry.name, side), resolved(entry, entry.group, side), entry.placement, side});
        return;
    }
    DerivedMarker derived{full(entry.name, side), {}, resolved(entry, entry.group, side), entry.placement, side};
    if (!entry.sibling.empty()) {
        const auto along = resolved(entry, entry.along, side);
        derived.frame = SiblingFrame{one(entry.sibling), {}, one(entry.towards)};
        if (along.size() == 2) derived.frame->along = {along[0], along[1]};
    }
    set.derived.push_back(std::move(derived));
}

/// On the reference face no two fall together, and none falls off it.
void Reader::check_places() {
    if (std::any_of(findings_.begin(), findings_.end(), [](const auto& one) { return one.error; })) return;
    std::vector<std::pair<std::string, geometry::Point>> placed;
    for (const auto& entry : entries_) {
        const auto p = facs::place(entry.placement, facs::reference_landmarks(), facs::Side::left);
        if (!facs::on_reference_face(p))
            add_finding(false, *entry.table,
                        fmt::format("{} lies off the reference face, {:.0f} mm to the left of and "
                                    "{:.0f} mm above the nose tip",
                                    base::in_quotes(entry.name), p.x(), p.y()));
        if (entry.paired && p.x() < 1)
            error(*entry.table,
                  fmt::format("{} and its mirror image fall together; write it for the middle, or further "
                              "to the left",
                              base::in_quotes(entry.name)));
        for (const auto& [name, other] : placed)
            if ((p - other).norm() < closest_mm)
                add_finding(false, *entry.table,
                            fmt::format("{} and {} lie {:.1f} mm apart on the reference face",
                                        base::in_quotes(entry.name), base::in_quotes(name), (p - other).norm()));
        placed.emplace_back(entry.name, p);
    }
}

/// The full names that a name of the surface or of an opening stands for; derived ones count.
std::vector<std::string> Reader::anywhere(const toml::node& node, const std::string& name, bool paired,
                                          facs::Side side) {
    if (paired && names_.count(full(name, side)) > 0) return {full(name, side)};
    if (names_.count(name) > 0) return {name};
    if (!paired && names_.count(name + "_left") > 0) return {name + "_right", name + "_left"};
    error(node, fmt::format("there is no marker {}", base::in_quotes(name)));
    return {};
}

void Reader::read_surface(const toml::table& document, MarkerSet& set) {
    const auto* node = document.get("surface");
    if (!node) return;
    const auto* table = node->as_table();
    if (!table) return error(*node, "write [surface] and under it triangles = [ ... ]");
    only_keys(*table, {"triangles"});
    const auto* list = (*table)["triangles"].as_array();
    if (!list || list->size() > most_entries) return error(*table, "'triangles' is not a list of triangles");
    for (const auto& item : *list) {
        const auto* corners = item.as_array();
        std::array<std::string, 3> left, right;
        bool good = corners && corners->size() == 3;
        for (std::size_t c = 0; good && c < 3; ++c) {
            const auto name = corners->get(c)->value<std::string>();
            good = name.has_value();
            if (!good) break;
            const auto there = anywhere(item, *name, true, facs::Side::left);
            if (there.empty()) break;
            left[c] = there.front();
            // The mirror image is run through the other way.
            right[2 - c] = anywhere(item, *name, true, facs::Side::right).front();
        }
        if (!good) {
            error(item, "a triangle is not three names of markers");
            continue;
        }
        if (left[0].empty() || left[1].empty() || left[2].empty()) continue;
        set.triangles.push_back(left);
        auto sorted = left, mirrored = right;
        std::sort(sorted.begin(), sorted.end());
        std::sort(mirrored.begin(), mirrored.end());
        if (sorted != mirrored) set.triangles.push_back(right);
    }
}

void Reader::read_openings(const toml::table& document, MarkerSet& set) {
    const auto* node = document.get("opening");
    if (!node) return;
    const auto* list = node->as_array();
    if (!list || list->size() > most_openings)
        return error(*node, fmt::format("write [[opening]] above each of them, at most {}", most_openings));
    for (const auto& item : *list) {
        const auto* table = item.as_table();
        if (!table) {
            error(item, "write [[opening]] above each of them");
            continue;
        }
        only_keys(*table, {"name", "sides", "upper", "lower"});
        const auto name = text(*table, "name", true), side = text(*table, "sides", true);
        if (!side.empty() && side != "paired" && side != "middle")
            error(*table, fmt::format("sides {} is neither paired nor middle", base::in_quotes(side)));
        const bool paired = side == "paired";
        for (const auto one : paired ? std::vector<facs::Side>{facs::Side::left, facs::Side::right}
                                     : std::vector<facs::Side>{facs::Side::both}) {
            MarkerOpening opening{full(name, one), {}, {}, one};
            const auto put = [&](const char* key, std::vector<std::string>& names_of_part) {
                for (const auto& marker : names(*table, key))
                    for (auto& there : anywhere(*table, marker, paired, one)) names_of_part.push_back(std::move(there));
                if (names_of_part.empty())
                    error(*table, fmt::format("'{}' of {} names no marker", key, base::in_quotes(name)));
            };
            put("upper", opening.upper);
            put("lower", opening.lower);
            for (const auto& marker : opening.upper)
                if (std::find(opening.lower.begin(), opening.lower.end(), marker) != opening.lower.end())
                    error(*table,
                          fmt::format("{} lies above and below {}", base::in_quotes(marker), base::in_quotes(name)));
            set.openings.push_back(std::move(opening));
        }
    }
}

/// The triangles on the reference face, all of one orientation, no edge with three of them, none across an opening.
void Reader::check_surface(const toml::table& document, const MarkerSet& set) {
    if (set.triangles.empty()) return;
    if (std::any_of(findings_.begin(), findings_.end(), [](const auto& one) { return one.error; })) return;
    const auto& node = *document.get("surface");
    const auto places = place_markers(set, facs::reference_landmarks());
    for (const auto& fault : surface_faults(set, places)) error(node, fault);
    for (const auto& opening : set.openings)
        for (const auto& triangle : set.triangles) {
            const auto touches = [&](const std::vector<std::string>& part) {
                return std::any_of(triangle.begin(), triangle.end(), [&](const std::string& corner) {
                    return std::find(part.begin(), part.end(), corner) != part.end();
                });
            };
            if (touches(opening.upper) && touches(opening.lower))
                error(node, fmt::format("the triangle {} bridges {}", fmt::join(triangle, ", "),
                                        base::in_quotes(opening.name)));
        }
}

MarkerSet read(std::string_view text, std::vector<facs::LintFinding>& findings) {
    MarkerSet set;
    if (const auto line = facs::line_too_deep(text, deepest); line > 0) {
        findings.push_back({true, static_cast<unsigned>(line),
                            fmt::format("brackets or parts of a key go deeper than {}; is it a marker set?", deepest)});
        return set;
    }
    try {
        const toml::table document = toml::parse(text);
        set = Reader(findings).read(document);
    } catch (const toml::parse_error& e) {
        findings.push_back({true, static_cast<unsigned>(e.source().begin.line), std::string(e.description())});
    } catch (const TooManyFindings&) {  // the last of them says so
    }
    std::stable_sort(findings.begin(), findings.end(), [](const auto& a, const auto& b) { return a.line < b.line; });
    return set;
}

}  // namespace

const SetMarker* MarkerSet::find(const std::string& marker) const {
    const auto it =
        std::find_if(markers.begin(), markers.end(), [&](const SetMarker& one) { return one.name == marker; });
    return it == markers.end() ? nullptr : &*it;
}

std::vector<facs::LintFinding> lint_marker_set(std::string_view toml) {
    std::vector<facs::LintFinding> findings;
    (void)read(toml, findings);
    return findings;
}

MarkerSet decode_marker_set(std::string_view toml, const std::string& name) {
    std::vector<facs::LintFinding> findings;
    auto set = read(toml, findings);
    for (const auto& finding : findings)
        if (finding.error) throw InputError(fmt::format("{}: line {}: {}", name, finding.line, finding.what));
    set.name = name;
    return set;
}

MarkerSet read_marker_set(const std::filesystem::path& file) {
    return decode_marker_set(base::read_text(file, std::uintmax_t{4} << 20U), file.string());
}

std::string_view builtin_marker_set_text() { return embedded_set; }

const MarkerSet& builtin_marker_set() {
    static const MarkerSet set = decode_marker_set(embedded_set, "built-in marker set");
    return set;
}

geometry::Landmarks place_markers(const MarkerSet& set, const geometry::Landmarks& face) {
    std::vector<geometry::Landmark> list;
    const auto add = [&](const std::string& name, const facs::Placement& placement, facs::Side side) {
        list.push_back({name, facs::place(placement, face, side == facs::Side::right ? side : facs::Side::left), ""});
    };
    for (const auto& marker : set.markers) add(marker.name, marker.placement, marker.side);
    for (const auto& marker : set.derived) add(marker.name, marker.placement, marker.side);
    return geometry::Landmarks(std::move(list));
}

}  // namespace mimik::capture
