#include "base/output_folder.h"

#include <string>
#include <system_error>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/temporary.h"

namespace mimik::base {

void check_takes_files(const std::filesystem::path& folder) {
    std::error_code error, ignored;
    if (std::filesystem::exists(folder, ignored) && !std::filesystem::is_directory(folder, ignored))
        throw InputError(fmt::format("{}: is a file; give a folder", folder.string()));
    std::filesystem::create_directories(folder, error);
    if (error)
        throw InputError(
            fmt::format("{}: the folder cannot be made ({}); write elsewhere", folder.string(), error.message()));
    try {
        const TemporaryFile probe(folder);
    } catch (const std::system_error& e) {
        throw InputError(fmt::format("{}: cannot be written ({}); check the folder's permissions", folder.string(),
                                     e.code().message()));
    }
}

std::filesystem::path where_links_lead(const std::filesystem::path& file) {
    std::error_code error;
    auto place = file;
    constexpr int most_links = 40;  // as the system itself follows
    for (int k = 0; std::filesystem::is_symlink(std::filesystem::symlink_status(place, error)); ++k) {
        auto goal = std::filesystem::read_symlink(place, error);
        if (error || k == most_links)
            throw InputError(
                fmt::format("{}: is a link that leads nowhere; remove it or name another file", file.string()));
        place = place.parent_path() / goal;
    }
    return place;
}

}  // namespace mimik::base
