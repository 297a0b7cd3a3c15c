#include "database/scan_index.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "base/file.h"
#include "tests/database/made_face.h"
#include "tests/database/temporary_folder.h"

namespace mimik::database {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// A database of three scans beside a cache folder.
class ScanIndexTest : public testing::Test {
protected:
    ScanIndexTest() {
        for (const char* name : {"bs000_N_N_0", "bs000_LFAU_12L_0", "bs001_N_N_0"})
            write_scan(root(), name, make_face());
        options_.folder = folder_.path() / "cache";
    }
    [[nodiscard]] std::filesystem::path root() const { return folder_.path() / "scans"; }
    [[nodiscard]] ScanIndexResult list(bool check = false) {
        options_.check = check;
        const auto database = open_database(root());
        return scan_index(database, select(database, {}), options_);
    }
    [[nodiscard]] std::filesystem::path file() const { return scan_index_file(open_database(root()), options_); }

    TemporaryFolder folder_;
    ScanIndexOptions options_;
};

TEST_F(ScanIndexTest, a_second_listing_opens_no_scan_and_says_the_same) {
    const auto first = list();
    EXPECT_EQ(first.scans_read, 3U);
    EXPECT_EQ(first.remark, "");
    const auto second = list();
    EXPECT_EQ(second.scans_read, 0U);
    EXPECT_EQ(second.scans_remembered, 3U);
    EXPECT_EQ(second.summaries, first.summaries);
    EXPECT_EQ(second.summaries[0].points, 81U * 61U);
    EXPECT_EQ(second.summaries[0].landmarks.size(), 22U);
    EXPECT_THAT(second.summaries[0].missing_landmarks(), IsEmpty());
}

TEST_F(ScanIndexTest, nothing_is_written_into_the_database) {
    const auto names = [&] {
        std::vector<std::string> all;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root()))
            all.push_back(entry.path().string());
        std::sort(all.begin(), all.end());
        return all;
    };
    const auto before = names();
    (void)list(true);
    EXPECT_EQ(names(), before);
    EXPECT_TRUE(std::filesystem::is_regular_file(file()));
}

TEST_F(ScanIndexTest, a_file_that_changed_is_read_again) {
    (void)list();
    MadeFace face = make_face();
    face.landmarks = moved(face.landmarks, {{"chin", {0, 0, 1}}});
    write_scan(root(), "bs001_N_N_0", face);
    const auto again = list();
    EXPECT_EQ(again.scans_read, 1U);
    EXPECT_EQ(again.scans_remembered, 2U);
}

TEST_F(ScanIndexTest, the_doctors_findings_are_remembered_and_shown_by_a_plain_listing) {
    MadeFace face = make_face();
    face.scan.points_mm[25 * 61 + 30].z() += 12;
    write_scan(root(), "bs001_N_N_0", face);
    EXPECT_EQ(list().scans_read, 3U);
    const auto checked = list(true);
    EXPECT_EQ(checked.scans_read, 3U);  // listed before, but not checked
    EXPECT_EQ(list(true).scans_read, 0U);
    const auto plain = list();
    EXPECT_EQ(plain.scans_read, 0U);
    EXPECT_TRUE(plain.summaries[2].checked);
    ASSERT_EQ(plain.summaries[2].findings.size(), 1U);
    EXPECT_EQ(plain.summaries[2].findings[0].kind, "spikes");
    EXPECT_FALSE(plain.summaries[2].has_error());
}

TEST_F(ScanIndexTest, other_doctor_options_check_again) {
    (void)list(true);
    options_.doctor.spike_mm = 9;
    EXPECT_EQ(list(true).scans_read, 3U);
}

TEST_F(ScanIndexTest, an_unreadable_scan_is_listed_with_its_error) {
    std::filesystem::resize_file(root() / "bs001/bs001_N_N_0.bnt", 100);
    const auto result = list();
    EXPECT_THAT(result.summaries[2].error, HasSubstr("bs001_N_N_0.bnt: has 100 bytes"));
    EXPECT_TRUE(result.summaries[2].has_error());
    EXPECT_EQ(result.summaries[0].error, "");
    const auto again = list();
    EXPECT_EQ(again.summaries, result.summaries);
    EXPECT_EQ(again.scans_read, 1U);  // what would have to change for it to be readable is not known
    EXPECT_TRUE(list(true).summaries[2].has_error());
}

TEST_F(ScanIndexTest, an_image_that_only_the_scan_file_names_is_looked_for_again) {
    MadeFace face = make_face("skin.png");
    write_scan(root(), "bs001_N_N_0", face);
    std::filesystem::remove(root() / "bs001/bs001_N_N_0.png");
    const auto without = list(true);
    ASSERT_EQ(without.summaries[2].findings.size(), 1U);
    EXPECT_THAT(without.summaries[2].findings[0].what, HasSubstr("'skin.png' is not beside it"));
    EXPECT_EQ(list(true).scans_read, 0U);
    std::filesystem::copy_file(root() / "bs000/bs000_N_N_0.png", root() / "bs001/skin.png");
    const auto with = list(true);
    EXPECT_EQ(with.scans_read, 1U);
    EXPECT_THAT(with.summaries[2].findings, IsEmpty());
    EXPECT_EQ(list(true).scans_read, 0U);
}

TEST_F(ScanIndexTest, rows_of_a_manifest_that_share_a_scan_file_are_remembered_apart) {
    base::write_atomically(root() / "manifest.csv",
                           "subject,expression,scan,landmarks\n"
                           "anna,N,bs000/bs000_N_N_0.bnt,bs000/bs000_N_N_0.lm3\n"
                           "anna,12,bs000/bs000_N_N_0.bnt,\n");
    const auto first = list();
    const auto second = list();
    EXPECT_EQ(second.scans_read, 0U);
    EXPECT_EQ(second.summaries, first.summaries);
    EXPECT_EQ(second.summaries[0].landmarks.size(), 22U);
    EXPECT_EQ(second.summaries[1].landmarks.size(), 0U);
}

