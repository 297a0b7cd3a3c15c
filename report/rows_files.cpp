#include "report/rows_files.h"

#include <fstream>
#include <memory>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <sqlite3.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/temporary.h"

namespace mimik::report {
namespace {

using evaluation::CaseRow;

/// A database that is written once, from start to end.
class Database {
public:
    Database(const std::filesystem::path& file, std::string name) : name_(std::move(name)) {
        const int status = sqlite3_open_v2(file.c_str(), &handle_, SQLITE_OPEN_READWRITE, nullptr);
        try {
            expect(status, SQLITE_OK);
        } catch (...) {
            sqlite3_close(handle_);
            throw;
        }
    }
    ~Database() {
        sqlite3_finalize(insert_);
        sqlite3_close(handle_);
    }
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    void run(const char* sql) { expect(sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr), SQLITE_OK); }
    void prepare_insert(const char* sql) { expect(sqlite3_prepare_v2(handle_, sql, -1, &insert_, nullptr), SQLITE_OK); }

    void insert(const CaseRow& row) {
        int place = 0;
        const auto text = [&](const std::string& value) {
            expect(sqlite3_bind_text(insert_, ++place, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT),
                   SQLITE_OK);
        };
        for (const auto* value : {&row.key.source, &row.key.target, &row.key.expression, &row.key.method}) text(*value);
        expect(sqlite3_bind_double(insert_, ++place, row.key.magnitude), SQLITE_OK);
        for (const auto* value : {&row.estimator, &row.region, &row.metric}) text(*value);
        ++place;
        expect(row.value ? sqlite3_bind_double(insert_, place, *row.value) : sqlite3_bind_null(insert_, place),
               SQLITE_OK);
        for (const auto* value : {&row.unit, &row.reason}) text(*value);
        expect(sqlite3_step(insert_), SQLITE_DONE);
        expect(sqlite3_reset(insert_), SQLITE_OK);
    }

private:
    void expect(int status, int wanted) const {
        if (status == wanted) return;
        throw InputError(fmt::format("{}: cannot be written ({}); check the folder and the disk", name_,
                                     handle_ ? sqlite3_errmsg(handle_) : sqlite3_errstr(status)));
    }

    std::string name_;
    sqlite3* handle_ = nullptr;
    sqlite3_stmt* insert_ = nullptr;
};

std::size_t fill(Database& database, const ReadRows& read) {
    // A file that is thrown away when anything fails needs no journal.
    database.run("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF;");
    database.run(
        "CREATE TABLE rows (source TEXT, target TEXT, expression TEXT, method TEXT, magnitude REAL, estimator TEXT, "
        "region TEXT, metric TEXT, value REAL, unit TEXT, reason TEXT); BEGIN;");
    database.prepare_insert("INSERT INTO rows VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    std::size_t count = 0;
    read([&](const CaseRow& row) {
        if (row.estimator == evaluation::run_estimator) return;
        database.insert(row);
        ++count;
    });
    database.run("CREATE INDEX by_method ON rows (expression, method, estimator, region, metric); COMMIT;");
    return count;
}

}  // namespace

std::size_t write_rows_csv(const std::filesystem::path& file, const ReadRows& read) {
    std::size_t count = 0;
    base::write_atomically(file, [&](std::ostream& out) {
        out << evaluation::case_row_header() << '\n';
        read([&](const CaseRow& row) {
            if (row.estimator == evaluation::run_estimator) return;
            out << evaluation::encode_case_row(row) << '\n';
            ++count;
        });
    });
    return count;
}

void read_rows_csv(const std::filesystem::path& file, const std::function<void(const evaluation::CaseRow&)>& visit) {
    constexpr std::size_t longest = std::size_t{1} << 16;
    std::ifstream in(file, std::ios::binary);
    if (!in)
        throw InputError(fmt::format("{}: cannot be read; give the folder of a finished 'mimik run'", file.string()));
    std::string line(longest, '\0');
    std::size_t number = 0;
    const auto fail = [&](const char* what) {
        throw InputError(fmt::format("{}:{}: {}; run the experiment again", file.string(), number, what));
    };
    while (in.getline(line.data(), static_cast<std::streamsize>(line.size()))) {
        ++number;
        const std::string text = line.c_str();
        if (number == 1) {
            if (text != evaluation::case_row_header()) fail("is not the header of a table of rows");
            continue;
        }
        const auto row = evaluation::decode_case_row(text);
        if (!row) fail("is no row");
        visit(*row);
    }
    if (!in.eof()) fail("is longer than 64 kB");
    if (number == 0) fail("is empty");
}

std::size_t write_rows_sqlite(const std::filesystem::path& file, const ReadRows& read) {
    try {
        if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
        base::TemporaryFile temporary(file.parent_path());
        std::size_t count = 0;
        {
            Database database(temporary.path(), file.string());
            count = fill(database, read);
        }
        temporary.become(file);
        return count;
    } catch (const std::system_error& e) {
        throw InputError(
            fmt::format("{}: cannot be written ({}); check the folder", file.string(), e.code().message()));
    }
}

}  // namespace mimik::report
