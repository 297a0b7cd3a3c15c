// One writer, faces of one kind, and nothing damaged, stale or half written that goes unnoticed.
#include <atomic>
#include <csignal>
#include <fstream>
#include <map>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/folder_lock.h"
#include "base/parallel.h"
#include "facs/facs_catalogue.h"
#include "io/landmark_io.h"
#include "preprocessing/preprocess_run.h"
#include "preprocessing/scan_reading.h"
#include "preprocessing/workspace.h"
#include "tests/database/temporary_folder.h"
#include "tests/preprocessing/quick_options.h"
#include "tests/support/analytic_database.h"

namespace mimik::preprocessing {
namespace {

namespace fs = std::filesystem;
using database::message_of;
using testing::HasSubstr;
using testing::IsEmpty;

std::map<std::string, std::string> contents(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).string()] = base::read_text(entry.path());
    return files;
}

/// One byte of the file, which keeps its length and, as a disk does it, its time.
void damage(const fs::path& file, std::uintmax_t at) {
    const auto time = fs::last_write_time(file);
    {
        std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
        stream.seekg(static_cast<std::streamoff>(at));
        const char byte = static_cast<char>(stream.get());
        stream.seekp(static_cast<std::streamoff>(at));
        // A digit stays one: the JSON remains whole.
        stream.put(byte >= '0' && byte <= '9' ? static_cast<char>(byte == '9' ? '8' : byte + 1)
                                              : static_cast<char>(byte ^ 1));
    }
    fs::last_write_time(file, time);
}

class WorkspaceWriterTest : public testing::Test {
protected:
    void SetUp() override { test::write_analytic_database(database_); }
    [[nodiscard]] PreprocessReport preprocess(const PreprocessOptions& options = quick()) const {
        return preprocess_database(database::open_database(database_), workspace_, facs::builtin_catalogue(), options);
    }
    [[nodiscard]] fs::path face_file(const std::string& name) const {
        return workspace_ / "faces" / name.substr(0, 5) / name;
    }

    database::TemporaryFolder folder_;
    const fs::path database_ = folder_.path() / "db", workspace_ = folder_.path() / "work";
};

TEST_F(WorkspaceWriterTest, a_workspace_that_another_process_writes_is_neither_written_nor_read) {
    (void)preprocess();
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        const base::FolderLock lock(workspace_, base::FolderLock::Use::write);
        (void)!::write(ready[1], "x", 1);
        for (;;) ::pause();
    }
    char byte = 0;
    ASSERT_EQ(::read(ready[0], &byte, 1), 1);
    const auto before = contents(workspace_);
    EXPECT_THAT(message_of<InputError>([&] { (void)preprocess(); }),
                HasSubstr("work: another mimik process is writing this folder; wait until it has ended"));
    EXPECT_THAT(message_of<InputError>([&] { Workspace{workspace_}; }), HasSubstr("another mimik process is writing"));
    EXPECT_EQ(contents(workspace_), before);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    ::close(ready[0]);
    ::close(ready[1]);
    EXPECT_EQ(preprocess().up_to_date, 6U);
}

TEST_F(WorkspaceWriterTest, a_face_with_one_damaged_byte_is_noticed_and_made_anew_as_it_was) {
    (void)preprocess();
    const auto before = contents(workspace_);
    for (const auto* name : {"bs000_N_N_0.ply", "bs001_LFAU_12_0.ply"})
        damage(face_file(name), fs::file_size(face_file(name)) / 3);  // a coordinate
    const auto json = base::read_text(face_file("bs002_LFAU_12_0.json"));
    damage(face_file("bs002_LFAU_12_0.json"), json.find_first_of("0123456789", json.find("chin")));
    EXPECT_NE(contents(workspace_), before);
    EXPECT_EQ(preprocess().preprocessed, 3U);
    EXPECT_EQ(contents(workspace_), before);
    damage(workspace_ / "average" / "average_face.ply", before.at("average/average_face.ply").size() / 3);
    EXPECT_EQ(preprocess().up_to_date, 6U);
    EXPECT_EQ(contents(workspace_), before);
    const auto& average = before.at("average/average_face.json");
    damage(workspace_ / "average" / "average_face.json", average.find_first_of("123456789", average.find("chin")));
    (void)preprocess();
    EXPECT_EQ(contents(workspace_), before);
}

TEST_F(WorkspaceWriterTest, a_narrower_run_hides_nothing_and_leaves_faces_of_one_kind) {
    (void)preprocess();
    const auto before = contents(workspace_);
    auto narrower = quick();
    narrower.subjects = {"bs000", "bs001"};
    narrower.expressions = {*facs::parse_expression("12")};
    auto report = preprocess(narrower);
    EXPECT_EQ(report.up_to_date, 6U);
    EXPECT_EQ(report.from_earlier_runs, 2U);
    EXPECT_EQ(contents(workspace_), before);
    narrower.steps.cleaning.spike_mm = 5;
    report = preprocess(narrower);
    EXPECT_EQ(report.preprocessed, 6U);
    EXPECT_EQ(Workspace(workspace_).scans().size(), 6U);
}

