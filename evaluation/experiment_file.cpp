#include "evaluation/experiment_file.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "facs/toml_depth.h"
#include "io/mesh_io.h"

namespace mimik::evaluation {
namespace {

constexpr std::size_t deepest = 16;  // an experiment goes 3 deep
constexpr std::size_t longest_list = 10'000;
constexpr int most_resamples = 1'000'000;

/// One table of the document: reads keys by name and refuses what is left.
class Section {
public:
    Section(const toml::table& table, std::string prefix, ExperimentFile& file)
        : table_(table), prefix_(std::move(prefix)), file_(file) {}

    [[noreturn]] void refuse(const toml::node& node, const std::string& what) const {
        throw InputError(fmt::format("{}:{}: {}", file_.name, node.source().begin.line, what));
    }
    [[noreturn]] void refuse(const std::string& key, const std::string& what) const {
        refuse(*table_.get(key), fmt::format("'{}{}' {}", prefix_, key, what));
    }

    /// Runs what may refuse a value, and puts before the refusal the line of the value.
    template <class Work>
    void checked(const toml::node& node, const Work& work) const {
        try {
            work();
        } catch (const InputError& e) {
            refuse(node, e.what());
        }
    }

    void only(std::initializer_list<std::string_view> known) const {
        const auto place = prefix_.empty() ? "here" : fmt::format("in [{}]", prefix_.substr(0, prefix_.size() - 1));
        for (const auto& [key, node] : table_)
            if (std::find(known.begin(), known.end(), key.str()) == known.end())
                refuse(node,
                       fmt::format("unknown key {}; known {}: {}", base::in_quotes(prefix_ + std::string(key.str())),
                                   place, fmt::join(known, ", ")));
    }

    /// The value of a key, its line noted; null: absent.
    const toml::node* find(const std::string& key) const {
        const auto* node = table_.get(key);
        if (node) file_.lines[prefix_ + key] = static_cast<unsigned>(node->source().begin.line);
        return node;
    }

