#include "preprocessing/scan_reading.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <exception>
#include <optional>
#include <system_error>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>

#include "base/errors.h"
#include "base/file.h"
#include "database/bnt.h"
#include "database/doctor.h"

namespace mimik::preprocessing {

using database::ScanEntry;
namespace fs = std::filesystem;

namespace {

using Load = std::function<database::LoadedScan(const ScanEntry&)>;

database::LoadedScan load_marked(const ScanEntry& entry, const std::vector<std::string>& accepted, const Load& load) {
    auto loaded = load(entry);
    if (const auto& swapped = loaded.checks.sides.swapped_pairs; !swapped.empty())
        throw InputError(fmt::format("{}: left and right of {} are exchanged against the rest; exchange the labels",
                                     entry.landmarks_file.string(), fmt::join(swapped, ", ")));
    if (loaded.landmarks.all().empty()) {
        if (!entry.landmarks_file.empty())
            throw InputError(
                fmt::format("{}: there is no landmark in it; mark the face", entry.landmarks_file.string()));
        throw InputError(fmt::format("no landmark file beside {}; put {} there", entry.scan_file.string(),
                                     entry.scan_file.stem().string() + ".lm3"));
    }
    const auto& kinds = kinds_that_refuse();
    for (const auto& finding : database::reasons_to_refuse(loaded)) {
        // A landmark in another's place is the user's to judge: the scan lies where it should.
        if (std::find(kinds.begin(), kinds.end(), finding.kind) == kinds.end()) continue;
        if (std::find(accepted.begin(), accepted.end(), finding.kind) == accepted.end())
            throw InputError(fmt::format("{} ({}): {}; {}", finding.where, finding.kind, finding.what, finding.mend));
        loaded.remarks.push_back(fmt::format("accepted ({}): {}", finding.kind, finding.what));
    }
    return loaded;
}

double seconds_of(const timespec& time) {
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}
double now_s() {
    timespec time{};
    ::clock_gettime(CLOCK_REALTIME, &time);
    return seconds_of(time);
}

/// Also if it was replaced by an older file: that is a change of its state, not of its content.
bool changed_since(const fs::path& file, double time_s) {
    struct stat status {};
    constexpr double clock_step_s = 0.02;  // of the kernel's clock for files, which stands behind
    return ::stat(file.c_str(), &status) == 0 && seconds_of(status.st_ctim) >= time_s - clock_step_s;
}

}  // namespace

ScanStamps stamps_of(const ScanEntry& entry) {
    ScanStamps stamps;
    stamps.shape = fmt::format("{} {} unit {}", base::file_stamp(entry.scan_file),
                               base::file_stamp(entry.landmarks_file), static_cast<int>(entry.unit));
    // Of meshes alone, whose pictures may be painted anew: raise it when they come out otherwise.
    const char* const pictures = database::is_bnt(entry.scan_file) ? "" : " pictures 1";
    stamps.whole =
        fmt::format("{} sex '{}' texture '{}' {} {}{}", stamps.shape, entry.sex, entry.texture_file.string(),
                    base::file_stamp(entry.texture_file), base::file_stamp(entry.landmarks2d_file), pictures);
    return stamps;
}

const std::vector<std::string>& kinds_that_refuse() {
    static const std::vector<std::string> kinds = {"unit", "frame", "sides", "landmarks-off-scan"};
    return kinds;
}

ReadScan read_scan(const ScanEntry& entry, const std::vector<std::string>& accepted, const Load& load) {
    constexpr int most_readings = 5;
    std::vector<LookedFor> known;  // as it was before this reading
    for (int reading = 0; reading < most_readings; ++reading) {
        if (reading > 0) std::this_thread::sleep_for(std::chrono::milliseconds(50));  // a copy comes to its end
        const double begun_s = now_s();
        const auto before = stamps_of(entry);
        std::optional<database::LoadedScan> loaded;
        std::exception_ptr fault;
        try {
            loaded = load_marked(entry, accepted, load);
        } catch (const InputError&) {
            fault = std::current_exception();  // of the file, or of half a file
        }
        if (stamps_of(entry) != before) continue;
        if (fault) std::rethrow_exception(fault);
        std::vector<LookedFor> looked_for;
        for (const auto& file : loaded->files_looked_for) looked_for.push_back({file, base::file_stamp(file)});
        const bool settled =
            looked_for == known || std::none_of(looked_for.begin(), looked_for.end(),
                                                [&](const LookedFor& one) { return changed_since(one.file, begun_s); });
        if (settled) return {std::move(*loaded), before, std::move(looked_for)};
        known = std::move(looked_for);
    }
    throw InputError(
        fmt::format("{}: it or a file beside it was replaced each of the {} times that it was read; wait until it is "
                    "copied and run again",
                    entry.scan_file.string(), most_readings));
}

}  // namespace mimik::preprocessing