TEST_F(WorkspaceWriterTest, a_narrower_run_that_is_stopped_hides_nothing_from_the_next) {
    struct Stopped {};
    (void)preprocess();
    auto narrower = quick();
    narrower.subjects = {"bs000", "bs001"};
    narrower.steps.cleaning.spike_mm = 5;
    base::set_thread_count(1);
    EXPECT_THROW(
        (void)preprocess_database(database::open_database(database_), workspace_, facs::builtin_catalogue(), narrower,
                                  [](const std::string& scan) {
                                      if (scan == "bs001_LFAU_12_0") throw Stopped();
                                  }),
        Stopped);
    base::set_thread_count(0);
    EXPECT_FALSE(fs::exists(workspace_ / "workspace.json"));
    EXPECT_EQ(preprocess(narrower).from_earlier_runs, 2U);
    EXPECT_EQ(Workspace(workspace_).scans().size(), 6U);
    EXPECT_FALSE(fs::exists(workspace_ / "workspace.before.json"));
}

TEST_F(WorkspaceWriterTest, what_a_killed_run_left_half_written_is_deleted_and_nothing_else) {
    (void)preprocess();
    const auto before = contents(workspace_);
    for (const char* file : {"faces/bs000/bs000_N_N_0.ply.77-0.part", "average/average_face.json.1-2.part",
                             "workspace.json.9-9.part", "sheets/bs000.png.3-1.part"})
        base::write_atomically(workspace_ / file, "half");
    base::write_atomically(workspace_ / "mine.part", "not ours");
    (void)preprocess();
    auto after = contents(workspace_);
    EXPECT_EQ(after.erase("mine.part"), 1U);
    EXPECT_EQ(after, before);
}

TEST_F(WorkspaceWriterTest, a_scan_that_is_replaced_behind_its_reader_is_read_again) {
    const auto database = database::open_database(database_);
    const auto& entry = *database.find(*database::parse_scan_name("bs001_N_N_0"));
    const auto old_marks = database::load(entry).landmarks;
    const auto file = base::read_text(entry.landmarks_file);
    const auto new_marks = [&] {  // the last landmark, 5 mm higher
        auto marks = io::read_landmarks(entry.landmarks_file);
        auto all = std::vector(marks.all().begin(), marks.all().end());
        all.back().position_mm.y() += 5;
        return geometry::Landmarks(std::move(all));
    }();
    int readings = 0;
    const auto read = read_scan(entry, {}, [&](const database::ScanEntry& asked) {
        auto loaded = database::load(asked);
        if (++readings == 1) io::write_landmarks(entry.landmarks_file, new_marks);
        return loaded;
    });
    EXPECT_EQ(readings, 2);
    EXPECT_EQ(read.stamps, stamps_of(entry));
    double moved_mm = 0;
    for (const auto& mark : old_marks.all())
        moved_mm += (read.loaded.landmarks.position_mm(mark.name) - mark.position_mm).norm();
    EXPECT_NEAR(moved_mm, 5, 1e-4);  // digits of the landmark file
}

TEST_F(WorkspaceWriterTest, a_scan_that_is_replaced_each_time_is_refused_after_five_readings) {
    const auto database = database::open_database(database_);
    const auto& entry = *database.find(*database::parse_scan_name("bs001_N_N_0"));
    const auto marks = base::read_text(entry.landmarks_file);
    int readings = 0;
    const auto replaced = [&](const database::ScanEntry& asked) {
        auto loaded = database::load(asked);
        base::write_atomically(entry.landmarks_file, marks + std::string(++readings, '\n'));
        return loaded;
    };
    EXPECT_THAT(message_of<InputError>([&] { (void)read_scan(entry, {}, replaced); }),
                HasSubstr("was replaced each of the 5 times that it was read"));
    EXPECT_EQ(readings, 5);
}

TEST_F(WorkspaceWriterTest, a_scan_that_is_replaced_while_it_is_read_is_taken_whole_or_refused) {
    const auto database = database::open_database(database_);
    const auto& entry = *database.find(*database::parse_scan_name("bs001_N_N_0"));
    const auto whole = read_scan(entry);
    EXPECT_EQ(whole.stamps, stamps_of(entry));
    EXPECT_THAT(whole.looked_for, IsEmpty());
    const auto marks = base::read_text(entry.landmarks_file);
    std::atomic<bool> stop = false;
    std::thread other([&] {
        for (int k = 0; !stop; ++k) base::write_atomically(entry.landmarks_file, marks + std::string(k % 2 + 1, '\n'));
    });
    // How often the other thread comes in between is chance: whole or refused, never half.
    for (int k = 0; k < 3; ++k)
        EXPECT_THAT(
            message_of<InputError>([&] { EXPECT_EQ(read_scan(entry).loaded.landmarks.size(), 22U); }),
            testing::AnyOf("nothing was thrown", HasSubstr("was replaced each of the 5 times that it was read")));
    stop = true;
    other.join();
    EXPECT_EQ(read_scan(entry).stamps, stamps_of(entry));
}

}  // namespace
}  // namespace mimik::preprocessing
