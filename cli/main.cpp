#include "cli/command.h"

int main(int argc, char** argv) {
    CLI::App app{"Mimik puts expressions on 3D face scans and measures how true they are.", "mimik"};
    app.set_version_flag("--version", MIMIK_VERSION);
    app.require_subcommand(1);
    int exit_code = mimik::cli::exit_done;
    mimik::cli::add_scans_command(app, exit_code);
    mimik::cli::add_animate_command(app, exit_code);
    mimik::cli::add_catalogue_command(app, exit_code);
    mimik::cli::add_distance_command(app, exit_code);
    mimik::cli::add_evaluate_command(app, exit_code);
    mimik::cli::add_figure_command(app, exit_code);
    mimik::cli::add_model_command(app, exit_code);
    mimik::cli::add_panels_command(app, exit_code);
    mimik::cli::add_preprocess_command(app, exit_code);
    mimik::cli::add_synthesize_command(app, exit_code);
    mimik::cli::add_regions_command(app, exit_code);
    mimik::cli::add_warp_command(app, exit_code);
    return mimik::cli::run(app, argc, argv, exit_code);
}
