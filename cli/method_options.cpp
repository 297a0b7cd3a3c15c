#include "cli/method_options.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "animation/model_method.h"
#include "base/errors.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/nearest.h"
#include "evaluation/score.h"
#include "modeling/average_fingerprint.h"

namespace mimik::cli {

geometry::SplineKernel kernel_by_name(const std::string& name) {
    return name == "r" ? geometry::SplineKernel::r : geometry::SplineKernel::r2_log_r2;
}

namespace {

/// The methods whose models are files of control points: those that 'model', 'animate' and 'panels' take.
std::vector<std::string> model_method_names() {
    std::vector<std::string> names;
    for (const auto& method : animation::known_methods())
        if (method->needs() == animation::SourceKind::one_source &&
            dynamic_cast<const animation::ModelMethod*>(method.get()) != nullptr)
            names.push_back(method->name());
    return names;
}

const animation::ModelMethod& model_method(const std::string& name) {
    static const auto methods = animation::known_methods();
    for (const auto& method : methods)
        if (const auto* sparse = dynamic_cast<const animation::ModelMethod*>(method.get());
            sparse && sparse->name() == name)
            return *sparse;
    throw InputError(
        fmt::format("method '{}' has no control points; there are: {}", name, fmt::join(model_method_names(), ", ")));
}

}  // namespace

std::vector<std::string> method_names() {
    std::vector<std::string> names;
    for (const auto& method : animation::known_methods())
        if (method->name() != evaluation::baseline_method) names.push_back(method->name());
    return names;
}

std::string fault_of_method(const std::string& name, const std::vector<std::string>& choices) {
    const auto known = method_names();
    if (std::find(known.begin(), known.end(), name) == known.end())
        return fmt::format("--method is {}; give one of those that 'mimik help methods' lists{}", base::in_quotes(name),
                           did_you_mean(name, choices));
    if (animation::method_by_name(name)->needs() == animation::SourceKind::all_but_target)
        return fmt::format(
            "--method is '{}', which is a mean and takes no source of yours; give its method for one "
            "source and --source mean, or score it by 'mimik evaluate'",
            name);
    return fmt::format(
        "--method is '{}', which makes no model that could be kept; 'mimik evaluate' and 'mimik panels' "
        "take it, and here one of those with a * in 'mimik help methods'",
        name);
}

std::string methods_text(bool colours) {
    using animation::MethodGroup;
    constexpr std::size_t widest_name = 30;
    const auto model_names = model_method_names();
    const auto methods = animation::known_methods();
    std::string text =
        "Methods: how an expression gets on to another face. 'mimik evaluate' and 'mimik panels' take each,\n"
        "'mimik model' and 'mimik animate' those with a *. Those that learn from all but the target are marked "
        "'mean'.\n";
    for (const auto& [group, title] : {std::pair(MethodGroup::usual, "To animate faces with"),
                                       std::pair(MethodGroup::thesis, "The thesis, and steps from it"),
                                       std::pair(MethodGroup::published, "Other published methods"),
                                       std::pair(MethodGroup::simple, "What every method has to beat"),
                                       std::pair(MethodGroup::bound, "Bounds: they look at a synthetic truth")}) {
        text += colours ? fmt::format("\n\033[1m{}:\033[0m\n", title) : fmt::format("\n{}:\n", title);
        for (const auto& method : methods) {
            const auto name = method->name();
            if (method->group() != group || name == evaluation::baseline_method) continue;
            const bool model = std::find(model_names.begin(), model_names.end(), name) != model_names.end();
            const bool mean = method->needs() == animation::SourceKind::all_but_target;
            text += fmt::format("  {:<{}} {:<5}{}\n", name, widest_name,
                                model  ? "*"
                                : mean ? "mean"
                                       : "",
                                method->summary());
        }
    }
    return text;
}

bool MethodArguments::has_control_points() const {
    const auto method = animation::method_by_name(name);
    if (dynamic_cast<const animation::ModelMethod*>(method.get())) return true;
    if (!kernel.empty() || no_anchors)
        throw InputError(fmt::format("--method {} has no control points; leave --kernel and --no-anchors out", name));
    return false;
}

void MethodArguments::add_to(CLI::App& command, Methods methods) {
    command
        .add_option(
            "--method", name,
            "default (what measured best), sparse (control points alone), thesis (its equations), thesis-tuned, "
            "or another of 'mimik help methods'")
        ->check(CLI::IsMember(methods == Methods::all ? method_names() : model_method_names()))
        ->capture_default_str();
    command.add_option("--catalogue", catalogue_file, "Another FACS catalogue (TOML) than the built-in one");
    command
        .add_option("--emotions", emotions,
                    "What emotions are made of: emfacs, thesis (its Table 3-3), or a set of the catalogue")
        ->capture_default_str();
    command
        .add_option("--kernel", kernel, "Spline kernel; another than the method's own passes through every landmark")
        ->check(CLI::IsMember({"r", "r2logr"}));
    command.add_flag("--no-anchors", no_anchors, "Let the splines move what the AU leaves alone");
}

facs::FacsCatalogue MethodArguments::catalogue() const {
    const auto method = animation::method_by_name(name);
    const auto* by_points = dynamic_cast<const animation::ModelMethod*>(method.get());
    const auto own = !catalogue_file.empty() ? facs::read_catalogue(catalogue_file)
                     : by_points             ? by_points->catalogue()
                                             : facs::builtin_catalogue();
    return emotions == facs::usual_emotion_set ? own : own.with_emotions(emotions);
}

namespace {

/// The switches that models and animations share. `smoothing` is in the unit of the kernel: what was chosen for one
/// says nothing for the other, so another kernel than the method's own passes through every landmark.
template <typename Options>
void apply_switches(const MethodArguments& arguments, Options& options, double& smoothing) {
    if (!arguments.kernel.empty()) {
        const auto kernel = kernel_by_name(arguments.kernel);
        if (kernel != options.kernel) smoothing = 0;
        options.kernel = kernel;
    }
    if (arguments.no_anchors) options.anchors = false;
}

}  // namespace

modeling::ModelOptions MethodArguments::model_options() const {
    auto options = model_method(name).model_options();
    if (options.correspondence == modeling::Correspondence::dense && (!kernel.empty() || no_anchors))
        throw InputError(
            fmt::format("--kernel and --no-anchors change control points, and method '{}' moves every vertex by a "
                        "template; leave them out, or give --method sparse",
                        name));
    apply_switches(*this, options, options.smoothing);
    return options;
}

animation::AnimationOptions MethodArguments::animation_options() const {
    auto options = model_method(name).animation_options();
    apply_switches(*this, options, options.landmark_smoothing);
    return options;
}

modeling::ModelProvenance MethodArguments::provenance(const facs::FacsCatalogue& catalogue,
                                                      const preprocessing::AverageFace& average) const {
    return {MIMIK_VERSION,
            name,
            model_options(),
            catalogue.name(),
            catalogue.content_hash(),
            modeling::average_fingerprint(average)};
}

std::string MethodArguments::variant_name() const {
    auto variant = name + modeling::variant_suffix(model_options(), model_method(name).model_options());
    if (emotions != facs::usual_emotion_set) variant += "_emotions-" + emotions;
    if (!catalogue_file.empty()) variant += "_catalogue-" + std::filesystem::path(catalogue_file).stem().string();
    return variant;
}

}  // namespace mimik::cli
