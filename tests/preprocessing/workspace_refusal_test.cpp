// What preprocessing refuses by the doctor's words, and whom the average face does without.
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "database/bnt.h"
#include "database/bosphorus_landmarks.h"
#include "database/doctor.h"
#include "facs/facs_catalogue.h"
#include "preprocessing/preprocess_run.h"
#include "preprocessing/workspace.h"
#include "tests/database/temporary_folder.h"
#include "tests/preprocessing/quick_options.h"
#include "tests/support/analytic_database.h"

namespace mimik::preprocessing {
namespace {

namespace fs = std::filesystem;
using database::message_of;
using geometry::Point;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class WorkspaceRefusalTest : public testing::Test {
protected:
    void SetUp() override {
        test::write_analytic_database(database_);
        test::write_analytic_scan(database_, "bs003_N_N_0", {1.02, 0}, test::analytic_pose(1));
    }
    [[nodiscard]] PreprocessReport preprocess(const PreprocessOptions& options = quick()) const {
        return preprocess_database(database::open_database(database_), workspace_, facs::builtin_catalogue(), options);
    }
    void change(const std::string& name, const std::function<Point(Point)>& scan,
                const std::function<Point(const std::string&, Point)>& landmark) const {
        const auto stem = (database_ / name.substr(0, 5) / name).string();
        auto points = database::read_bnt_scan(stem + ".bnt");
        for (auto& p : points.points_mm)
            if (p.allFinite()) p = scan(p);
        database::write_bnt(stem + ".bnt", database::to_bnt(points));
        const auto loaded = database::from_bosphorus_labels(database::read_lm3(stem + ".lm3"));
        std::vector<geometry::Landmark> marks;
        for (const auto& mark : loaded.all()) marks.push_back({mark.name, landmark(mark.name, mark.position_mm), ""});
        database::write_lm3(stem + ".lm3", database::to_bosphorus_labels(geometry::Landmarks(marks)));
    }
    void change(const std::string& name, const std::function<Point(Point)>& both) const {
        change(name, both, [&](const std::string&, const Point& p) { return both(p); });
    }
    [[nodiscard]] std::string doctor(const std::string& name) const {
        const auto database = database::open_database(database_);
        const auto findings = database::check_scan(*database.find(*database::parse_scan_name(name)));
        return findings.empty() ? "" : findings.front().what + "; " + findings.front().mend;
    }

    database::TemporaryFolder folder_;
    const fs::path database_ = folder_.path() / "db", workspace_ = folder_.path() / "work";
};

TEST_F(WorkspaceRefusalTest, a_neutral_in_another_unit_or_frame_is_refused_in_the_doctors_words_and_the_rest_goes_on) {
    const std::function<Point(Point)> faults[] = {
        [](Point p) { return Point(p / 10); },                 // centimetres
        [](Point p) { return Point(p / 25.4); },               // inches
        [](Point p) { return Point(10 * p); },                 //
        [](Point p) { return Point(-p.x(), -p.y(), p.z()); },  // upside down
        [](Point p) { return Point(-p.x(), p.y(), -p.z()); },  // turned away
    };
    (void)preprocess();
    for (const auto& fault : faults) {
        test::write_analytic_scan(database_, "bs003_N_N_0", {1.02, 0}, test::analytic_pose(1));
        change("bs003_N_N_0", fault);
        const auto report = preprocess();
        ASSERT_EQ(report.failures.size(), 1U);
        EXPECT_EQ(report.failures[0].scan, "bs003_N_N_0");
        EXPECT_THAT(report.failures[0].reason, HasSubstr(doctor("bs003_N_N_0")));
        EXPECT_THAT(report.left_out, ElementsAre("bs003"));
        EXPECT_EQ(Workspace(workspace_).average().scans.size(), 3U);
    }
}

TEST_F(WorkspaceRefusalTest, an_expressive_scan_off_its_landmarks_fails_alone) {
    change(
        "bs001_LFAU_12_0", [](Point p) { return p; },
        [](const std::string&, const Point& p) { return Point(p + Point(0, 60, 0)); });
    const auto report = preprocess();
    ASSERT_EQ(report.failures.size(), 1U);
    EXPECT_EQ(report.failures[0].scan, "bs001_LFAU_12_0");
    EXPECT_THAT(report.failures[0].reason, HasSubstr("landmarks lie off the scan"));
    EXPECT_THAT(report.left_out, IsEmpty());
}

TEST_F(WorkspaceRefusalTest, a_database_in_centimetres_is_refused_as_a_whole_and_taken_with_its_unit) {
    for (const auto& entry : database::open_database(database_).scans)
        change(entry.id.name(), [](Point p) { return Point(p / 10); });
    EXPECT_THAT(message_of<InputError>([&] { (void)preprocess(); }),
                AllOf(HasSubstr("0 of 4 selected subjects have a usable neutral face"),
                      HasSubstr("looks like centimetres"), HasSubstr("and 3 more")));
    EXPECT_FALSE(fs::exists(workspace_ / "workspace.json"));
    const auto database = database::open_database(database_, io::LengthUnit::centimetre);
    const auto report = preprocess_database(database, workspace_, facs::builtin_catalogue(), quick());
    EXPECT_THAT(report.failures, IsEmpty());
    const auto marks = Workspace(workspace_).average().landmarks;
    EXPECT_NEAR((marks.position_mm("eye_outer_left") - marks.position_mm("eye_outer_right")).norm(), 90, 5);
}

TEST_F(WorkspaceRefusalTest, an_accepted_kind_of_error_is_a_remark_and_other_words_are_refused) {
    change("bs003_N_N_0", [](Point p) { return Point(1.7 * p); });
    auto options = quick();
    options.accept = {"unit"};
    EXPECT_EQ(preprocess().failures.size(), 1U);
    // Far off the others all the same: it is the doctor that was overruled.
    const auto report = preprocess(options);
    ASSERT_EQ(report.failures.size(), 1U);
    EXPECT_THAT(report.failures[0].reason, HasSubstr("times as large as those of the other neutral faces"));
    test::write_analytic_scan(database_, "bs003_N_N_0", {1.02, 0}, test::analytic_pose(1));
    change(
        "bs001_LFAU_12_0", [](Point p) { return p; },
        [](const std::string& name, const Point& p) { return Point(name == "chin" ? p + Point(0, -60, 0) : p); });
    EXPECT_EQ(preprocess().failures.size(), 1U);
    options.accept = {"landmarks-off-scan"};
    const auto accepted = preprocess(options);
    EXPECT_THAT(accepted.failures, IsEmpty());
    EXPECT_THAT(Workspace(workspace_).face(*database::parse_scan_name("bs001_LFAU_12_0")).remarks,
                testing::Contains(HasSubstr("accepted (landmarks-off-scan): ")));
    EXPECT_EQ(preprocess().failures.size(), 1U);  // not taken for finished without the option
    options.accept = {"spikes"};
    EXPECT_THAT(message_of<InputError>([&] { (void)preprocess(options); }), HasSubstr("accept is 'spikes'; give unit"));
}

TEST_F(WorkspaceRefusalTest, a_neutral_far_off_the_others_is_named_and_the_next_one_of_its_subject_takes_its_place) {
    (void)preprocess();
    const auto before = base::read_text(workspace_ / "average" / "average_face.ply");
    // A bump of the scan under the mark: nothing but the others tells that it is wrong.
    const auto off = [](const std::string& name, const Point& p) {
        return Point(name == "eye_outer_left" ? p + Point(40, 0, 0) : p);
    };
    auto options = quick();
    options.accept = {"landmarks-off-scan", "unit"};
    change(
        "bs003_N_N_0", [](Point p) { return p; }, off);
    auto report = preprocess(options);
    ASSERT_EQ(report.failures.size(), 1U);
    EXPECT_EQ(report.failures[0].scan, "bs003_N_N_0");
    EXPECT_THAT(report.failures[0].reason, HasSubstr("its landmark 'eye_outer_left' lies "));
    EXPECT_THAT(report.left_out, ElementsAre("bs003"));
    EXPECT_FALSE(fs::exists(workspace_ / "faces" / "bs003" / "bs003_N_N_0.ply"));
    test::write_analytic_scan(database_, "bs003_N_N_1", {1.02, 0}, test::analytic_pose(1));
    report = preprocess(options);
    EXPECT_EQ(report.failures.size(), 1U);
    EXPECT_THAT(report.left_out, IsEmpty());
    EXPECT_EQ(Workspace(workspace_).neutral("bs003").name(), "bs003_N_N_1");
    EXPECT_EQ(base::read_text(workspace_ / "average" / "average_face.ply"), before);
}

TEST_F(WorkspaceRefusalTest, a_neutral_whose_marks_lie_on_one_line_stops_nobody_else) {
    auto options = quick();
    options.accept = {"landmarks-off-scan", "unit", "frame", "sides"};
    change(
        "bs003_N_N_0", [](Point p) { return p; },
        [](const std::string&, const Point& p) { return Point(0, p.y(), 0); });
    const auto report = preprocess(options);
    ASSERT_EQ(report.failures.size(), 1U);
    EXPECT_EQ(report.failures[0].scan, "bs003_N_N_0");
    EXPECT_EQ(report.preprocessed, 6U);
}

}  // namespace
}  // namespace mimik::preprocessing
