#include "geometry/output_folder.h"

#include <system_error>

#include "geometry/file.h"

namespace mimik::geometry {

void check_takes_files(const std::filesystem::path& folder) {
    const auto probe = folder / "mimik.probe";
    write_atomically(probe, "");
    std::error_code ignored;
    std::filesystem::remove(probe, ignored);
}

}  // namespace mimik::geometry
