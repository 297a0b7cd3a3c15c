#include "database/scan_index.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sqlite3.h>

#include "base/content_hash.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/parallel.h"
#include "database/known_databases.h"
#include "io/json_values.h"

namespace mimik::database {
namespace {

namespace fs = std::filesystem;

/// Raised whenever summaries or checks change their meaning: older indexes are then built anew.
constexpr int index_version = 6;

// As SQLite keeps them: a file that has anything else, such as a view or a trigger, is none of ours.
constexpr const char* about_table = "CREATE TABLE about (name TEXT PRIMARY KEY, value TEXT NOT NULL)";
constexpr const char* scans_table =
    "CREATE TABLE scans (file TEXT PRIMARY KEY, state TEXT NOT NULL, summary TEXT NOT NULL, check_state TEXT NOT NULL, "
    "findings TEXT NOT NULL)";
// A row has 1 to 2 kB: 100,000 scans fit.
constexpr int most_value_bytes = 1 << 24;
constexpr std::size_t most_bytes = std::size_t{1} << 28;

/// An index that cannot be used, with the reason; never leaves this file.
struct CacheTrouble {
    std::string reason;
    bool damaged = false;  ///< worth deleting and building anew
};

class Statement;

class Cache {
public:
    explicit Cache(const fs::path& file) : file_(file) {
        std::error_code ignored;
        fs::create_directories(file.parent_path(), ignored);
        const int status = sqlite3_open_v2(file.c_str(), &handle_, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
        try {
            expect(status, SQLITE_OK);
            sqlite3_busy_timeout(handle_, 2000);
            sqlite3_limit(handle_, SQLITE_LIMIT_LENGTH, most_value_bytes);
            sqlite3_progress_handler(
                handle_, steps_per_call, [](void* left) { return --*static_cast<int*>(left) < 0 ? 1 : 0; },
                &calls_left_);
            // A cache may lose its last moments when the power fails.
            run("PRAGMA synchronous = OFF");
            run("BEGIN IMMEDIATE");
        } catch (const CacheTrouble&) {
            sqlite3_close(handle_);
            throw;
        }
    }
    ~Cache() { sqlite3_close(handle_); }  // rolls back what was not committed
    Cache(const Cache&) = delete;
    Cache& operator=(const Cache&) = delete;

    void run(const char* sql) { expect(sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr), SQLITE_OK); }
    void expect(int status, int wanted) const {
        if (status == wanted) return;
        const int primary = status & 0xff;
        throw CacheTrouble{
            fmt::format("{}: {}", file_.string(), handle_ ? sqlite3_errmsg(handle_) : sqlite3_errstr(status)),
            primary == SQLITE_CORRUPT || primary == SQLITE_NOTADB || primary == SQLITE_ERROR ||
                primary == SQLITE_MISMATCH || primary == SQLITE_SCHEMA || primary == SQLITE_TOOBIG ||
                primary == SQLITE_INTERRUPT};
    }
    [[nodiscard]] sqlite3* handle() const { return handle_; }
    [[noreturn]] void refuse(const std::string& what) const {
        throw CacheTrouble{fmt::format("{}: {}", file_.string(), what), true};
    }

private:
    fs::path file_;
    sqlite3* handle_ = nullptr;
    // A row takes some 10 steps; a file whose pages lead in circles would take for ever.
    static constexpr int steps_per_call = 1'000'000;
    int calls_left_ = 200;
};

class Statement {
public:
    Statement(Cache& cache, const char* sql) : cache_(cache) {
        cache.expect(sqlite3_prepare_v2(cache.handle(), sql, -1, &statement_, nullptr), SQLITE_OK);
    }
    ~Statement() { sqlite3_finalize(statement_); }
    Statement(const Statement&) = delete;
    Statement& operator=(const Statement&) = delete;

