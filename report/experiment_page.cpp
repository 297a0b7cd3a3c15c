#include "report/experiment_page.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <kainjow/mustache.hpp>
#include <nlohmann/json.hpp>

#include "animation/method.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "evaluation/plan.h"
#include "evaluation/score.h"
#include "figures/colour_map.h"
#include "io/json_values.h"

namespace mimik::report {
namespace {

using evaluation::CaseRow;
using nlohmann::json;
using nlohmann::ordered_json;
namespace mustache = kainjow::mustache;

std::string dumped(const ordered_json& document) {
    return document.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

ordered_json json_of(const std::optional<double>& value) { return value ? ordered_json(*value) : ordered_json(); }

/// "AU12L" for "12L"; words as they are.
std::string label_of(const std::string& code) {
    return !code.empty() && code.front() >= '0' && code.front() <= '9' ? "AU" + code : code;
}

/// What the catalogue calls it: "Lip Corner Puller"; empty: several units, or it does not know.
std::string words_of(const facs::FacsCatalogue& catalogue, const std::string& code) {
    const auto expression = catalogue.find_expression(code);
    if (!expression || expression->own_word()) return {};
    const auto units = catalogue.units(*expression);
    if (units.size() != 1 || !units.front().unit) return {};
    const auto side = units.front().side;
    return units.front().unit->name + (side == facs::Side::left    ? " (left)"
                                       : side == facs::Side::right ? " (right)"
                                                                   : "");
}

/// A method of the rows, or "mean@0.8".
struct Variant {
    std::string name, title, kind;
    bool judged = true;  ///< neither doing nothing nor what looks at the truth
};

Variant variant_named(const std::string& name) {
    const auto bare = name.substr(0, name.find('@'));
    Variant variant{name, name, "", bare != evaluation::baseline_method};
    for (const auto& method : animation::known_methods()) {
        if (method->name() != bare) continue;
        variant.title = method->title() + name.substr(bare.size());
        variant.kind = animation::to_string(method->needs());
        variant.judged = variant.judged && !method->needs_truth();
    }
    return variant;
}

/// The entry of scores.json; null: there is none.
json score_row(const json& scores, const Variant& variant) {
    for (const auto& row : scores.at("rows"))
        if (row.at("method") == variant.title || row.at("method") == variant.name) return row;
    return {};
}

/// Those that the table of methods shows beside what the comparison says.
constexpr std::array score_fields = {"share",      "explained_median",      "explained_whole_face", "still_skin_mm",
                                     "peak_ratio", "lip_aperture_error_mm", "lips_over_hole"};

ordered_json methods_json(const evaluation::Comparison& comparison, const json& scores) {
    std::vector<std::string> names;
    for (const auto& summary : comparison.methods)
        if (std::find(names.begin(), names.end(), summary.method) == names.end()) names.push_back(summary.method);
    auto methods = ordered_json::array();
    for (const auto& name : names) {
        const auto variant = variant_named(name);
        const auto row = score_row(scores, variant);
        ordered_json entry = {
            {"name", name}, {"title", variant.title}, {"kind", variant.kind}, {"judged", variant.judged}};
        for (const auto* field : score_fields)
            entry[field] = row.contains(field) ? ordered_json(row.at(field)) : ordered_json();
        std::size_t cases = 0, worse = 0;
        if (row.contains("expressions"))
            for (const auto& [code, score] : row.at("expressions").items()) {
                cases += score.at("cases").get<std::size_t>();
                worse += score.at("worse_than_nothing").get<std::size_t>();
            }
        entry["worse_share"] =
            cases == 0 ? ordered_json() : ordered_json(static_cast<double>(worse) / static_cast<double>(cases));
        methods.push_back(entry);
    }
    return methods;
}

ordered_json results_json(const evaluation::Comparison& comparison) {
    auto results = ordered_json::array();
    for (const auto& s : comparison.methods) {
        if (s.region != comparison.methods.front().region) continue;
        results.push_back({{"expression", s.expression},
                           {"method", s.method},
                           {"cases", s.cases},
                           {"targets", s.targets},
                           {"error_mm", s.error},
                           {"explained", json_of(s.explained)},
                           {"low", s.explained_interval ? ordered_json(s.explained_interval->low) : ordered_json()},
                           {"high", s.explained_interval ? ordered_json(s.explained_interval->high) : ordered_json()}});
    }
    return results;
}

ordered_json differences_json(const evaluation::Comparison& comparison) {
    auto differences = ordered_json::array();
    for (const auto& d : comparison.differences) {
        if (d.region != comparison.methods.front().region) continue;
        differences.push_back({{"expression", d.expression},
                               {"first", d.first},
                               {"second", d.second},
                               {"pairs", d.pairs},
                               {"difference_mm", d.difference},
                               {"low", d.interval ? ordered_json(d.interval->low) : ordered_json()},
                               {"high", d.interval ? ordered_json(d.interval->high) : ordered_json()},
                               {"dz", json_of(d.dz)},
                               {"p", d.p},
                               {"q", d.q}});
    }
    return differences;
}

/// One target, expression and method: its mean error over the sources, and that of doing nothing.
struct PageCase {
    std::string target, expression, method;
    std::size_t cases = 0;
    double error = 0, nothing = 0;
    [[nodiscard]] double explained() const { return 1 - error / nothing; }
};

std::vector<PageCase> page_cases(const evaluation::CaseRowReader& read, const evaluation::ComparisonOptions& options) {
    std::map<std::array<std::string, 2>, double> nothing;
    const auto visit_wanted = [&](const auto& visit) {
        read([&](const CaseRow& row) {
            if (row.estimator == options.estimator && row.region == options.regions.front() &&
                row.metric == options.metric && row.value)
                visit(row);
        });
    };
    visit_wanted([&](const CaseRow& row) {
        if (row.key.method == evaluation::baseline_method) nothing[{row.key.target, row.key.expression}] = *row.value;
    });
    std::map<std::array<std::string, 3>, std::size_t> place;
    std::map<std::string, bool> judged;  // by variant
    std::vector<PageCase> cases;
    visit_wanted([&](const CaseRow& row) {
        const auto found = nothing.find({row.key.target, row.key.expression});
        if (found == nothing.end() || found->second <= evaluation::least_motion_mm) return;
        const auto variant = evaluation::variant_of(row.key);
        if (!judged.contains(variant)) judged[variant] = variant_named(variant).judged;
        if (!judged[variant]) return;
        const auto [at, is_new] = place.emplace(std::array{row.key.target, row.key.expression, variant}, cases.size());
        if (is_new) cases.push_back({row.key.target, row.key.expression, variant, 0, 0, found->second});
        auto& one = cases[at->second];
        one.error += *row.value;
        ++one.cases;
    });
    for (auto& one : cases) one.error /= static_cast<double>(one.cases);
    return cases;
}

/// Names once, then rows of places in them: a tenth of the bytes.
ordered_json cases_json(std::vector<PageCase> cases, std::size_t most) {
    const auto all = cases.size();
    if (all > most) {
        std::stable_sort(cases.begin(), cases.end(),
                         [](const auto& a, const auto& b) { return a.explained() < b.explained(); });
        cases.erase(cases.begin() + static_cast<std::ptrdiff_t>(most / 2),
                    cases.end() - static_cast<std::ptrdiff_t>(most - most / 2));
    }
    std::array<std::vector<std::string>, 3> names;
    const auto place_of = [](std::vector<std::string>& known, const std::string& name) {
        const auto found = std::find(known.begin(), known.end(), name);
        if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
        known.push_back(name);
        return known.size() - 1;
    };
    auto rows = ordered_json::array();
    for (const auto& one : cases)
        rows.push_back({place_of(names[0], one.target), place_of(names[1], one.expression),
                        place_of(names[2], one.method), one.cases, one.error, one.nothing});
    return {{"targets", names[0]},
            {"expressions", names[1]},
            {"methods", names[2]},
            {"rows", rows},
            {"left_out", all - cases.size()}};
}

/// Those of the figures, so that a page and a figure say the same in colour.
ordered_json colours_json() {
    constexpr int steps = 64;
    auto colours = ordered_json::array();
    for (int k = 0; k <= steps; ++k) {
        const auto colour = figures::map_colour(figures::ColourMap::sequential, static_cast<double>(k) / steps);
        colours.push_back(fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]));
    }
    return colours;
}

}  // namespace

