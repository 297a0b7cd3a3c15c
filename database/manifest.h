#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "database/scan_database.h"

namespace mimik::database {

/// manifest.csv: one scan a line under the header
///   subject,expression,scan,landmarks,sex,unit        (any order; `subject`, `expression` and `scan` must be there)
/// `scan` and `landmarks` are paths relative to the manifest, inside its folder; `expression` is what
/// parse_expression() reads, sides the subject's own; `sex` is m, f or empty; `unit` is mm, cm, m or inch; empty: not
/// said. Scans of one subject and expression are numbered in the order of the file. Blanks and '_' in subject names
/// become '-'.
struct Manifest {
    std::vector<ScanEntry> scans;      ///< in the order of the file, paths absolute
    std::vector<std::string> remarks;  ///< subjects renamed, expressions that are not known or fall together
};
/// @throws InputError naming line, column, value and mend.
[[nodiscard]] Manifest parse_manifest(std::string_view text, const std::filesystem::path& file);

/// subjects.csv of a database in Bosphorus layout: columns `subject` and `sex` (m, f or nothing), further ones are
/// passed over. @return sex by subject in lower case. @throws InputError naming line, column and value.
[[nodiscard]] std::map<std::string, std::string> parse_subjects(std::string_view text, const std::string& name);

}  // namespace mimik::database
