#include "base/output_folder.h"

#include <string>
#include <system_error>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/file.h"

namespace mimik::base {

void check_takes_files(const std::filesystem::path& folder) {
    std::error_code error, ignored;
    if (std::filesystem::exists(folder, ignored) && !std::filesystem::is_directory(folder, ignored))
        throw InputError(fmt::format("{}: is a file; give a folder", folder.string()));
    std::filesystem::create_directories(folder, error);
    if (error)
        throw InputError(
            fmt::format("{}: the folder cannot be made ({}); write elsewhere", folder.string(), error.message()));
    const auto probe = folder / "mimik.probe";
    try {
        write_atomically(probe, "");
    } catch (const InputError& e) {  // of the folder that was given, not of a file that nobody knows
        throw InputError(folder.string() + std::string(e.what()).substr(probe.string().size()));
    }
    std::filesystem::remove(probe, ignored);
}

}  // namespace mimik::base
