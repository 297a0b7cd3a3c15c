#include "synthesis/synthesize.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/parallel.h"
#include "database/scan_database.h"
#include "database/truth.h"
#include "tests/database/temporary_folder.h"
#include "tests/synthesis/dome_model.h"

namespace mimik::synthesis {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Synthesize : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  fmt::format("mimik_{}_{}", testing::UnitTest::GetInstance()->current_test_info()->name(), getpid());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
        options_.subjects = 2;
        options_.expressions = "12,12L,1";
    }
    void TearDown() override {
        base::set_thread_count(0);
        fs::remove_all(folder_);
    }
    fs::path folder_;
    SynthesizeOptions options_;
};

std::map<std::string, std::vector<std::uint8_t>> all_files(const fs::path& root) {
    std::map<std::string, std::vector<std::uint8_t>> files;
    for (const auto& entry : fs::recursive_directory_iterator(root))
        if (entry.is_regular_file()) files[fs::relative(entry.path(), root).string()] = base::read_bytes(entry.path());
    return files;
}

TEST_F(Synthesize, database_reads_back_with_its_landmarks_on_the_subjects_own_side) {
    const auto model = make_dome_model();
    const auto report = synthesize_database(folder_ / "db", *model, options_);
    EXPECT_EQ(report.scans, 2U * 5U);
    const auto database = database::open_database(folder_ / "db");
    ASSERT_EQ(database.scans.size(), 10U);
    EXPECT_FALSE(database.code_sides.swapped);
    EXPECT_THAT(database.remarks, testing::IsEmpty());
    const auto truth = database::open_truth(folder_ / "db");
    for (const auto& entry : database.scans) {
        const auto loaded = database::load(entry);
        EXPECT_GT(loaded.landmarks.position_mm("eye_outer_left").x(),
                  loaded.landmarks.position_mm("eye_outer_right").x());
        ASSERT_TRUE(loaded.checks.texture.has_value());
        const auto scan = database::load_true_scan(truth, entry.id);
        for (const auto& mark : loaded.landmarks.all())
            EXPECT_LT((mark.position_mm - scan.landmarks.position_mm(mark.name)).norm(), 6.0) << mark.name;
    }
}

TEST_F(Synthesize, truth_holds_the_pose_and_the_displacement_from_the_resting_face) {
    const auto model = make_dome_model();
    (void)synthesize_database(folder_ / "db", *model, options_);
    const auto truth = database::open_truth(folder_ / "db");
    EXPECT_EQ(truth.face_model, "dome");
    EXPECT_EQ(truth.variances.at("identity"), options_.variances.identity);
    EXPECT_EQ(truth.variances.at("field_length_mm"), options_.variances.field_length_mm);
    EXPECT_EQ(truth.expressions, options_.expressions);
    EXPECT_EQ(truth.scanner.at("marking_jitter"), options_.scanner.marking_jitter);
    EXPECT_EQ(truth.scanner.at("spikes"), options_.scanner.spikes);
    EXPECT_EQ(truth.landmark_vertices, model->landmark_vertices());
    EXPECT_EQ(truth.vertex_regions, model->vertex_regions());
    const auto subject = draw_subject(*model, "bs001", options_.seed, options_.variances);
    const auto scan = database::load_true_scan(truth, {"bs001", "LFAU", "12L", 0});
    ASSERT_EQ(scan.vertices_mm.size(), subject.resting_mm.size());
    const auto head_from_scanner = scan.scanner_from_head.inverse();
    for (std::size_t i = 0; i < scan.vertices_mm.size(); ++i) {
        const geometry::Point head = head_from_scanner * scan.vertices_mm[i];
        ASSERT_LT((head - scan.displacement_mm[i] - subject.resting_mm[i]).norm(), 1e-9);  // double through a pose
    }
}

// Memory goes with the subjects in the making. 16 subjects of one scan on 8 threads: unbounded, the second half begins
// beside the first.
TEST_F(Synthesize, at_most_eight_subjects_are_in_the_making_at_a_time) {
    base::set_thread_count(8);
    options_.subjects = 16;
    options_.neutrals = 1;
    options_.expressions = "N";
    std::vector<std::string> done;
    options_.on_scan_done = [&](const std::string& name) { done.push_back(name); };
    (void)synthesize_database(folder_ / "db", *make_dome_model(), options_);
    ASSERT_EQ(done.size(), 16U);
    for (std::size_t i = 0; i < 8; ++i) EXPECT_LT(done[i], "bs008") << i;
}

TEST_F(Synthesize, same_bytes_on_one_thread_and_on_three) {
    const auto model = make_dome_model();
    base::set_thread_count(1);
    (void)synthesize_database(folder_ / "one", *model, options_);
    base::set_thread_count(3);
    (void)synthesize_database(folder_ / "three", *model, options_);
    EXPECT_EQ(all_files(folder_ / "one"), all_files(folder_ / "three"));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2);  // no unfinished folder
}