    void bind(int place, const std::string& text) {
        cache_.expect(
            sqlite3_bind_text(statement_, place, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT),
            SQLITE_OK);
    }
    bool row() {
        const int status = sqlite3_step(statement_);
        if (status == SQLITE_ROW) return true;
        cache_.expect(status, SQLITE_DONE);
        return false;
    }
    void finish() {
        while (row()) {
        }
        sqlite3_reset(statement_);
    }
    [[nodiscard]] std::string text(int column) const {
        const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
        return bytes ? std::string(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)))
                     : std::string();
    }
    [[nodiscard]] int number(int column) const { return sqlite3_column_int(statement_, column); }

private:
    Cache& cache_;
    sqlite3_stmt* statement_ = nullptr;
};

/// The first neutral scan with landmarks: what one-sided codes are judged against.
const ScanEntry* neutral_of(const ScanDatabase& database, const ScanEntry& entry) {
    for (const auto* neutral : database.neutrals(entry.id.subject))
        if (!neutral->landmarks_file.empty()) return neutral;
    return nullptr;
}

/// Rows of a manifest may share a scan file.
std::string key_of(const ScanEntry& entry) { return entry.scan_file.string() + "|" + entry.id.name(); }

std::string state_of(const ScanEntry& entry) {
    return fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}", entry.id.name(), static_cast<int>(entry.layout),
                       static_cast<int>(entry.unit), base::file_stamp(entry.scan_file), entry.landmarks_file.string(),
                       base::file_stamp(entry.landmarks_file), base::file_stamp(entry.landmarks2d_file),
                       entry.texture_file.string(), base::file_stamp(entry.texture_file));
}

/// With the files that only the scan file names: they may come, go or change while it stays.
std::string state_with(std::string state, const ScanSummary& summary) {
    for (const auto& file : summary.files_looked_for) state += "|" + base::file_stamp(file);
    return state;
}

std::string check_state_of(const ScanDatabase& database, const ScanEntry& entry, const DoctorOptions& options) {
    const auto* neutral = side_shows_at_mouth(entry.id) ? neutral_of(database, entry) : nullptr;
    auto state = state_of(entry) + "|" + (neutral ? state_of(*neutral) : "");
    base::each_field(options, [&](const char*, const auto& value) { state += "|" + base::value_text(value); });
    return state;
}