std::string page_data(const evaluation::CaseRowReader& read, const PageExperiment& experiment,
                      const facs::FacsCatalogue& catalogue) {
    const auto comparison = evaluation::compare_methods(read, experiment.comparison);
    return io::read_json_document(
        experiment.scores, "scores.json", "run the experiment again", [&](const json& scores) {
            auto expressions = ordered_json::array();
            for (const auto& code : scores.at("expressions").get<std::vector<std::string>>())
                expressions.push_back(
                    {{"code", code}, {"label", label_of(code)}, {"words", words_of(catalogue, code)}});
            return dumped({{"schema", 1},
                           {"title", experiment.title},
                           {"unit", comparison.unit},
                           {"confidence", experiment.comparison.confidence},
                           {"synthetic", !scores.at("truth").is_null()},
                           {"expressions", expressions},
                           {"methods", methods_json(comparison, scores)},
                           {"results", results_json(comparison)},
                           {"anchors", scores.at("anchors")},
                           {"differences", differences_json(comparison)},
                           {"cases", cases_json(page_cases(read, experiment.comparison), experiment.most_cases)},
                           {"colours", colours_json()}});
        });
}

PageParts read_page_parts(const std::filesystem::path& folder) {
    return {base::read_text(folder / "page.mustache"), base::read_text(folder / "style.css"),
            base::read_text(folder / "page.js")};
}

