#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capture/motion_file.h"
#include "cli/command.h"
#include "geometry/radial_basis_map.h"

namespace mimik::cli {

/// The recording that a command of `mimik mocap` reads, and what goes before what its file says.
struct Recording {
    std::filesystem::path file;
    std::string unit;
    std::optional<double> rate_hz;

    void add_options(CLI::App& command);
    [[nodiscard]] capture::MotionFile read() const;
};

/// @throws InputError if the output is one of the files that are read: what Mimik does not keep of it would be lost.
/// Inputs that are empty are passed over.
void refuse_as_output(const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs);

/// --kernel of the commands that map space by points.
void add_radial_kernel_option(CLI::App& command, std::string& name);
[[nodiscard]] geometry::RadialKernel radial_kernel_named(const std::string& name);

/// Commands of `mimik mocap` that live in files of their own.
void add_mocap_clean(CLI::App& group, int& exit_code);
void add_mocap_retarget(CLI::App& group, int& exit_code);
void add_mocap_fit(CLI::App& group, int& exit_code);
void add_mocap_animate(CLI::App& group, int& exit_code);
void add_mocap_synthesize(CLI::App& group, int& exit_code);
void add_mocap_markers(CLI::App& group, int& exit_code);

}  // namespace mimik::cli
