#include <memory>

#include "cli/command.h"
#include "cli/help_pages.h"
#include "cli/method_options.h"
#include "cli/option_faults.h"
#include "cli/performance_commands.h"
#include "cli/terminal.h"

int main(int argc, char** argv) {
    mimik::cli::prepare_standard_streams();
    CLI::App app{"Mimik puts expressions on 3D face scans and measures how true they are.", "mimik"};
    app.set_help_flag("-h,--help", "Print this help and stop");
    app.set_version_flag("-V,--version", MIMIK_VERSION, "Print the version and stop; 'mimik version' says more");
    app.require_subcommand(1);
    app.footer(
        "Ends with 0: done; 1: done, with failures that are listed; 2: bad input; 3: the numbers allow no answer.");
    int exit_code = mimik::cli::exit_done;
    mimik::cli::explain_choices("--method", mimik::cli::fault_of_method);
    // In the order of work.
    mimik::cli::add_synthesize_command(app, exit_code);
    mimik::cli::add_scans_command(app, exit_code);
    mimik::cli::add_preprocess_command(app, exit_code);
    mimik::cli::add_register_command(app, exit_code);
    mimik::cli::add_animate_command(app, exit_code);
    mimik::cli::add_model_command(app, exit_code);
    mimik::cli::add_evaluate_command(app, exit_code);
    mimik::cli::add_run_command(app, exit_code);
    mimik::cli::add_merge_command(app, exit_code);
    mimik::cli::add_report_command(app, exit_code);
    mimik::cli::add_verify_command(app, exit_code);
    mimik::cli::add_compare_command(app, exit_code);
    mimik::cli::add_tune_command(app, exit_code);
    mimik::cli::add_sensitivity_command(app, exit_code);
    mimik::cli::add_additivity_command(app, exit_code);
    mimik::cli::add_panels_command(app, exit_code);
    mimik::cli::add_figures_command(app, exit_code);
    mimik::cli::add_figure_command(app, exit_code);
    mimik::cli::add_warp_command(app, exit_code);
    mimik::cli::add_distance_command(app, exit_code);
    mimik::cli::add_mocap_command(app, exit_code);
    mimik::cli::add_capture_command(app, exit_code);
    mimik::cli::add_examples_command(app, exit_code);
    mimik::cli::add_perform_command(app, exit_code);
    mimik::cli::add_live_command(app, exit_code);
    mimik::cli::add_regions_command(app, exit_code);
    mimik::cli::add_catalogue_command(app, exit_code);
    mimik::cli::add_version_command(app, exit_code);
    mimik::cli::add_help_command(app, exit_code);
    return mimik::cli::run(app, argc, argv, exit_code);
}
