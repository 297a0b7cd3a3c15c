#include <unistd.h>

#include "base/file.h"
#include "database/scan_index.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {
namespace {

namespace fs = std::filesystem;

/// A folder of this process for SQLite, which reads files alone, and a database whose scans are not there.
struct Place {
    Place() {
        folder = fs::temp_directory_path() / ("mimik-fuzz-" + std::to_string(::getpid()));
        fs::create_directories(folder);
        database.root = "/nowhere";
        for (const char* name : {"bs000_N_N_0", "bs000_LFAU_12L_0"}) {
            database::ScanEntry entry;
            entry.id = *database::parse_scan_name(name);
            entry.scan_file = database.root / (std::string(name) + ".bnt");
            database.scans.push_back(entry);
        }
        options.folder = folder;
        options.check = true;
        file = database::scan_index_file(database, options);
    }
    ~Place() { fs::remove_all(folder); }
    void clear() const {
        for (const char* suffix : {"", "-journal", "-wal", "-shm"}) fs::remove(file.string() + suffix);
    }
    database::ScanIndexResult list() const {
        std::vector<const database::ScanEntry*> scans;
        for (const auto& entry : database.scans) scans.push_back(&entry);
        auto result = database::scan_index(database, scans, options);
        require(result.summaries.size() == 2 && result.scans_read + result.scans_remembered == 2,
                "every scan has a summary, whatever the catalogue holds");
        for (const auto& summary : result.summaries) require(summary.checked, "the doctor has seen every scan");
        return result;
    }

    fs::path folder, file;
    database::ScanDatabase database;
    database::ScanIndexOptions options;
};

const Place& place() {
    static const Place here;
    return here;
}

}  // namespace

/// The SQLite file in the user's cache.
void fuzz_one(std::span<const std::uint8_t> bytes) {
    place().clear();
    std::ofstream(place().file, std::ios::binary) << text_of(bytes);
    const auto first = place().list();
    const auto second = place().list();
    // What was kept and found sound reads back.
    if (!first.file.empty() && !second.file.empty() && second.remark.empty())
        require(second.summaries == first.summaries, "a second listing says the same");
}

std::vector<std::string> seeds() {
    place().clear();
    (void)place().list();
    return {base::read_text(place().file), "SQLite format 3"};
}

}  // namespace mimik::fuzzing
