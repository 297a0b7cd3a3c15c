#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "capture/retarget.h"
#include "cli/mocap_commands.h"
#include "cli/notes.h"
#include "database/hidden_subjects.h"
#include "io/json_values.h"
#include "io/landmark_io.h"

namespace mimik::cli {
namespace {

struct Arguments {
    Common common;
    Recording recording;
    std::filesystem::path labels, output;
    std::string kernel = "imq";
    capture::RetargetOptions options;
};

int run(const Arguments& arguments) {
    (void)capture::motion_format(arguments.output);  // before the work
    refuse_as_output(arguments.output, {arguments.recording.file});
    auto options = arguments.options;
    options.basis.kernel = radial_kernel_named(arguments.kernel);
    check_by_option({{"radius_ratio", "--radius-ratio"}}, [&] { options.basis.check(); });
    const auto file = arguments.recording.read();
    database::refuse_hidden_file(arguments.labels);
    const auto labels = io::read_landmarks(arguments.labels);
    std::optional<capture::Retargeted> made;
    check_by_option({{"rest_frame", "--rest-frame"}}, [&] { made = capture::retarget(file.markers, labels, options); });
    auto remarks = file.remarks;
    remarks.insert(remarks.end(), made->remarks.begin(), made->remarks.end());
    capture::write_motion(arguments.output, made->markers);
    if (arguments.common.json) {
        std::cout << io::json_text(nlohmann::json{{"schema", 1},
                                                  {"output", arguments.output.string()},
                                                  {"points", made->markers.markers()},
                                                  {"frames", made->markers.frames()},
                                                  {"rest_frame", made->rest_frame},
                                                  {"scale", made->scale},
                                                  {"remarks", remarks}});
        return exit_done;
    }
    if (!arguments.common.quiet) say_notes(remarks);
    std::cout << fmt::format("{}: {}, {}; rest in frame {}, lengths times {:.3f}\n", arguments.output.string(),
                             base::counted(made->markers.markers(), "marker"),
                             base::counted(made->markers.frames(), "frame"), made->rest_frame, made->scale);
    return exit_done;
}

}  // namespace

geometry::RadialKernel radial_kernel_named(const std::string& name) {
    using geometry::RadialKernel;
    for (const auto kernel : {RadialKernel::gaussian, RadialKernel::wendland, RadialKernel::r, RadialKernel::r2_log_r2})
        if (name == geometry::to_string(kernel)) return kernel;
    return RadialKernel::inverse_multiquadric;
}

void add_radial_kernel_option(CLI::App& command, std::string& name) {
    command.add_option("--kernel", name, "imq (inverse multiquadric), gaussian, wendland, r, r2logr")
        ->check(CLI::IsMember({"imq", "gaussian", "wendland", "r", "r2logr"}))
        ->capture_default_str();
}

void add_mocap_retarget(CLI::App& group, int& exit_code) {
    auto* command = group.add_subcommand("retarget", "Bring a recording to another face, whose markers are labelled");
    auto arguments = std::make_shared<Arguments>();
    arguments->recording.add_options(*command);
    command
        ->add_option("--to", arguments->labels,
                     "Where the markers are on that face, by their names (landmark file: .csv .pp .fcsv ...)")
        ->required();
    command->add_option("-o,--output", arguments->output, "File to write (.c3d .trc .csv)")->required();
    add_radial_kernel_option(*command, arguments->kernel);
    command->add_option("--radius-ratio", arguments->options.basis.radius_ratio,
                        "Radius of a marker's function, times the distance to its nearest (default: 1; gaussian 2, "
                        "wendland 6)");
    command->add_option("--rest-frame", arguments->options.rest_frame,
                        "Frame of the relaxed face (default: the first with the most markers)");
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
