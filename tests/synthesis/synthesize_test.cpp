#include "synthesis/synthesize.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "database/scan_database.h"
#include "geometry/errors.h"
#include "geometry/file.h"
#include "geometry/parallel.h"
#include "synthesis/truth.h"
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
        geometry::set_thread_count(0);
        fs::remove_all(folder_);
    }
    fs::path folder_;
    SynthesizeOptions options_;
};

std::map<std::string, std::vector<std::uint8_t>> all_files(const fs::path& root) {
    std::map<std::string, std::vector<std::uint8_t>> files;
    for (const auto& entry : fs::recursive_directory_iterator(root))
        if (entry.is_regular_file())
            files[fs::relative(entry.path(), root).string()] = geometry::read_bytes(entry.path());
    return files;
}

TEST_F(Synthesize, database_reads_back_with_its_landmarks_on_the_subjects_own_side) {
    const auto model = make_dome_model();
    const auto report = synthesize_database(folder_ / "db", *model, options_);
    EXPECT_EQ(report.scans, 2U * 5U);
    const auto database = database::open_database(folder_ / "db");
    ASSERT_EQ(database.scans.size(), 10U);
    EXPECT_FALSE(database.code_sides.swapped);
    const auto truth = open_truth(folder_ / "db");
    for (const auto& entry : database.scans) {
        const auto loaded = database::load(entry);
        EXPECT_GT(loaded.landmarks.position_mm("eye_outer_left").x(),
                  loaded.landmarks.position_mm("eye_outer_right").x());
        ASSERT_TRUE(loaded.checks.texture.has_value());
        const auto scan = load_true_scan(truth, entry.id);
        for (const auto& mark : loaded.landmarks.all())
            EXPECT_LT((mark.position_mm - scan.landmarks.position_mm(mark.name)).norm(), 6.0) << mark.name;
    }
}

TEST_F(Synthesize, truth_holds_the_pose_and_the_displacement_from_the_resting_face) {
    const auto model = make_dome_model();
    (void)synthesize_database(folder_ / "db", *model, options_);
    const auto truth = open_truth(folder_ / "db");
    EXPECT_EQ(truth.face_model, "dome");
    EXPECT_EQ(truth.landmark_vertices, model->landmark_vertices());
    EXPECT_EQ(truth.vertex_regions, model->vertex_regions());
    const auto subject = draw_subject(*model, "bs001", options_.seed, options_.variances);
    const auto scan = load_true_scan(truth, {"bs001", "LFAU", "12L", 0});
    const auto head = scan.head_vertices_mm();
    ASSERT_EQ(head.size(), subject.resting_mm.size());
    for (std::size_t i = 0; i < head.size(); ++i)
        ASSERT_LT((head[i] - scan.displacement_mm[i] - subject.resting_mm[i]).norm(), 1e-9);  // double through a pose
}

TEST_F(Synthesize, same_bytes_on_one_thread_and_on_three) {
    const auto model = make_dome_model();
    geometry::set_thread_count(1);
    (void)synthesize_database(folder_ / "one", *model, options_);
    geometry::set_thread_count(3);
    (void)synthesize_database(folder_ / "three", *model, options_);
    EXPECT_EQ(all_files(folder_ / "one"), all_files(folder_ / "three"));
    EXPECT_FALSE(fs::exists(folder_ / "one.part"));
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

TEST_F(Synthesize, expressions_without_a_shape_are_left_out_by_name) {
    const auto model = make_dome_model();
    options_.expressions = "12,4";
    const auto report = synthesize_database(folder_ / "db", *model, options_);
    EXPECT_THAT(report.skipped_expressions, testing::ElementsAre("UFAU_4 (no shape browDown_L)"));
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
        (void)open_truth(folder_ / "db");
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("truth.json"));
    }
    options_.subjects = 0;
    EXPECT_THROW((void)synthesize_database(folder_ / "other", *model, options_), InputError);
}

}  // namespace
}  // namespace mimik::synthesis
