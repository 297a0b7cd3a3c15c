#include "database/database_names.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::database {

void check_path_is_utf8(const std::filesystem::path& path, const char* what) {
    if (!base::is_utf8(path.string()))
        throw InputError(
            fmt::format("{}: {}'s path has bytes that are no UTF-8, which JSON files cannot keep; rename it (letters, "
                        "digits and '-' are safe)",
                        path.string(), what));
}

void check_names(const ScanDatabase& database) {
    check_path_is_utf8(database.root, "the folder");
    const ScanEntry* last = nullptr;  // scans are sorted by subject, case ignored
    for (const auto& entry : database.scans) {
        check_path_is_utf8(entry.scan_file, "the scan");
        check_path_is_utf8(entry.landmarks_file, "the landmark file");
        const auto& subject = entry.id.subject;
        if (base::equal_ignoring_case(subject, "mean"))
            throw InputError(
                fmt::format("{}: its subject is called '{}', which is the word for the mean of all "
                            "subjects; give the subject another name",
                            entry.scan_file.string(), subject));
        if (last && base::equal_ignoring_case(last->id.subject, subject) && last->id.subject != subject)
            throw InputError(
                fmt::format("{} and {}: subjects '{}' and '{}' differ by case alone; write one spelling, "
                            "or give one of them another name if they are two people",
                            last->scan_file.string(), entry.scan_file.string(), last->id.subject, subject));
        last = &entry;
    }
}

}  // namespace mimik::database