    void take(const std::string& key, std::string& value) const {
        const auto* node = find(key);
        if (!node) return;
        if (const auto text = node->value_exact<std::string>(); text && !text->empty())
            value = *text;
        else
            refuse(key, "is not a text in quotes");
    }
    void take(const std::string& key, bool& value) const {
        const auto* node = find(key);
        if (!node) return;
        if (const auto word = node->value_exact<bool>())
            value = *word;
        else
            refuse(key, "is neither true nor false");
    }
    [[nodiscard]] std::int64_t whole(const std::string& key, const toml::node& node, std::int64_t least,
                                     std::int64_t most) const {
        const auto number = node.value_exact<std::int64_t>();
        if (number && *number >= least && *number <= most) return *number;
        refuse(node, fmt::format("'{}{}' is not a whole number from {} to {}", prefix_, key, least, most));
    }
    void take(const std::string& key, int& value, int least, int most) const {
        if (const auto* node = find(key)) value = static_cast<int>(whole(key, *node, least, most));
    }
    [[nodiscard]] double number(const std::string& key, const toml::node& node) const {
        if (const auto value = node.is_number() ? node.value<double>() : std::nullopt; value && std::isfinite(*value))
            return *value;
        refuse(node, fmt::format("'{}{}' is not a number", prefix_, key));
    }
    /// Visits the elements of a list that is not empty. @return whether the key is there
    template <class Visit>
    bool each(const std::string& key, const Visit& visit) const {
        const auto* node = find(key);
        if (!node) return false;
        const auto* list = node->as_array();
        if (!list || list->empty()) refuse(key, "is not a list of one or more: [\"...\", \"...\"]");
        if (list->size() > longest_list) refuse(key, fmt::format("has more than {} elements", longest_list));
        for (const auto& element : *list) visit(element);
        return true;
    }
    [[nodiscard]] std::string text(const std::string& key, const toml::node& element) const {
        if (const auto word = element.value_exact<std::string>(); word && !word->empty()) return *word;
        refuse(element, fmt::format("'{}{}' has an element that is not a text in quotes", prefix_, key));
    }
    std::vector<std::string> texts(const std::string& key) const {
        std::vector<std::string> list;
        each(key, [&](const toml::node& element) {
            auto word = text(key, element);
            if (std::find(list.begin(), list.end(), word) != list.end())
                refuse(element, fmt::format("'{}{}' has {} twice", prefix_, key, base::in_quotes(word)));
            list.push_back(std::move(word));
        });
        return list;
    }
    /// A table below this one; what it is called is said where it is none.
    template <class Read>
    void below(const std::string& key, const Read& read) const {
        const auto* node = table_.get(key);
        if (!node) return;
        const auto* table = node->as_table();
        if (!table) refuse(key, fmt::format("is not a table; write [{}]", key));
        read(Section(*table, prefix_ + key + ".", file_));
    }

private:
    const toml::table& table_;
    std::string prefix_;
    ExperimentFile& file_;
};

/// "all", a list of names, or a table.
SubjectChoice read_choice(const Section& section, const std::string& key, bool sources) {
    SubjectChoice choice;
    const auto* node = section.find(key);
    if (!node || node->value_exact<std::string>() == "all") return choice;
    if (node->is_array()) {
        choice.names = section.texts(key);
        return choice;
    }
    const auto forms = sources ? R"("all", a list of subjects, { sex = "f" } or { next = 4 })"
                               : R"("all", a list of subjects or { sex = "f" })";
    if (!node->is_table()) section.refuse(key, fmt::format("is none of {}", forms));
    section.below(key, [&](const Section& table) {
        if (sources)
            table.only({"sex", "next"});
        else
            table.only({"sex"});
        table.take("sex", choice.sex);
        if (!choice.sex.empty() && choice.sex != "f" && choice.sex != "m") table.refuse("sex", "is neither f nor m");
        table.take("next", choice.next, 1, static_cast<int>(longest_list));
    });
    if (choice == SubjectChoice()) section.refuse(key, fmt::format("says nothing; give {}", forms));
    return choice;
}

void read_methods(const Section& section, ExperimentFile& file) {
    section.each("methods", [&](const toml::node& element) {
        const auto name = section.text("methods", element);
        section.checked(element, [&] {
            file.methods.push_back(animation::method_by_name(name));
            for (std::size_t k = 0; k + 1 < file.methods.size(); ++k)
                if (file.methods[k]->name() == name)
                    throw InputError(fmt::format("method '{}' is asked for twice; give it once", name));
        });
    });
}

void read_expressions(const Section& section, ExperimentFile& file) {
    file.expressions = section.texts("expressions");
    for (const auto& word : file.expressions)
        if (!facs::parse_expression(word))
            section.refuse("expressions", fmt::format("has {}, which is no expression; give \"12\", \"12L\", \"HAPPY\" "
                                                      "or the like",
                                                      base::in_quotes(word)));
}

void read_evaluation(const Section& section, ExperimentFile& file) {
    section.only(
        {"zones", "whole_face", "reference", "estimators", "regions", "metrics", "area_weighted", "alignment"});
    section.each("estimators", [&](const toml::node& element) {
        const auto name = section.text("estimators", element);
        section.checked(element, [&] { file.estimators.push_back(estimator_by_name(name)); });
    });
    if (auto regions = section.texts("regions"); !regions.empty()) file.regions = std::move(regions);
    if (auto metrics = section.texts("metrics"); !metrics.empty()) file.metrics.metrics = std::move(metrics);
    section.take("area_weighted", file.metrics.area_weighted);
    std::string alignment;
    section.take("alignment", alignment);
    if (!alignment.empty())
        section.checked(*section.find("alignment"), [&] { file.alignment = alignment_by_name(alignment); });
    std::string zones;
    section.take("zones", zones);
    const auto all = {ZoneSource::automatic, ZoneSource::truth, ZoneSource::data, ZoneSource::catalogue};
    const auto* found = std::find_if(all.begin(), all.end(), [&](auto zone) { return zones == to_string(zone); });
    if (found != all.end())
        file.zones = *found;
    else if (!zones.empty())
        section.refuse("zones", "is none of automatic, truth, data, catalogue");
    section.take("whole_face", file.whole_face);
    section.take("reference", file.reference);
}

void read_statistics(const Section& section, ExperimentFile& file) {
    section.only({"resamples", "confidence"});
    constexpr int fewest_resamples = 100;
    section.take("resamples", file.resamples, fewest_resamples, most_resamples);
    if (const auto* node = section.find("confidence")) {
        file.confidence = section.number("confidence", *node);
        if (!(file.confidence >= 0.5 && file.confidence < 1))
            section.refuse("confidence", "is not from 0.5 to below 1; 0.95 is usual");
    }
}

void read_output(const Section& section, ExperimentFile& file) {
    section.only({"per_vertex"});
    section.each("per_vertex", [&](const toml::node& element) {
        const auto text = section.text("per_vertex", element);
        section.checked(element, [&] {
            auto choice = parse_case_choice(text);
            if (std::find(file.per_vertex.begin(), file.per_vertex.end(), choice) != file.per_vertex.end())
                throw InputError(fmt::format("case {} is asked for twice", base::in_quotes(text)));
            file.per_vertex.push_back(std::move(choice));
        });
    });
}

void read_document(const Section& document, ExperimentFile& file) {
    document.only({"schema", "database", "workspace", "unit", "catalogue", "emotions", "expressions", "methods",
                   "magnitudes", "seed", "subjects", "evaluation", "statistics", "output"});
    const auto* schema = document.find("schema");
    if (!schema) throw InputError(fmt::format("{}:1: 'schema' is missing; write schema = 1", file.name));
    if (schema->value_exact<std::int64_t>() != 1) document.refuse("schema", "is not 1, the one that this mimik knows");
    std::string database, workspace;
    document.take("database", database);
    document.take("workspace", workspace);
    file.database = database;
    file.workspace = workspace;
    if (!database.empty() && !workspace.empty())
        document.refuse("workspace", "stands beside 'database'; an experiment has one of them");
    document.take("unit", file.unit);
    if (!file.unit.empty()) document.checked(*document.find("unit"), [&] { (void)io::parse_length_unit(file.unit); });
    document.take("emotions", file.emotions);
    std::string catalogue;
    document.take("catalogue", catalogue);
    file.catalogue = catalogue;
    read_expressions(document, file);
    read_methods(document, file);
    std::vector<double> magnitudes;
    if (document.each("magnitudes",
                      [&](const toml::node& element) { magnitudes.push_back(document.number("magnitudes", element)); }))
        file.magnitudes = magnitudes;
    if (const auto* seed = document.find("seed"))
        file.seed = static_cast<std::uint64_t>(document.whole("seed", *seed, 0, INT64_MAX));
    document.below("subjects", [&](const Section& section) {
        section.only({"targets", "sources", "on_itself"});
        section.take("on_itself", file.on_itself);
        file.targets = read_choice(section, "targets", false);
        file.sources = read_choice(section, "sources", true);
    });
    document.below("evaluation", [&](const Section& section) { read_evaluation(section, file); });
    document.below("statistics", [&](const Section& section) { read_statistics(section, file); });
    document.below("output", [&](const Section& section) { read_output(section, file); });
    for (const auto* needed : {"expressions", "methods"})
        if (!file.lines.contains(needed)) throw InputError(fmt::format("{}:1: '{}' is missing", file.name, needed));
}

}  // namespace

ExperimentOptions ExperimentFile::options() const {
    ExperimentOptions options;
    options.methods = methods;
    options.magnitudes = magnitudes;
    options.reference = reference;
    options.whole_face = whole_face;
    options.zones = zones;
    options.on_itself = on_itself;
    options.estimators = estimators;
    options.regions = regions;
    options.metrics = metrics;
    options.alignment = alignment;
    options.max_sources = sources.next;
    return options;
}

std::string ExperimentFile::place(const std::string& key) const {
    const auto found = lines.find(key);
    return found == lines.end() ? name : fmt::format("{}:{}: {}", name, found->second, key);
}

ExperimentFile parse_experiment(std::string_view text, const std::string& name) {
    ExperimentFile file{.name = name};
    if (const auto line = facs::line_too_deep(text, deepest); line > 0)
        throw InputError(fmt::format("{}:{}: brackets or parts of a key go deeper than {}; is it an experiment?", name,
                                     line, deepest));
    toml::table document;
    try {
        document = toml::parse(text, name);
    } catch (const toml::parse_error& e) {
        throw InputError(
            fmt::format("{}:{}: {}; see docs/experiments.md", name, e.source().begin.line, e.description()));
    }
    read_document(Section(document, "", file), file);
    // What the options themselves refuse: a method twice, a magnitude of 0.
    try {
        file.options().check();
    } catch (const InputError& e) {
        throw InputError(fmt::format("{}: {}", name, e.what()));
    }
    return file;
}

ExperimentFile read_experiment_file(const std::filesystem::path& path) {
    constexpr std::uintmax_t largest = 1 << 20;
    auto file = parse_experiment(base::read_text(path, largest), path.string());
    for (auto* folder : {&file.database, &file.workspace, &file.catalogue})
        if (!folder->empty() && folder->is_relative()) *folder = (path.parent_path() / *folder).lexically_normal();
    return file;
}

}  // namespace mimik::evaluation