std::string dump(const nlohmann::json& json) {
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string to_json(const ScanSummary& s) {
    return dump({{"rows", s.rows},
                 {"cols", s.cols},
                 {"points", s.points},
                 {"landmarks", s.landmarks},
                 {"remarks", s.remarks},
                 {"files_looked_for", s.files_looked_for},
                 {"error", s.error}});
}

ScanSummary summary_from_json(const std::string& text) {
    constexpr std::size_t most = std::size_t{1} << 31;
    const auto json = io::parse_json(text, "summary");
    ScanSummary s;
    s.rows = static_cast<int>(io::whole_number_below(most, json.at("rows"), "rows"));
    s.cols = static_cast<int>(io::whole_number_below(most, json.at("cols"), "cols"));
    s.points = io::whole_number_below(most, json.at("points"), "points");
    s.landmarks = json.at("landmarks").get<std::vector<std::string>>();
    s.remarks = json.at("remarks").get<std::vector<std::string>>();
    s.files_looked_for = json.at("files_looked_for").get<std::vector<std::string>>();
    s.error = json.at("error").get<std::string>();
    return s;
}

struct Remembered {
    std::string state, summary, check_state, findings;
};

/// Opens or makes the tables; an index of another version or of another database (same hash) is emptied.
void prepare(Cache& cache, const std::string& root) {
    int version = 0;
    {
        Statement statement(cache, "PRAGMA user_version");
        if (statement.row()) version = statement.number(0);
    }
    bool usable = version == index_version;
    if (usable) {
        Statement schema(cache, "SELECT sql FROM sqlite_master WHERE sql IS NOT NULL ORDER BY name");
        for (const char* table : {about_table, scans_table})
            if (!schema.row() || schema.text(0) != table) cache.refuse("its tables are not those of a scan index");
        if (schema.row()) cache.refuse("it has more than the tables of an index");
        Statement statement(cache, "SELECT value FROM about WHERE name = 'database'");
        usable = statement.row() && statement.text(0) == root;
    }
    if (usable) return;
    cache.run("DROP TABLE IF EXISTS about");
    cache.run("DROP TABLE IF EXISTS scans");
    cache.run(about_table);
    cache.run(scans_table);
    cache.run(fmt::format("PRAGMA user_version = {}", index_version).c_str());
    Statement statement(cache, "INSERT INTO about VALUES ('database', ?)");
    statement.bind(1, root);
    statement.finish();
}

std::map<std::string, Remembered> read_all(Cache& cache) {
    std::map<std::string, Remembered> rows;
    Statement statement(cache, "SELECT file, state, summary, check_state, findings FROM scans");
    std::size_t bytes = 0;
    while (statement.row()) {
        Remembered row{statement.text(1), statement.text(2), statement.text(3), statement.text(4)};
        // Counted also where a page that stands in two places gives one row again and again.
        bytes += 100 + row.state.size() + row.summary.size() + row.check_state.size() + row.findings.size();
        if (bytes > most_bytes) cache.refuse(fmt::format("its rows have more than {} bytes", most_bytes));
        rows[statement.text(0)] = std::move(row);
    }
    return rows;
}

void write_all(Cache& cache, const std::map<std::string, Remembered>& changed, const std::vector<std::string>& gone) {
    Statement insert(cache, "INSERT OR REPLACE INTO scans VALUES (?, ?, ?, ?, ?)");
    for (const auto& [file, row] : changed) {
        insert.bind(1, file);
        insert.bind(2, row.state);
        insert.bind(3, row.summary);
        insert.bind(4, row.check_state);
        insert.bind(5, row.findings);
        insert.finish();
    }
    Statement remove(cache, "DELETE FROM scans WHERE file = ?");
    for (const auto& file : gone) {
        remove.bind(1, file);
        remove.finish();
    }
}

/// What the index remembers of this scan, if it still holds; with findings if they do.
std::optional<ScanSummary> recall(const Remembered& row, const std::string& state, const std::string& check_state,
                                  bool check) {
    const bool checked = row.check_state == check_state;
    if (!row.state.starts_with(state) || (check && !checked)) return std::nullopt;
    try {
        ScanSummary summary = summary_from_json(row.summary);
        if (row.state != state_with(state, summary)) return std::nullopt;
        if (checked) summary.findings = findings_from_json(row.findings);
        summary.checked = checked;
        return summary;
    } catch (const nlohmann::json::exception&) {  // a damaged row is read again
    } catch (const InputError&) {
    }
    return std::nullopt;
}

void describe(const LoadedScan& loaded, ScanSummary& summary) {
    summary.rows = loaded.scan.rows;
    summary.cols = loaded.scan.cols;
    for (const auto& p : loaded.scan.points_mm) summary.points += p.allFinite() ? 1U : 0U;
    for (const auto& mark : loaded.landmarks.all()) summary.landmarks.push_back(mark.name);
    summary.remarks = loaded.remarks;
    for (const auto& file : loaded.files_looked_for) summary.files_looked_for.push_back(file.string());
}

/// Opens the scan once for summary and doctor. A bad scan must not stop the rest, whatever it throws.
ScanSummary examine(const ScanEntry& entry, const ScanEntry* neutral, const DoctorOptions& options) {
    ScanSummary summary;
    summary.checked = true;
    try {
        const LoadedScan loaded = load(entry);
        describe(loaded, summary);
        const auto neutral_landmarks = neutral ? landmarks_of(*neutral) : std::nullopt;
        summary.findings = check_scan(loaded, neutral_landmarks ? &*neutral_landmarks : nullptr, options);
        return summary;
    } catch (const std::exception& e) {
        summary.error = e.what();
    }
    try {
        summary.findings = check_scan(entry, nullptr, options);
    } catch (const std::exception& e) {
        summary.findings = {
            {Severity::error, "unreadable", e.what(), entry.scan_file.string(), "mend or replace the file"}};
    }
    return summary;
}

template <typename Act>
std::string trouble_of(Act&& act) {
    try {
        act();
        return {};
    } catch (const CacheTrouble& trouble) {
        return trouble.reason;
    }
}

}  // namespace

std::vector<std::string> ScanSummary::missing_landmarks() const {
    std::vector<std::string> missing;
    for (const auto name : geometry::standard_landmark_names())
        if (std::find(landmarks.begin(), landmarks.end(), name) == landmarks.end()) missing.emplace_back(name);
    return missing;
}

