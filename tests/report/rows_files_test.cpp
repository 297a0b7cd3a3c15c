#include "report/rows_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "base/errors.h"
#include "base/file.h"
#include "tests/database/temporary_folder.h"

namespace mimik::report {
namespace {

using evaluation::CaseRow;
using testing::HasSubstr;

CaseRow measured() {
    CaseRow row;
    row.key = {"bs001", "bs000", "12L", "mean", 0.8};
    row.estimator = "surface_distance";
    row.region = "zone";
    row.metric = "mean";
    row.value = 0.1 + 0.2;
    row.unit = "mm";
    return row;
}
CaseRow unknown() {
    CaseRow row;
    row.key = {"", "a, 'b'", "HAPPY", "own", 1.0};
    row.estimator = "peak";
    row.region = "face";
    row.metric = "true";
    row.unit = "mm";
    row.reason = "no \"truth\"";
    return row;
}
CaseRow told() {
    CaseRow row;
    row.estimator = evaluation::run_estimator;
    row.metric = "failure";
    row.reason = "x";
    return row;
}

void three_rows(const std::function<void(const CaseRow&)>& visit) {
    for (const auto& row : {told(), measured(), unknown()}) visit(row);
}

TEST(RowsFiles, the_table_has_every_measure_and_no_word_of_the_run) {
    const database::TemporaryFolder folder;
    const auto file = folder.path() / "rows.csv";
    EXPECT_EQ(write_rows_csv(file, three_rows), 2U);
    EXPECT_EQ(base::read_text(file), std::string(evaluation::case_row_header()) + "\n" + encode_case_row(measured()) +
                                         "\n" + encode_case_row(unknown()) + "\n");
}

TEST(RowsFiles, the_database_gives_numbers_back_to_the_last_digit_and_is_the_same_each_time) {
    const database::TemporaryFolder folder;
    const auto file = folder.path() / "rows.sqlite";
    EXPECT_EQ(write_rows_sqlite(file, three_rows), 2U);
    sqlite3* handle = nullptr;
    ASSERT_EQ(sqlite3_open_v2(file.c_str(), &handle, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
    sqlite3_stmt* select = nullptr;
    ASSERT_EQ(sqlite3_prepare_v2(handle, "SELECT target, value, reason FROM rows ORDER BY rowid", -1, &select, nullptr),
              SQLITE_OK);
    ASSERT_EQ(sqlite3_step(select), SQLITE_ROW);
    EXPECT_STREQ(reinterpret_cast<const char*>(sqlite3_column_text(select, 0)), "bs000");
    EXPECT_EQ(sqlite3_column_double(select, 1), 0.1 + 0.2);
    ASSERT_EQ(sqlite3_step(select), SQLITE_ROW);
    EXPECT_STREQ(reinterpret_cast<const char*>(sqlite3_column_text(select, 0)), "a, 'b'");
    EXPECT_EQ(sqlite3_column_type(select, 1), SQLITE_NULL);
    EXPECT_STREQ(reinterpret_cast<const char*>(sqlite3_column_text(select, 2)), "no \"truth\"");
    EXPECT_EQ(sqlite3_step(select), SQLITE_DONE);
    sqlite3_finalize(select);
    sqlite3_close(handle);
    const auto first = base::read_bytes(file);
    (void)write_rows_sqlite(file, three_rows);
    EXPECT_EQ(base::read_bytes(file), first);
}

TEST(RowsFiles, a_database_that_cannot_be_written_is_named_and_the_old_one_stays) {
    const database::TemporaryFolder folder;
    const auto file = folder.path() / "rows.sqlite";
    (void)write_rows_sqlite(file, three_rows);
    const auto first = base::read_bytes(file);
    EXPECT_THROW((void)write_rows_sqlite(file, [](const auto&) { throw InputError("no rows"); }), InputError);
    EXPECT_EQ(base::read_bytes(file), first);
    base::write_atomically(folder.path() / "file", "x");
    EXPECT_THAT(database::message_of<InputError>(
                    [&] { (void)write_rows_sqlite(folder.path() / "file" / "rows.sqlite", three_rows); }),
                HasSubstr("cannot be written"));
}

}  // namespace
}  // namespace mimik::report