TEST_F(ScanIndexTest, a_damaged_index_is_built_anew) {
    const auto first = list();
    std::ofstream(file(), std::ios::binary | std::ios::trunc) << std::string(5000, 'x');
    const auto rebuilt = list();
    EXPECT_EQ(rebuilt.scans_read, 3U);
    EXPECT_THAT(rebuilt.remark, HasSubstr("built anew"));
    EXPECT_EQ(rebuilt.summaries, first.summaries);
    const auto after = list();
    EXPECT_EQ(after.scans_read, 0U);
    EXPECT_EQ(after.remark, "");
}

TEST_F(ScanIndexTest, damage_inside_a_row_reads_that_scan_again) {
    (void)list();
    sqlite3* handle = nullptr;
    ASSERT_EQ(sqlite3_open(file().c_str(), &handle), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(handle, "UPDATE scans SET summary = '{\"rows\": \"many\"}' WHERE file LIKE '%bs001%'",
                           nullptr, nullptr, nullptr),
              SQLITE_OK);
    sqlite3_close(handle);
    EXPECT_EQ(list().scans_read, 1U);
    EXPECT_EQ(list().scans_read, 0U);
}

TEST_F(ScanIndexTest, an_index_with_anything_but_its_tables_is_built_anew) {
    const auto change = [&](const char* sql) {
        (void)list();
        sqlite3* handle = nullptr;
        ASSERT_EQ(sqlite3_open(file().c_str(), &handle), SQLITE_OK);
        ASSERT_EQ(sqlite3_exec(handle, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(handle);
        sqlite3_close(handle);
    };
    for (const char* sql : {
             // Rows without end.
             "DROP TABLE scans; CREATE VIEW scans AS WITH RECURSIVE n(file, state, summary, check_state, findings) AS "
             "(SELECT '1', '', '', '', '' UNION ALL SELECT file + 1, '', '', '', '' FROM n) SELECT * FROM n",
             "CREATE TRIGGER t AFTER INSERT ON scans BEGIN DELETE FROM about; END",
             "ALTER TABLE scans ADD COLUMN more TEXT",
         }) {
        change(sql);
        const auto rebuilt = list();
        EXPECT_EQ(rebuilt.scans_read, 3U) << sql;
        EXPECT_THAT(rebuilt.remark, HasSubstr("built anew")) << sql;
        EXPECT_EQ(list().scans_read, 0U) << sql;
    }
    // A row of more than 16 MB is nobody's summary.
    change("UPDATE scans SET summary = zeroblob(20000000) WHERE file LIKE '%bs001%'");
    EXPECT_THAT(list().remark, HasSubstr("built anew"));
    EXPECT_EQ(list().scans_read, 0U);
}

TEST_F(ScanIndexTest, a_locked_index_is_done_without) {
    (void)list();
    sqlite3* handle = nullptr;
    ASSERT_EQ(sqlite3_open(file().c_str(), &handle), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(handle, "BEGIN EXCLUSIVE", nullptr, nullptr, nullptr), SQLITE_OK);
    const auto result = list();
    sqlite3_close(handle);
    EXPECT_EQ(result.scans_read, 3U);
    EXPECT_THAT(result.remark, HasSubstr("locked; the scans are read without an index"));
    EXPECT_EQ(list().scans_read, 0U);
}

TEST_F(ScanIndexTest, a_cache_folder_that_cannot_be_made_is_done_without) {
    base::write_atomically(folder_.path() / "cache", "a file where the folder should be");
    const auto result = list();
    EXPECT_EQ(result.scans_read, 3U);
    EXPECT_THAT(result.remark, HasSubstr("without an index"));
    EXPECT_TRUE(result.file.empty());
}

TEST_F(ScanIndexTest, without_cache_nothing_is_kept) {
    options_.use_cache = false;
    (void)list();
    EXPECT_EQ(list().scans_read, 3U);
    EXPECT_FALSE(std::filesystem::exists(options_.folder));
}

TEST_F(ScanIndexTest, a_scan_that_left_the_database_leaves_the_index) {
    (void)list();
    std::filesystem::remove_all(root() / "bs001");
    EXPECT_EQ(list().scans_remembered, 2U);
    write_scan(root(), "bs001_N_N_0", make_face());
    EXPECT_EQ(list().scans_read, 1U);
}

TEST_F(ScanIndexTest, progress_is_called_once_per_scan) {
    std::atomic<int> calls = 0;
    options_.progress = [&](const ScanEntry&) { ++calls; };
    (void)list();
    EXPECT_EQ(calls, 3);
}

TEST(ScanIndexFile, lies_in_the_users_cache_and_not_in_the_database) {
    ScanDatabase a, b;
    a.root = "/data/a";
    b.root = "/data/b";
    const char* before = std::getenv("XDG_CACHE_HOME");
    const std::string kept = before ? before : "";
    ::setenv("XDG_CACHE_HOME", "/the/cache", 1);
    EXPECT_EQ(scan_index_file(a).parent_path(), "/the/cache/mimik");
    EXPECT_NE(scan_index_file(a), scan_index_file(b));
    ::setenv("XDG_CACHE_HOME", "relative", 1);  // to be ignored, says the XDG specification
    EXPECT_TRUE(scan_index_file(a).empty() || scan_index_file(a).is_absolute());
    before ? ::setenv("XDG_CACHE_HOME", kept.c_str(), 1) : ::unsetenv("XDG_CACHE_HOME");
}

}  // namespace
}  // namespace mimik::database