std::string json_for_script(const std::string& text) {
    std::string safe;
    safe.reserve(text.size());
    for (std::size_t k = 0; k < text.size(); ++k) {
        const std::string_view rest(text.data() + k, text.size() - k);
        if (text[k] == '<')
            safe += "\\u003c";  // ends no script, begins no comment
        else if (text[k] == '&')
            safe += "\\u0026";
        else if (rest.starts_with("\xe2\x80\xa8") || rest.starts_with("\xe2\x80\xa9")) {
            safe += rest[2] == '\xa8' ? "\\u2028" : "\\u2029";
            k += 2;
        } else
            safe += text[k];
    }
    return safe;
}

namespace {

/// A value of experiment.json in words: lists by commas, objects as "name value".
std::string in_words(const ordered_json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    if (value.is_null()) return "none";
    if (!value.is_structured()) return value.dump();
    std::string text;
    for (const auto& [key, inner] : value.items())
        text += (text.empty() ? "" : ", ") + (value.is_object() ? key + " " : std::string()) + in_words(inner);
    return text.empty() ? (value.is_array() ? "all" : "none") : text;
}

/// "max_sources" as people write it.
std::string key_in_words(std::string key) {
    std::replace(key.begin(), key.end(), '_', ' ');
    return key;
}

mustache::data named(const std::string& name, const std::string& value) {
    mustache::data entry;
    entry.set("name", name);
    entry.set("value", value);
    return entry;
}

/// What was run, in the order of experiment.json.
mustache::data provenance(const ordered_json& identity) {
    mustache::data list{mustache::data::type::list};
    const auto add = [&](const ordered_json& object, const std::set<std::string>& without) {
        for (const auto& [key, value] : object.items())
            if (!without.contains(key)) list << named(key_in_words(key), in_words(value));
    };
    add(identity, {"schema", "experiment", "inputs", "truth"});
    if (identity.contains("experiment")) add(identity.at("experiment"), {"methods", "expressions"});
    const auto inputs = identity.value("inputs", ordered_json::object());
    for (const auto& [key, value] : inputs.items())
        if (!value.is_null()) list << named("hash of the " + key_in_words(key), in_words(value));
    if (identity.contains("truth")) add(identity.at("truth"), {});
    return list;
}

mustache::data methods_in_words(const ordered_json& identity) {
    mustache::data list{mustache::data::type::list};
    if (!identity.contains("experiment")) return list;
    for (const auto& method : identity.at("experiment").value("methods", ordered_json::array())) {
        const auto name = method.value("name", "");
        mustache::data entry;
        entry.set("name", name);
        entry.set("source", method.value("source", ""));
        std::string summary;
        for (const auto& known : animation::known_methods())
            if (known->name() == name) summary = known->summary();
        entry.set("summary", summary);
        for (const auto* key : {"model", "animation"}) entry.set(key, method.value(key, ""));
        entry.set("has_options", method.contains("model"));
        list << entry;
    }
    return list;
}

mustache::data lines(const std::vector<std::string>& texts) {
    mustache::data list{mustache::data::type::list};
    for (const auto& text : texts) {
        mustache::data entry;
        entry.set("text", text);
        list << entry;
    }
    return list;
}

/// The best method of each kind of source, as a sentence each.
std::vector<std::string> findings(const json& data) {
    std::vector<std::string> sentences;
    std::map<std::string, std::string> kind_of;
    for (const auto& method : data.at("methods"))
        if (method.at("judged")) kind_of[method.at("name")] = method.at("kind");
    std::map<std::string, json> best;
    const bool one = data.at("expressions").size() == 1;
    for (const auto& result : data.at("results")) {
        if ((!one && result.at("expression") != "") || result.at("explained").is_null()) continue;
        const auto kind = kind_of.find(result.at("method"));
        if (kind == kind_of.end()) continue;
        auto& holder = best[kind->second];
        if (holder.is_null() || result.at("explained") > holder.at("explained")) holder = result;
    }
    for (const auto& [kind, result] : best) {
        const auto interval =
            result.at("low").is_null()
                ? std::string(" (too few subjects for an interval)")
                : fmt::format(" ({:g} % interval {:.2f} to {:.2f})", 100 * data.at("confidence").get<double>(),
                              result.at("low").get<double>(), result.at("high").get<double>());
        sentences.push_back(fmt::format("{}: {} explains {:.2f} of the motion{}, and is {:.2f} mm off the real scan.",
                                        kind == "mean"   ? "Of the methods that learn from everybody else"
                                        : kind == "none" ? "Of the methods that learn from nobody"
                                                         : "Of the methods that learn from one person",
                                        result.at("method").get<std::string>(), result.at("explained").get<double>(),
                                        interval, result.at("error_mm").get<double>()));
    }
    return sentences;
}

std::vector<std::string> anchors_in_words(const json& data) {
    std::vector<std::string> sentences;
    for (const auto& anchor : data.at("anchors")) {
        if (anchor.at("unknown").is_null()) continue;
        auto text = fmt::format("The {} is unknown: {}.", anchor.at("title").get<std::string>(),
                                anchor.at("unknown").get<std::string>());
        if (anchor.contains("published_mm"))
            text += fmt::format(" Published: {} to {} mm (Johnston et al. 2003).", anchor.at("published_mm")[0].dump(),
                                anchor.at("published_mm")[1].dump());
        sentences.push_back(text);
    }
    if (!data.at("synthetic")) sentences.emplace_back("The true field is unknown: the database has no truth.");
    return sentences;
}

void refuse_end_of(const std::string& tag, const std::string& text, const char* what) {
    if (base::lower_case(text).find("</" + tag) != std::string::npos)
        throw InputError(fmt::format("{} of the page holds '</{}', which ends it; build it again", what, tag));
}

}  // namespace

