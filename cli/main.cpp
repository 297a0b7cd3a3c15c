#include <exception>
#include <iostream>

#include "cli/command.h"
#include "geometry/errors.h"

int main(int argc, char** argv) {
    CLI::App app{"Mimik puts expressions on 3D face scans and measures how true they are."};
    app.set_version_flag("--version", MIMIK_VERSION);
    app.require_subcommand(1);
    int exit_code = mimik::cli::exit_done;
    mimik::cli::add_distance_command(app, exit_code);
    mimik::cli::add_warp_command(app, exit_code);

    try {
        app.parse(argc, argv);
        return exit_code;
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? mimik::cli::exit_done : mimik::cli::exit_bad_input;
    } catch (const mimik::InputError& e) {
        std::cerr << "mimik: " << e.what() << '\n';
        return mimik::cli::exit_bad_input;
    } catch (const mimik::NumericalError& e) {
        std::cerr << "mimik: " << e.what() << '\n';
        return mimik::cli::exit_no_answer;
    } catch (const std::exception& e) {
        std::cerr << "mimik: " << e.what() << '\n';
        return mimik::cli::exit_bad_input;
    }
}