TEST_F(Synthesize, further_expressions_leave_the_scans_there_were_as_they_were) {
    const auto model = make_dome_model();
    (void)synthesize_database(folder_ / "few", *model, options_);
    options_.expressions = "12,12L,1,12R";
    options_.subjects = 3;
    (void)synthesize_database(folder_ / "more", *model, options_);
    const auto few = all_files(folder_ / "few"), more = all_files(folder_ / "more");
    for (const auto& [file, bytes] : few)
        if (file.starts_with("bs")) {
            EXPECT_EQ(bytes, more.at(file)) << file;
        }
}

TEST_F(Synthesize, a_place_that_cannot_be_or_a_disk_that_is_too_small_is_found_before_the_work) {
    EXPECT_NO_THROW(check_database_place(folder_ / "new" / "db", 1));
    EXPECT_FALSE(fs::exists(folder_ / "new"));
    const auto refused = [&](const fs::path& out, std::uintmax_t bytes) {
        return database::message_of<InputError>([&] { check_database_place(out, bytes); });
    };
    EXPECT_THAT(refused(folder_ / "db", std::numeric_limits<std::uintmax_t>::max()), HasSubstr("MB free"));
    base::write_atomically(folder_ / "full" / "notes.txt", "mine");
    EXPECT_THAT(refused(folder_ / "full", 0), HasSubstr("exists already"));
    EXPECT_THAT(refused(folder_ / "full/notes.txt/db", 0), HasSubstr("notes.txt"));
}

TEST_F(Synthesize, expressions_without_a_shape_are_left_out_by_name) {
    const auto model = make_dome_model();
    options_.expressions = "12,4";
    const auto report = synthesize_database(folder_ / "db", *model, options_);
    EXPECT_THAT(report.skipped_expressions, testing::ElementsAre("UFAU_4 (no shape browDown_L)"));
}

TEST_F(Synthesize, what_lies_beside_the_new_database_is_left_alone_and_nothing_is_left_there) {
    const auto model = make_dome_model();
    base::write_atomically(folder_ / "db.part" / "notes.txt", "mine");
    (void)synthesize_database(folder_ / "db", *model, options_);
    EXPECT_EQ(base::read_text(folder_ / "db.part" / "notes.txt"), "mine");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2);
    options_.on_scan_done = [](const std::string&) { throw InputError("stopped"); };
    EXPECT_THROW((void)synthesize_database(folder_ / "stopped", *model, options_), InputError);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2);
}

TEST_F(Synthesize, a_link_stays_and_the_database_is_made_where_it_leads) {
    const auto model = make_dome_model();
    fs::create_directories(folder_ / "disk" / "empty");
    fs::create_directory_symlink("disk/empty", folder_ / "to_empty");
    fs::create_directory_symlink("disk/new", folder_ / "to_new");
    for (const char* link : {"to_empty", "to_new"}) {
        (void)synthesize_database(folder_ / link, *model, options_);
        EXPECT_TRUE(fs::is_symlink(folder_ / link)) << link;
    }
    EXPECT_TRUE(fs::exists(folder_ / "disk/empty/truth/truth.json"));
    EXPECT_TRUE(fs::exists(folder_ / "disk/new/truth/truth.json"));
}

TEST_F(Synthesize, an_empty_name_and_an_empty_list_of_expressions_are_refused_by_name) {
    const auto model = make_dome_model();
    const auto error = [&](const fs::path& out) {
        return database::message_of<InputError>([&] { (void)synthesize_database(out, *model, options_); });
    };
    EXPECT_THAT(error(""), HasSubstr("OUT is empty"));
    for (const char* list : {",", " , "}) {
        options_.expressions = list;
        EXPECT_THAT(error(folder_ / "db"), HasSubstr("expressions is '" + std::string(list) + "'"));
    }
    EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Synthesize, the_sex_of_every_subject_is_read_back_as_the_truth_has_it) {
    const auto model = make_dome_model();
    options_.subjects = 6;
    options_.expressions = "12";
    (void)synthesize_database(folder_ / "db", *model, options_);
    const auto database = database::open_database(folder_ / "db");
    const auto truth = database::open_truth(folder_ / "db");
    ASSERT_EQ(truth.subjects.size(), 6U);
    for (const auto& subject : truth.subjects)
        EXPECT_EQ(database.neutrals(subject.name).at(0)->sex, subject.sex) << subject.name;
}

TEST_F(Synthesize, a_folder_in_use_and_a_folder_without_truth_are_named) {
    const auto model = make_dome_model();
    fs::create_directories(folder_ / "db" / "bs000");
    try {
        (void)synthesize_database(folder_ / "db", *model, options_);
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("exists already"));
    }
    try {
        (void)database::open_truth(folder_ / "db");
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("truth.json"));
    }
    EXPECT_THROW((void)database::open_truth(std::string(5000, 'x')), InputError);
    options_.subjects = 0;
    EXPECT_THROW((void)synthesize_database(folder_ / "other", *model, options_), InputError);
}

}  // namespace
}  // namespace mimik::synthesis
