#include "cli/method_options.h"

namespace mimik::cli {

void MethodArguments::add_to(CLI::App& command) {
    command.add_option("--method", name, "thesis (as printed) or default (what measured best)")
        ->check(CLI::IsMember({"thesis", "default"}))
        ->capture_default_str();
    command.add_option("--catalogue", catalogue_file, "Another FACS catalogue (TOML) than the built-in one")
        ->check(CLI::ExistingFile);
    command.add_option("--kernel", kernel, "Spline kernel, if not the method's own")
        ->check(CLI::IsMember({"r", "r2logr"}));
    command.add_flag("--no-anchors", no_anchors, "Let the splines move what the AU leaves alone");
}

modeling::FacsCatalogue MethodArguments::catalogue() const {
    return catalogue_file.empty() ? modeling::builtin_catalogue() : modeling::read_catalogue(catalogue_file);
}

modeling::ModelOptions MethodArguments::model_options() const {
    auto options = thesis() ? modeling::ModelOptions::thesis() : modeling::ModelOptions{};
    if (!kernel.empty()) options.kernel = kernel == "r" ? geometry::SplineKernel::r : geometry::SplineKernel::r2_log_r2;
    if (no_anchors) options.anchors = false;
    return options;
}

animation::AnimationOptions MethodArguments::animation_options() const {
    auto options = thesis() ? animation::AnimationOptions::thesis() : animation::AnimationOptions{};
    if (!kernel.empty()) options.kernel = kernel == "r" ? geometry::SplineKernel::r : geometry::SplineKernel::r2_log_r2;
    if (no_anchors) options.anchors = false;
    return options;
}

}  // namespace mimik::cli
