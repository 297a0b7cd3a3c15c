#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "database/scan_database.h"

// Reading a scan for preprocessing: stamped before and after, and refused where the doctor says that lengths on it
// cannot be trusted.

namespace mimik::preprocessing {

/// The state of a scan's files.
struct ScanStamps {
    std::string shape;  ///< what the shape and the landmarks come from: all that the average face and other scans take
    std::string whole;  ///< that, and what else a face takes from an entry; image and image landmarks decide together
                        ///< how the texture lies

    bool operator==(const ScanStamps&) const = default;
};
[[nodiscard]] ScanStamps stamps_of(const database::ScanEntry& entry);

/// A file that only the scan file names, and its state when the scan was read: an image may come or change later.
struct LookedFor {
    std::filesystem::path file;
    std::string stamp;

    bool operator==(const LookedFor&) const = default;
};

struct ReadScan {
    database::LoadedScan loaded;
    ScanStamps stamps;
    std::vector<LookedFor> looked_for;
};

/// The kinds of the doctor's errors that refuse a scan (database/doctor.h) and can be accepted.
[[nodiscard]] const std::vector<std::string>& kinds_that_refuse();

/// A scan whose files are not replaced while they are read: if they are, it is read again. A scan without landmarks,
/// with some on the other side, or that the doctor refuses, is found out before it is gridded.
/// @param accepted  kinds of the doctor's errors that become a remark
/// @param load      how the files are read
/// @throws InputError in the doctor's words; or if the files change all the time.
[[nodiscard]] ReadScan read_scan(
    const database::ScanEntry& entry, const std::vector<std::string>& accepted = {},
    const std::function<database::LoadedScan(const database::ScanEntry&)>& load = database::load);

}  // namespace mimik::preprocessing