bool ScanSummary::has_error() const {
    return !error.empty() || std::any_of(findings.begin(), findings.end(),
                                         [](const Finding& f) { return f.severity == Severity::error; });
}

ScanSummary summarise(const ScanEntry& entry) {
    ScanSummary summary;
    try {
        describe(load(entry), summary);
    } catch (const std::exception& e) {  // a bad scan must not stop the listing, whatever it throws
        summary.error = e.what();
    }
    return summary;
}

fs::path scan_index_file(const ScanDatabase& database, const ScanIndexOptions& options) {
    const auto folder = options.folder.empty() ? user_cache_folder() : options.folder;
    if (folder.empty()) return {};
    base::ContentHash hash;
    hash.add(database.root.string());
    return folder / fmt::format("catalogue-{}.sqlite", hash.text());
}

ScanIndexResult scan_index(const ScanDatabase& database, std::span<const ScanEntry* const> scans,
                           const ScanIndexOptions& options) {
    options.doctor.check();
    ScanIndexResult result;
    std::map<std::string, Remembered> remembered;
    const fs::path file = options.use_cache ? scan_index_file(database, options) : fs::path();

    const auto open = [&]() -> std::unique_ptr<Cache> {
        auto cache = std::make_unique<Cache>(file);
        prepare(*cache, database.root.string());
        return cache;
    };
    if (!file.empty()) {
        try {
            auto cache = open();
            remembered = read_all(*cache);
            cache->run("COMMIT");
            result.file = file;
        } catch (const CacheTrouble& trouble) {
            result.remark = trouble.reason;
            if (trouble.damaged) {
                std::error_code ignored;
                fs::remove(file, ignored);
                for (const char* suffix : {"-journal", "-wal", "-shm"}) fs::remove(file.string() + suffix, ignored);
                result.remark += "; the index is built anew";
                result.file = file;
            } else {
                result.remark += "; the scans are read without an index";
            }
        }
    }

    const auto count = scans.size();
    result.summaries.resize(count);
    std::vector<std::string> states(count), check_states(count), keys(count);
    std::vector<char> known(count, 0);
    base::parallel_for_each(count, [&](std::size_t i) {
        const ScanEntry& entry = *scans[i];
        keys[i] = key_of(entry);
        states[i] = state_of(entry);
        check_states[i] = check_state_of(database, entry, options.doctor);
        if (const auto it = remembered.find(keys[i]); it != remembered.end())
            if (auto summary = recall(it->second, states[i], check_states[i], options.check)) {
                result.summaries[i] = std::move(*summary);
                known[i] = 1;
            }
        if (!known[i])
            result.summaries[i] =
                options.check ? examine(entry, side_shows_at_mouth(entry.id) ? neutral_of(database, entry) : nullptr,
                                        options.doctor)
                              : summarise(entry);
        if (options.progress) options.progress(entry);
    });

    std::map<std::string, Remembered> changed;
    for (std::size_t i = 0; i < count; ++i) {
        ++(known[i] ? result.scans_remembered : result.scans_read);
        // What a scan that cannot be read would have looked for is not known.
        if (known[i] || !result.summaries[i].error.empty()) continue;
        Remembered row{state_with(states[i], result.summaries[i]), to_json(result.summaries[i]),
                       options.check ? check_states[i] : std::string(), to_json(result.summaries[i].findings)};
        changed[keys[i]] = std::move(row);
    }
    // Scans that left the database leave the index.
    std::vector<std::string> gone;
    for (const auto& entry : database.scans) remembered.erase(key_of(entry));
    gone.reserve(remembered.size());
    for (const auto& [key, row] : remembered) gone.push_back(key);
    if (result.file.empty() || (changed.empty() && gone.empty())) return result;
    const std::string trouble = trouble_of([&] {
        auto cache = open();
        write_all(*cache, changed, gone);
        cache->run("COMMIT");
    });
    if (!trouble.empty()) {
        result.remark = trouble + "; what was read now is not remembered";
        result.file.clear();
    }
    return result;
}

}  // namespace mimik::database
