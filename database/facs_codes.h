#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "database/scan_id.h"

namespace mimik::database {

/// One expert FACS score: action unit, side (the subject's own, as FACS has it) and intensity.
struct FacsScore {
    int action_unit = 0;
    facs::Side side = facs::Side::both;
    char intensity = 0;  ///< 'A' (trace) to 'E' (maximum); 0 where not scored

    bool operator==(const FacsScore&) const = default;
};

/// facscodes.lst of Bosphorus: two header lines, then "name -> code+code+...". A code is an optional side letter (L,
/// R), the action unit and an optional intensity letter A to E; "0" is nothing.
struct FacsCodes {
    std::map<ScanId, std::vector<FacsScore>> scores;  ///< an empty vector: scored, nothing visible
    std::vector<std::string> remarks;  ///< lines and codes that could not be understood, with file and line number
};

/// @throws InputError naming the file if there are more than 100,000 lines or none can be understood.
[[nodiscard]] FacsCodes parse_facs_codes(std::string_view text, const std::string& name);

}  // namespace mimik::database
