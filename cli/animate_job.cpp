#include "cli/animate_job.h"

#include <algorithm>
#include <iostream>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "base/version.h"
#include "cli/error_report.h"
#include "cli/notes.h"
#include "database/hidden_subjects.h"
#include "database/known_databases.h"
#include "io/json_values.h"

namespace mimik::cli {
namespace {

/// A model of a file, as good as one measured now: nobody who must not be shown is in it, and what was made otherwise
/// is said.
modeling::ExpressionModel read_model(const ExpressionShelf& shelf, const std::string& file, const std::string& target,
                                     const modeling::ModelProvenance& here, std::vector<std::string>& remarks) {
    database::refuse_hidden_file(file);  // it may lie in another workspace, whose lists hide others
    auto model = naming(file, [&] { return modeling::read_expression_model(file); });
    if (model.provenance)
        if (const auto other = modeling::differences(*model.provenance, here); !other.empty())
            remarks.push_back(fmt::format("{}: made otherwise than this animation: {}", file, fmt::join(other, "; ")));
    for (const auto& scan : model.unusable_scans)
        remarks.push_back(fmt::format("{}: left out of the mean: {}", file, scan));
    bool of_target = false;
    for (const auto& name : model.sources)
        if (const auto scan = database::parse_scan_name(name)) {
            shelf.refuse_hidden(scan->subject);
            of_target = of_target || scan->subject == target;
        }
    if (of_target) remarks.push_back(fmt::format("{}: scans of the target itself are in this model", file));
    return model;
}

void note_unusable(const modeling::ExpressionModel& model, std::vector<std::string>& failures) {
    for (const auto& scan : model.unusable_scans)
        failures.push_back(fmt::format("{}: left out of the mean: {}", model.expression.name(), scan));
}

/// Every expression that ARKit has a blendshape for and somebody shows. Of several with one blendshape (a jaw drop and
/// a stretched mouth), the one that moves farthest: a blendshape is the full motion.
/// @param taken  blendshapes that somebody asked for by name
std::vector<modeling::ExpressionModel> arkit_models(const ExpressionShelf& shelf, const facs::FacsCatalogue& catalogue,
                                                    const modeling::ExpressionSource& source,
                                                    const modeling::ModelOptions& options,
                                                    const std::set<std::string>& taken,
                                                    std::vector<std::string>& failures) {
    std::vector<modeling::ExpressionModel> models;
    std::map<std::string, std::size_t> place;  // of a blendshape's model
    for (const auto& unit : catalogue.action_units())
        for (const char* side : {"", "L", "R"}) {
            const auto expression = catalogue.find_expression(fmt::format("{}{}", unit.number, side));
            if (!expression || !shelf.shows(*expression, source)) continue;
            const auto shape = facs::arkit_shape(catalogue, *expression);
            if (shape.empty() || taken.contains(shape)) continue;
            try {
                auto model = shelf.model(catalogue, *expression, source, options);
                note_unusable(model, failures);
                const auto [at, added] = place.try_emplace(shape, models.size());
                if (added)
                    models.push_back(std::move(model));
                else if (model.largest_displacement_mm() > models[at->second].largest_displacement_mm())
                    models[at->second] = std::move(model);
            } catch (const std::exception& e) {  // the others are none the worse
                failures.push_back(fmt::format("{}: {}", expression->name(), e.what()));
            }
        }
    if (models.empty()) throw InputError("--au arkit: nobody here shows an expression that ARKit has a blendshape for");
    return models;
}

/// The expression itself where the source shows it. Else what it is made of, as the thesis does (7.2, Fig. 7-2: SADNESS
/// of AU 1 and 15): each part by its own model, so that in thesis mode each keeps its half of the face, its cut and its
/// ratio. What nobody shows is left out and said.
std::vector<facs::Expression> parts_of(const facs::Expression& expression, const ExpressionShelf& shelf,
                                       const modeling::ExpressionSource& source, const std::string& combine,
                                       std::vector<std::string>& remarks) {
    if (expression.units().size() < 2 || shelf.shows(expression, source)) return {expression};
    std::vector<facs::Expression> parts;
    std::vector<std::string> taken, missing;
    for (const auto& unit : expression.units()) {
        auto part = facs::Expression::of_units({unit});
        const bool shown = shelf.shows(part, source);
        (shown ? taken : missing).push_back(part.name());
        if (shown) parts.push_back(std::move(part));
    }
    if (parts.empty()) return {expression};  // whose error says what there is
    remarks.push_back(fmt::format(
        "{}: no scan shows it, so it is composed of {} (--combine {}){}", expression.name(), fmt::join(taken, " + "),
        combine,
        missing.empty() ? std::string()
                        : fmt::format("; {} left out, no scan shows that either", fmt::join(missing, ", "))));
    return parts;
}

std::string source_words(const AnimateArguments& arguments) {
    if (arguments.action_units.empty()) return "model files";
    const std::string source = arguments.workspace.empty() ? "built-in" : arguments.source;
    return arguments.model_files.empty() ? source : source + " and model files";
}

void print_json(const AnimateArguments& arguments, const std::string& target, const ChosenExpressions& chosen,
                const geometry::FieldExtent& extent) {
    auto list = nlohmann::json::array();
    for (std::size_t k = 0; k < chosen.models.size(); ++k)
        list.push_back({{"expression", chosen.names[k].name},
                        {"magnitude", chosen.names[k].magnitude},
                        {"sources", chosen.models[k].sources},
                        {"points", chosen.models[k].points.size()},
                        {"largest_displacement_mm", chosen.models[k].largest_displacement_mm()}});
    nlohmann::json document = {{"schema", 1},
                               {"target", target},
                               {"source", source_words(arguments)},
                               {"method", arguments.method.name},
                               {"frame", arguments.frame},
                               {"units", "mm"},
                               {"expressions", list},
                               {"largest_displacement_mm", extent.largest_displacement_mm},
                               {"largest_neighbour_step_mm", extent.largest_neighbour_step_mm},
                               {"remarks", chosen.remarks},
                               {"failures", chosen.failures},
                               {"output", arguments.output}};
    if (const auto values = animation::vertex_values_file(arguments.output); arguments.mesh.empty() && !values.empty())
        document["vertex_values"] = values.string();
    std::cout << io::json_text(document);
}

}  // namespace

std::vector<animation::WeightedExpression> ChosenExpressions::weighted() const {
    std::vector<animation::WeightedExpression> expressions;
    for (std::size_t k = 0; k < models.size(); ++k) expressions.push_back({&models[k], names[k].magnitude});
    return expressions;
}

bool asks_for_arkit(const AnimateArguments& arguments) {
    return std::any_of(arguments.action_units.begin(), arguments.action_units.end(),
                       [](const std::string& typed) { return base::equal_ignoring_case(typed, all_of_arkit); });
}

animation::Combination combination_of(const AnimateArguments& arguments) {
    return arguments.combine == "parallel" ? animation::Combination::parallel : animation::Combination::sum;
}

ChosenExpressions choose_expressions(const AnimateArguments& arguments, const ExpressionShelf& shelf,
                                     const facs::FacsCatalogue& catalogue) {
    ChosenExpressions chosen;
    const auto add = [&](modeling::ExpressionModel model, double magnitude) {
        const auto& expression = model.expression;
        chosen.names.push_back({arguments.arkit_names ? facs::arkit_name(catalogue, expression) : expression.name(),
                                magnitude, facs::arkit_shape(catalogue, expression)});
        chosen.models.push_back(std::move(model));
    };
    const modeling::ExpressionSource source{arguments.source, {arguments.target}};
    std::set<std::string> taken;  // blendshapes of what was asked for by name, at its own magnitude
    for (const auto& typed : arguments.action_units) {
        if (base::equal_ignoring_case(typed, all_of_arkit)) continue;
        const auto [text, magnitude] = facs::split_magnitude(typed);
        for (const auto& part :
             parts_of(shelf.expression(catalogue, text), shelf, source, arguments.combine, chosen.remarks)) {
            auto model = shelf.model(catalogue, part, source, arguments.method.model_options());
            note_unusable(model, chosen.failures);
            taken.insert(facs::arkit_shape(catalogue, model.expression));
            add(std::move(model), magnitude);
        }
    }
    if (asks_for_arkit(arguments))
        for (auto& model :
             arkit_models(shelf, catalogue, source, arguments.method.model_options(), taken, chosen.failures))
            add(std::move(model), 0.0);
    const auto here = arguments.method.provenance(catalogue, shelf.average());
    for (const auto& typed : arguments.model_files) {
        const auto [file, magnitude] =
            std::filesystem::exists(typed) ? facs::TypedMagnitude{typed, 1.0} : facs::split_magnitude(typed);
        auto model = read_model(shelf, file, arguments.target, here, chosen.remarks);
        // The template is bent on to the target once for all models that stand on it.
        shelf.share_registrations(model);
        if (model.dense)
            for (const auto& earlier : chosen.models)
                if (earlier.dense) modeling::share_registrations(*model.dense, earlier.dense->registrations);
        add(std::move(model), magnitude);
    }
    return chosen;
}

io::MadeBy made_by(const AnimateArguments& arguments, const ExpressionShelf& shelf, const std::string& target,
                   const std::string& subject, const ChosenExpressions& chosen) {
    std::vector<std::string> expressions;
    std::set<std::string> scans;
    for (std::size_t k = 0; k < chosen.models.size(); ++k) {
        expressions.push_back(fmt::format("{} x {}", chosen.models[k].expression.name(), chosen.names[k].magnitude));
        scans.insert(chosen.models[k].sources.begin(), chosen.models[k].sources.end());
    }
    constexpr std::size_t most_named = 8;  // a mean has hundreds
    const auto named =
        scans.size() > most_named ? fmt::format("{} scans", scans.size()) : fmt::format("{}", fmt::join(scans, " "));
    std::set<std::string> subjects;
    if (!subject.empty()) subjects.insert(subject);
    for (const auto& name : scans)
        if (const auto scan = database::parse_scan_name(name)) subjects.insert(scan->subject);
    io::MadeBy made = {
        {"made_by", fmt::format("Mimik {} animate", base::version())},
        {"source", scans.empty() ? source_words(arguments) : fmt::format("{} ({})", source_words(arguments), named)},
        {"target", target},
        {"expressions", fmt::format("{}", fmt::join(expressions, ", "))},
        {"combined_by", arguments.combine},
        {"method", arguments.method.variant_name()},
        {"frame", arguments.frame},
        // Lists of hidden subjects are heeded wherever the mesh goes (database/file_origin.h).
        {"subjects", fmt::format("{}", fmt::join(subjects, " "))}};
    if (const auto* workspace = shelf.workspace())
        made.emplace_back("database", database::remember_database(workspace->database_root()));
    return made;
}

int report_animation(const AnimateArguments& arguments, const std::string& target, ChosenExpressions& chosen,
                     const geometry::FieldExtent& extent) {
    for (const auto& model : chosen.models)
        for (const auto& reason : model.left_out)
            chosen.remarks.push_back(fmt::format("{}: {}", model.expression.name(), reason));
    if (arguments.common.json) {
        print_json(arguments, target, chosen, extent);
    } else {
        if (!arguments.common.quiet) say_notes(chosen.remarks);
        std::vector<std::string> asked = arguments.action_units;
        asked.insert(asked.end(), arguments.model_files.begin(), arguments.model_files.end());
        std::cout << fmt::format("{}: {} from {} on {}, up to {:.1f} mm\n", arguments.output, fmt::join(asked, " + "),
                                 source_words(arguments), target, extent.largest_displacement_mm);
    }
    say_failures(chosen.failures);
    return chosen.failures.empty() ? exit_done : exit_done_with_failures;
}

}  // namespace mimik::cli