std::string experiment_page(const PageParts& parts, const PageExperiment& experiment, const std::string& data_text,
                            const std::string& faces) {
    refuse_end_of("script", parts.script, "the script");
    refuse_end_of("style", parts.style, "the style");
    const auto data = io::parse_json(data_text, "the page's data");
    const auto scores = io::parse_json(experiment.scores, "scores.json");
    const auto identity = ordered_json::parse(experiment.identity, nullptr, false);
    const auto failures = scores.value("failures", std::vector<std::string>());
    mustache::data page;
    page.set("title", experiment.title);
    page.set("synthetic", data.at("synthetic").get<bool>());
    page.set("subjects", std::to_string(scores.at("subjects").size()));
    page.set("expressions", base::counted(data.at("expressions").size(), "expression"));
    page.set("zones", scores.value("zones", ""));
    page.set("alignment", scores.value("alignment", ""));
    page.set("confidence", fmt::format("{:g}", 100 * experiment.comparison.confidence));
    page.set("findings", lines(findings(data)));
    page.set("anchors", lines(anchors_in_words(data)));
    page.set("has_failures", !failures.empty());
    page.set("failure_count", base::counted(failures.size(), "failure"));
    page.set("failures", lines(failures));
    page.set("has_remarks", !experiment.remarks.empty());
    page.set("remarks", lines(experiment.remarks));
    page.set("methods", methods_in_words(identity));
    page.set("provenance", identity.is_object() ? provenance(identity) : mustache::data(mustache::data::type::list));
    page.set("style", parts.style);
    page.set("script", parts.script);
    page.set("data", json_for_script(data_text));
    page.set("faces", json_for_script(faces.empty() ? "null" : faces));
    mustache::mustache form(parts.page);
    if (!form.is_valid()) throw InputError(fmt::format("page.mustache: {}", form.error_message()));
    return form.render(page);
}

}  // namespace mimik::report
