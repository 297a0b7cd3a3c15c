#include "preprocessing/workspace.h"

#include <algorithm>
#include <atomic>
#include <fstream>
#include <functional>
#include <map>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/parallel.h"
#include "database/bosphorus_landmarks.h"
#include "database/hidden_subjects.h"
#include "facs/facs_catalogue.h"
#include "io/image.h"
#include "io/mesh_io.h"
#include "preprocessing/preprocess_run.h"
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

facs::Expression smile() { return facs::builtin_catalogue().expression("12"); }

/// The same Action Units in a text of its own.
const facs::FacsCatalogue& other_catalogue() {
    static const auto catalogue =
        facs::parse_catalogue(std::string(facs::builtin_catalogue_text()) + "# mine\n", "mine.toml");
    return catalogue;
}

std::map<std::string, std::string> contents(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).string()] = base::read_text(entry.path());
    return files;
}

class WorkspaceTest : public testing::Test {
protected:
    void SetUp() override { test::write_analytic_database(database_); }
    [[nodiscard]] PreprocessReport preprocess(const PreprocessOptions& options = quick()) const {
        return preprocess_database(database::open_database(database_), workspace_, *catalogue_, options);
    }
    [[nodiscard]] fs::path face_file(const std::string& name) const {
        return workspace_ / "faces" / name.substr(0, 5) / name;
    }

    database::TemporaryFolder folder_;
    const fs::path database_ = folder_.path() / "db", workspace_ = folder_.path() / "work";
    const facs::FacsCatalogue* catalogue_ = &facs::builtin_catalogue();
};

TEST_F(WorkspaceTest, every_scan_becomes_a_face_and_an_expression_lies_on_its_neutral) {
    const auto report = preprocess();
    EXPECT_EQ(report.preprocessed, 6U);
    EXPECT_EQ(report.up_to_date, 0U);
    EXPECT_TRUE(report.failures.empty());
    const Workspace workspace(workspace_);
    EXPECT_THAT(workspace.subjects(), ElementsAre("bs000", "bs001", "bs002"));
    EXPECT_EQ(workspace.average().scans.size(), 3U);
    for (int k = 0; k < 3; ++k) {
        const auto face = workspace.face(*workspace.scan_of("bs00" + std::to_string(k), smile()));
        const auto neutral_from_scan = test::analytic_pose(2 * k) * test::analytic_pose(2 * k + 1).inverse();
        for (const auto* name : {"brow_outer_left", "eye_inner_right", "chin"}) {
            const Point& mark = face.landmarks.position_mm(name);
            // The 2 mm scan and the 60 x 60 grid (2.5 x 3.1 mm) round the relief that holds the face in x and y: bumps
            // of 5 to 14 mm width keep some tenths of a millimetre, most at the chin, the farthest from the stable
            // part.
            EXPECT_LT((face.neutral_from_scan * mark - neutral_from_scan * mark).norm(), 0.6) << k << " " << name;
        }
        const auto neutral = workspace.face(workspace.neutral(face.id.subject));
        EXPECT_TRUE(neutral.neutral_from_scan.matrix().isIdentity(0));
        EXPECT_TRUE(face.average_from_scan.matrix().isApprox(
            (neutral.average_from_scan * face.neutral_from_scan).matrix(), 1e-12));
    }
}

TEST_F(WorkspaceTest, a_second_run_finds_everything_done_and_changes_no_byte) {
    (void)preprocess();
    const auto before = contents(workspace_);
    std::atomic<int> told = 0;
    const auto report = preprocess_database(database::open_database(database_), workspace_, *catalogue_, quick(),
                                            [&](const std::string&) { ++told; });
    EXPECT_EQ(report.preprocessed, 0U);
    EXPECT_EQ(report.up_to_date, 6U);
    EXPECT_EQ(told, 6);
    EXPECT_EQ(contents(workspace_), before);
}

TEST_F(WorkspaceTest, deleted_cut_and_garbled_files_are_made_again_as_they_were) {
    (void)preprocess();
    const auto before = contents(workspace_);
    fs::remove(face_file("bs000_LFAU_12_0.ply"));
    fs::resize_file(face_file("bs001_LFAU_12_0.json"), 100);
    fs::remove(face_file("bs001_N_N_0.ply"));
    {
        std::fstream neutral(face_file("bs002_N_N_0.json"), std::ios::in | std::ios::out);
        neutral << "not";  // the same length, and no JSON any more
    }
    fs::resize_file(workspace_ / "average" / "average_face.ply", 200);
    const auto report = preprocess();
    EXPECT_EQ(report.preprocessed, 4U);
    EXPECT_EQ(report.up_to_date, 2U);
    EXPECT_TRUE(report.failures.empty());
    EXPECT_EQ(contents(workspace_), before);
}

TEST_F(WorkspaceTest, another_option_or_another_scan_is_preprocessed_anew) {
    (void)preprocess();
    auto options = quick();
    options.steps.cleaning.spike_mm = 5;
    EXPECT_EQ(preprocess(options).preprocessed, 6U);
    EXPECT_EQ(preprocess(options).up_to_date, 6U);
    test::write_analytic_scan(database_, "bs001_LFAU_12_0", {1.0, 4}, test::analytic_pose(3), 1.5);
    const auto report = preprocess(options);
    EXPECT_EQ(report.preprocessed, 1U);
    EXPECT_EQ(report.up_to_date, 5U);
}

TEST_F(WorkspaceTest, what_a_manifest_says_of_a_scan_belongs_to_what_its_face_was_made_from) {
    const auto as_it_is = database::open_database(database_);
    const auto id = *database::parse_scan_name("bs001_LFAU_12_0");
    const auto run_with = [&](const std::function<void(database::ScanEntry&)>& correct) {
        auto database = as_it_is;
        for (auto& entry : database.scans)
            if (entry.id == id) correct(entry);
        return preprocess_database(database, workspace_, *catalogue_, quick());
    };
    const std::function<void(database::ScanEntry&)> corrections[] = {
        [](database::ScanEntry& entry) { entry.unit = io::LengthUnit::metre; },
        [](database::ScanEntry& entry) { entry.sex = "f"; },
        [](database::ScanEntry& entry) { entry.texture_file = "other.png"; }};
    (void)preprocess();
    for (const auto& correct : corrections) {
        const auto report = run_with(correct);
        EXPECT_EQ(report.preprocessed + report.failures.size(), 1U);  // done anew, whether it can be used or not
        EXPECT_EQ(report.up_to_date, 5U);
        (void)preprocess();
    }
}

TEST_F(WorkspaceTest, an_image_that_only_the_scan_file_names_counts_from_the_run_after_it_came) {
    auto database = database::open_database(database_);
    const auto image = database_ / "bs001" / "skin.png";
    for (auto& entry : database.scans) {
        if (entry.id.subject != "bs001") continue;
        geometry::Mesh mesh;
        for (const auto& p : database::load(entry).scan.points_mm)
            if (p.allFinite()) mesh.vertices_mm.push_back(p);
        mesh.texture_coordinates.assign(mesh.vertices_mm.size(), {0.5, 0.5});
        entry.scan_file.replace_extension(".ply");
        io::write_mesh(entry.scan_file, mesh, {.texture_file = "skin.png"});
    }
    const auto run = [&] { return preprocess_database(database, workspace_, *catalogue_, quick()); };
    const auto texture_of = [&](const char* name) {
        return Workspace(workspace_).face(*database::parse_scan_name(name)).texture_file;
    };
    EXPECT_EQ(run().preprocessed, 6U);
    EXPECT_EQ(run().up_to_date, 6U);
    EXPECT_EQ(texture_of("bs001_LFAU_12_0"), "");
    io::write_png(image, {2, 2, std::vector<std::uint8_t>(12, 99)});
    EXPECT_EQ(run().preprocessed, 2U);  // neutral and smile
    EXPECT_EQ(texture_of("bs001_N_N_0"), image);
    EXPECT_EQ(texture_of("bs001_LFAU_12_0"), image);
    EXPECT_EQ(run().up_to_date, 6U);
    fs::remove(image);
    EXPECT_EQ(run().preprocessed, 2U);
    EXPECT_EQ(texture_of("bs001_LFAU_12_0"), "");
}

TEST_F(WorkspaceTest, an_image_or_image_landmarks_that_come_change_or_go_make_that_face_anew_as_in_a_fresh_workspace) {
    const auto name = [&](const char* extension) {
        return database_ / "bs001" / (std::string("bs001_N_N_0") + extension);
    };
    const auto write_image = [&](int width, int height) {
        io::write_png(name(".png"),
                      {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(3 * width * height), 99)});
    };
    // Pixels of a photograph that stands on its head: the texture coordinates have to be turned.
    const auto write_marks = [&] {
        std::vector<database::ImageLandmark> marks;
        const auto labelled = database::to_bosphorus_labels(test::AnalyticFace{}.landmarks());
        for (const auto& mark : labelled.all())
            marks.push_back({mark.name, mark.position_mm.x() + 75, mark.position_mm.y() + 85});
        database::write_lm2(name(".lm2"), marks);
    };
    const auto expect_anew = [&](const std::string& what) {
        const auto report = preprocess();
        EXPECT_EQ(report.preprocessed, 1U) << what;  // neither the average nor another face rests on it
        EXPECT_EQ(report.up_to_date, 5U) << what;
        const auto fresh = folder_.path() / "fresh";
        (void)preprocess_database(database::open_database(database_), fresh, *catalogue_, quick());
        EXPECT_TRUE(contents(workspace_) == contents(fresh)) << what;  // too long to print
        fs::remove_all(fresh);
        return Workspace(workspace_).face(*database::parse_scan_name("bs001_N_N_0")).remarks;
    };
    using testing::IsEmpty;
    const auto turned = testing::Contains(HasSubstr("texture coordinates lie u to the right, v up and were turned"));
    write_image(150, 180);
    base::write_atomically(name(".lm2"), "# damaged\n");
    (void)preprocess();
    write_marks();
    EXPECT_THAT(expect_anew("mended"), turned);
    fs::remove(name(".lm2"));
    EXPECT_THAT(expect_anew("gone"), IsEmpty());
    write_marks();
    EXPECT_THAT(expect_anew("come"), turned);
    write_image(1500, 1800);
    EXPECT_THAT(expect_anew("another image"), ElementsAre(HasSubstr("does not fit the scan")));
    fs::remove(name(".png"));
    EXPECT_THAT(expect_anew("no image"), IsEmpty());
}

TEST_F(WorkspaceTest, remarks_of_every_face_written_in_a_run_come_once_also_of_neutrals_that_are_only_tied_anew) {
    for (const char* name : {"bs001_N_N_0", "bs001_LFAU_12_0"})
        base::write_atomically(database_ / "bs001" / (std::string(name) + ".lm2"), "# damaged\n");
    const auto remarked = [](const PreprocessReport& report) {
        std::vector<std::string> scans;
        for (const auto& remark : report.remarks)
            if (remark.remark.find(".lm2: ") != std::string::npos) scans.push_back(remark.scan);
        return scans;
    };
    const auto both = testing::UnorderedElementsAre("bs001_N_N_0", "bs001_LFAU_12_0");
    auto options = quick();
    options.subjects = {"bs000", "bs001"};
    EXPECT_THAT(remarked(preprocess(options)), both);
    EXPECT_THAT(remarked(preprocess(options)), testing::IsEmpty());
    const auto report = preprocess();  // another average: every neutral is tied anew
    EXPECT_EQ(report.preprocessed, 6U);
    EXPECT_THAT(remarked(report), both);
}

TEST_F(WorkspaceTest, closed_lips_are_counted_and_other_landmarks_on_one_grid_vertex_are_remarked) {
    const auto marks = geometry::transformed(test::AnalyticFace{1.0, 6}.landmarks(), test::analytic_pose(3));
    const auto put = [&](const std::string& name, const std::string& on) {
        std::vector<geometry::Landmark> together;
        for (const auto& mark : marks.all())
            together.push_back({mark.name, marks.position_mm(mark.name == name ? on : mark.name), ""});
        database::write_lm3(database_ / "bs001" / "bs001_LFAU_12_0.lm3",
                            database::to_bosphorus_labels(geometry::Landmarks(together)));
    };
    put("lower_lip_inner", "upper_lip_inner");
    auto options = quick();
    options.steps.gridding.rows =
        100;  // 1.5 mm between rows: the inner lips of the others, 2 mm apart, keep their vertices
    const auto report = preprocess(options);
    EXPECT_TRUE(report.remarks.empty());
    EXPECT_THAT(report.closed_lips, ElementsAre("bs001_LFAU_12_0"));
    EXPECT_TRUE(preprocess(options).closed_lips.empty());  // of the faces written, as remarks are
    put("brow_middle_left", "brow_inner_left");
    const auto brows = preprocess(options);
    EXPECT_TRUE(brows.closed_lips.empty());
    ASSERT_EQ(brows.remarks.size(), 1U);
    EXPECT_EQ(brows.remarks[0].scan, "bs001_LFAU_12_0");
    EXPECT_THAT(brows.remarks[0].remark, AllOf(HasSubstr("brow_middle_left"), HasSubstr("brow_inner_left")));
}

TEST_F(WorkspaceTest, the_plan_is_what_the_run_then_does_and_writes_nothing) {
    const auto expect_plan = [&](const PreprocessOptions& options, std::size_t up_to_date, std::size_t remaining) {
        const auto before = fs::exists(workspace_) ? contents(workspace_) : std::map<std::string, std::string>();
        const auto plan = plan_preprocessing(database::open_database(database_), workspace_, *catalogue_, options);
        EXPECT_EQ(plan.up_to_date, up_to_date);
        EXPECT_EQ(plan.remaining, remaining);
        EXPECT_TRUE(before.empty() ? !fs::exists(workspace_) : contents(workspace_) == before);
        const auto report = preprocess(options);
        EXPECT_EQ(report.up_to_date, up_to_date);
        EXPECT_EQ(report.preprocessed + report.failures.size(), remaining);
        return plan.unfinished_subjects;
    };
    auto options = quick(), fewer = quick();
    fewer.subjects = {"bs000", "bs001"};
    expect_plan(fewer, 0, 4);
    expect_plan(fewer, 4, 0);
    expect_plan(options, 0, 6);  // another average: neutrals are tied, the others aligned anew
    catalogue_ = &other_catalogue();
    expect_plan(options, 3, 3);
    fs::remove(face_file("bs000_LFAU_12_0.ply"));
    fs::remove(face_file("bs001_N_N_0.json"));
    EXPECT_THAT(expect_plan(options, 4, 2), ElementsAre("bs000", "bs001"));
    test::write_analytic_scan(database_, "bs000_N_N_1", {0.95, 0}, test::analytic_pose(4));
    fs::resize_file(database_ / "bs000" / "bs000_N_N_0.bnt", 1000);
    (void)preprocess(options);
    expect_plan(options, 6, 1);  // its place was taken; it is tried again
    fewer.subjects = {"bs001"};
    expect_plan(fewer, 6, 0);  // what an earlier run made stays, and what it could not is not asked for
    EXPECT_THROW(
        (void)plan_preprocessing(database::open_database(database_), folder_.path() / "new", *catalogue_, fewer),
        InputError);
}

TEST_F(WorkspaceTest, an_image_beside_a_mesh_without_texture_coordinates_is_no_texture_of_the_face) {
    std::string manifest = "subject,expression,scan,landmarks\n";
    for (const auto& entry : database::open_database(database_).scans) {
        const auto loaded = database::load(entry);
        const bool with_coordinates = entry.id.subject == "bs002";
        geometry::Mesh mesh;
        for (std::size_t i = 0; i < loaded.scan.points_mm.size(); ++i) {
            if (!loaded.scan.valid(i)) continue;
            mesh.vertices_mm.push_back(loaded.scan.points_mm[i]);
            if (with_coordinates) mesh.texture_coordinates.push_back(loaded.scan.texture_coordinates[i]);
        }
        const auto stem = entry.id.subject + "/" + entry.id.name();
        io::write_mesh(database_ / (stem + ".ply"), mesh);
        io::write_png(database_ / (stem + ".png"), {2, 2, std::vector<std::uint8_t>(12, 99)});
        manifest += fmt::format("{},{},{}.ply,{}.lm3\n", entry.id.subject, entry.id.code, stem, stem);
    }
    base::write_atomically(database_ / "manifest.csv", manifest);
    const auto report = preprocess();
    EXPECT_TRUE(report.failures.empty());
    const Workspace workspace(workspace_);
    for (const auto& id : workspace.scans()) {
        const auto face = workspace.face(id);
        EXPECT_EQ(face.texture_file.empty(), face.grid.texture_coordinates.empty()) << id.name();
        EXPECT_EQ(face.texture_file.empty(), id.subject != "bs002") << id.name();
    }
    const auto remarked = std::count_if(report.remarks.begin(), report.remarks.end(), [](const ScanRemark& r) {
        return r.scan.substr(0, 5) != "bs002" && r.remark.starts_with("the image beside it is not used");
    });
    EXPECT_EQ(remarked, 4);  // one text for all of them: printed as one line
}

TEST_F(WorkspaceTest, a_scan_with_exchanged_labels_fails_and_one_with_an_odd_chin_is_remarked) {
    const auto marks = geometry::transformed(test::AnalyticFace{1.0, 6}.landmarks(), test::analytic_pose(3));
    std::vector<geometry::Landmark> exchanged, flat;
    for (const auto& mark : marks.all()) {
        const auto& other = mark.name.starts_with("mouth_corner") ? geometry::mirrored_name(mark.name) : mark.name;
        exchanged.push_back({mark.name, marks.position_mm(other), ""});
        flat.push_back({mark.name, marks.position_mm(mark.name == "chin" ? "nose_tip" : mark.name), ""});
    }
    const auto with = [&](const std::vector<geometry::Landmark>& those) {
        database::write_lm3(database_ / "bs001" / "bs001_LFAU_12_0.lm3",
                            database::to_bosphorus_labels(geometry::Landmarks(those)));
        return preprocess();
    };
    auto report = with(exchanged);
    ASSERT_EQ(report.failures.size(), 1U);
    EXPECT_EQ(report.failures[0].scan, "bs001_LFAU_12_0");
    EXPECT_THAT(report.failures[0].reason, AllOf(HasSubstr("bs001_LFAU_12_0.lm3"), HasSubstr("exchanged")));
    report = with(flat);  // four marks that span no tetrahedron: Eqs 5.1-5.4 have no answer
    EXPECT_TRUE(report.failures.empty());
    EXPECT_TRUE(std::any_of(report.remarks.begin(), report.remarks.end(), [](const ScanRemark& r) {
        return r.scan == "bs001_LFAU_12_0" && r.remark.find("those of the neutral were taken") != std::string::npos;
    }));
}

TEST_F(WorkspaceTest, another_facs_catalogue_aligns_the_scans_anew_and_marks_do_not_grow_with_the_subjects) {
    (void)preprocess();
    catalogue_ = &other_catalogue();
    EXPECT_EQ(preprocess().preprocessed, 3U);  // the neutrals have nothing to be aligned to
    EXPECT_THAT(base::read_text(face_file("bs001_LFAU_12_0.done")), testing::Not(HasSubstr("bs002")));
}

TEST_F(WorkspaceTest, an_average_face_that_could_not_be_written_whole_is_not_taken_for_finished) {
    (void)preprocess();
    const auto stem = workspace_ / "average" / "average_face";
    std::string fingerprint;
    const auto average = read_average_face(stem, &fingerprint);
    fs::remove(fs::path(stem) += ".ply");
    fs::create_directories((fs::path(stem) += ".ply") / "in the way");
    EXPECT_THROW(write_average_face(stem, average, fingerprint), InputError);
    EXPECT_FALSE(fs::exists(fs::path(stem) += ".json"));
}

TEST_F(WorkspaceTest, a_cloud_with_front_and_back_is_refused_and_the_rest_is_done) {
    auto database = database::open_database(database_);
    for (auto& entry : database.scans) {
        if (entry.id.name() != "bs001_LFAU_12_0") continue;
        geometry::Mesh mesh;
        for (const auto& p : database::load(entry).scan.points_mm)
            if (p.allFinite())
                for (const double behind_mm : {0.0, 60.0})
                    mesh.vertices_mm.emplace_back(p.x() + behind_mm / 100, p.y(), p.z() - behind_mm);
        entry.scan_file.replace_extension(".ply");
        io::write_mesh(entry.scan_file, mesh);
    }
    const auto report = preprocess_database(database, workspace_, *catalogue_, quick());
    ASSERT_EQ(report.failures.size(), 1U);
    EXPECT_THAT(report.failures[0].reason, AllOf(HasSubstr(".ply"), HasSubstr("front and back")));
    EXPECT_EQ(report.preprocessed, 5U);
}

TEST_F(WorkspaceTest, a_database_is_never_written_into_but_a_folder_around_or_beside_it_will_do) {
    const auto database = database::open_database(database_);
    const auto before = contents(database_);
    for (const auto& place : {database_, database_ / "", database_ / "x" / "..", database_ / "bs001",
                              database_ / "bs001" / "work", database_ / "truth" / "work", database_ / "work",
                              database_ / "not" / "there", folder_.path() / "way" / ".." / "db" / "work"})
        EXPECT_THAT(message_of<InputError>([&] { (void)preprocess_database(database, place, *catalogue_, quick()); }),
                    HasSubstr("into which nothing is written"))
            << place;
    EXPECT_EQ(contents(database_), before);
    fs::create_symlink("loop", folder_.path() / "loop");
    EXPECT_THAT(message_of<InputError>([&] { check_workspace_place(database, folder_.path() / "loop"); }),
                AllOf(HasSubstr("loop': cannot be used ("), HasSubstr("; give another folder for the workspace")));
    EXPECT_THAT(message_of<InputError>([&] { check_workspace_place(database, ""); }), HasSubstr("'': cannot be used"));
    check_workspace_place(database, folder_.path());
    check_workspace_place(database, folder_.path() / "db2");
}

TEST_F(WorkspaceTest, a_folder_that_takes_no_faces_is_found_out_before_any_scan_is_read) {
    const auto database = database::open_database(database_);
    base::write_atomically(folder_.path() / "file", "mine");
    for (const auto& scan : database.scans) fs::resize_file(scan.scan_file, 0);  // reading any would fail otherwise
    EXPECT_THAT(message_of<InputError>(
                    [&] { (void)preprocess_database(database, folder_.path() / "file", *catalogue_, quick()); }),
                HasSubstr("file: is a file; give a folder"));
    EXPECT_THAT(message_of<InputError>(
                    [&] { (void)preprocess_database(database, folder_.path() / "file" / "x", *catalogue_, quick()); }),
                HasSubstr("file/x: the folder cannot be made"));
    EXPECT_EQ(base::read_text(folder_.path() / "file"), "mine");
}

TEST_F(WorkspaceTest, a_scan_without_landmarks_is_told_which_file_it_lacks) {
    fs::remove(database_ / "bs002" / "bs002_N_N_0.lm3");
    fs::remove(database_ / "bs001" / "bs001_LFAU_12_0.lm3");
    const auto report = preprocess();
    ASSERT_EQ(report.failures.size(), 2U);
    EXPECT_THAT(report.failures[0].reason,
                testing::AllOf(HasSubstr("no landmark file beside"),
                               HasSubstr("bs001_LFAU_12_0.bnt; put bs001_LFAU_12_0.lm3 there")));
    EXPECT_THAT(report.failures[1].reason, HasSubstr("put bs002_N_N_0.lm3 there"));
}

TEST_F(WorkspaceTest, a_workspace_knows_whether_its_database_had_a_truth) {
    (void)preprocess();
    EXPECT_FALSE(Workspace(workspace_).made_with_truth());
    base::write_atomically(database_ / "truth" / "truth.json", "{}");
    (void)preprocess();
    EXPECT_TRUE(Workspace(workspace_).made_with_truth());
}

TEST_F(WorkspaceTest, a_run_that_ends_half_way_leaves_no_workspace_and_the_next_one_goes_on) {
    struct Stopped {};
    (void)preprocess();
    auto options = quick();
    options.steps.cleaning.spike_mm = 5;
    const auto stop = [](const std::string& scan) {
        if (scan == "bs001_LFAU_12_0") throw Stopped();
    };
    base::set_thread_count(1);
    EXPECT_THROW((void)preprocess_database(database::open_database(database_), workspace_, *catalogue_, options, stop),
                 Stopped);
    base::set_thread_count(0);
    EXPECT_THAT(message_of<InputError>([&] { Workspace{workspace_}; }), HasSubstr("no finished workspace there"));
    const auto report = preprocess(options);
    EXPECT_EQ(report.preprocessed + report.up_to_date, 6U);
    EXPECT_GE(report.up_to_date, 4U);  // the first two subjects were done
    EXPECT_EQ(Workspace(workspace_).scans().size(), 6U);
}

TEST_F(WorkspaceTest, a_bad_scan_is_reported_and_the_rest_is_done) {
    fs::resize_file(database_ / "bs001" / "bs001_LFAU_12_0.bnt", 1000);
    const auto report = preprocess();
    EXPECT_EQ(report.preprocessed, 5U);
    ASSERT_EQ(report.failures.size(), 1U);
    EXPECT_EQ(report.failures[0].scan, "bs001_LFAU_12_0");
    EXPECT_THAT(report.failures[0].reason, HasSubstr("bs001_LFAU_12_0.bnt"));
    EXPECT_FALSE(Workspace(workspace_).scan_of("bs001", smile()));
}

TEST_F(WorkspaceTest, a_bad_neutral_gives_its_place_to_the_next_and_a_subject_without_one_is_left_out) {
    test::write_analytic_scan(database_, "bs000_N_N_1", {0.95, 0}, test::analytic_pose(4));
    fs::resize_file(database_ / "bs000" / "bs000_N_N_0.bnt", 1000);
    test::write_analytic_scan(database_, "bs003_N_N_0", {1.02, 0}, test::analytic_pose(1));
    {
        // Eye corners, chin and nose tip in one plane: Eqs 5.1-5.4 have no answer.
        std::vector<geometry::Landmark> flat;
        const auto marks = test::AnalyticFace{}.landmarks();
        for (const auto& mark : marks.all())
            flat.push_back({mark.name, {mark.position_mm.x(), mark.position_mm.y(), 0}, ""});
        database::write_lm3(database_ / "bs003" / "bs003_N_N_0.lm3",
                            database::to_bosphorus_labels(geometry::Landmarks(flat)));
        test::AnalyticFace face{1.02, 0};
        auto scan = face.scan(2.0);
        for (auto& p : scan.points_mm)
            if (p.allFinite()) p.z() = 0;
        database::write_bnt(database_ / "bs003" / "bs003_N_N_0.bnt", database::to_bnt(scan));
    }
    auto options = quick();
    options.accept = {"frame", "landmarks-off-scan"};  // a flat face looks nowhere
    const auto report = preprocess(options);
    EXPECT_THAT(report.left_out, ElementsAre("bs003"));
    ASSERT_EQ(report.failures.size(), 2U);
    EXPECT_EQ(report.failures[0].scan, "bs000_N_N_0");
    EXPECT_EQ(report.failures[1].scan, "bs003_N_N_0");
    EXPECT_THAT(report.failures[1].reason, HasSubstr("one plane"));
    const Workspace workspace(workspace_);
    EXPECT_EQ(workspace.neutral("bs000").name(), "bs000_N_N_1");
    EXPECT_TRUE(workspace.scan_of("bs000", smile()));
}

TEST_F(WorkspaceTest, an_expressive_scan_without_a_chin_mark_is_kept_with_the_affine_map_of_its_neutral) {
    std::vector<geometry::Landmark> seen;
    const auto marks = geometry::transformed(
        test::AnalyticFace{test::analytic_scales[1], test::analytic_smile_mm}.landmarks(), test::analytic_pose(3));
    for (const auto& mark : marks.all())
        if (mark.name != "chin") seen.push_back(mark);
    database::write_lm3(database_ / "bs001" / "bs001_LFAU_12_0.lm3",
                        database::to_bosphorus_labels(geometry::Landmarks(seen)));
    const auto report = preprocess();
    EXPECT_TRUE(report.failures.empty());
    const Workspace workspace(workspace_);
    const auto face = workspace.face(*workspace.scan_of("bs001", smile()));
    const auto neutral = workspace.face(workspace.neutral("bs001"));
    EXPECT_TRUE(face.average_from_scan_affine.matrix().isApprox(
        (neutral.average_from_scan_affine * face.neutral_from_scan).matrix(), 1e-12));
    EXPECT_THAT(face.remarks, testing::Contains(HasSubstr("'chin' is missing")));
}

TEST_F(WorkspaceTest,
       landmarks_without_a_partner_on_the_average_face_are_remarked_by_name_and_only_where_there_are_any) {
    EXPECT_THAT(preprocess().remarks, testing::IsEmpty());
    const auto marks = geometry::transformed(
        test::AnalyticFace{test::analytic_scales[1], test::analytic_smile_mm}.landmarks(), test::analytic_pose(3));
    std::vector<geometry::Landmark> others;
    for (const auto& mark : marks.all())
        if (mark.name != "upper_lip_outer" && mark.name != "lower_lip_outer") others.push_back(mark);
    others.push_back({"scar", marks.position_mm("nose_tip") + Point(12, 0, -8), ""});
    database::write_lm3(database_ / "bs001" / "bs001_LFAU_12_0.lm3",
                        database::to_bosphorus_labels(geometry::Landmarks(others)));
    const auto report = preprocess();
    ASSERT_EQ(report.remarks.size(), 1U);
    EXPECT_EQ(report.remarks[0].scan, "bs001_LFAU_12_0");
    EXPECT_THAT(report.remarks[0].remark,
                AllOf(HasSubstr("the scan lacks upper_lip_outer, lower_lip_outer of the average face"),
                      HasSubstr("the average face lacks scar of the scan")));
    EXPECT_THAT(preprocess().remarks, testing::IsEmpty());  // of the faces written, as all remarks are
}

TEST_F(WorkspaceTest, one_and_two_threads_write_the_same_bytes) {
    fs::resize_file(database_ / "bs001" / "bs001_LFAU_12_0.bnt", 1000);  // failures are listed in one order, too
    base::set_thread_count(1);
    (void)preprocess();
    const auto one = contents(workspace_);
    fs::remove_all(workspace_);
    base::set_thread_count(2);
    (void)preprocess();
    base::set_thread_count(0);
    EXPECT_EQ(contents(workspace_), one);
    EXPECT_EQ(one.size(), 3 * 5 + 2 + 1U);  // 5 faces of .ply, .json, .done; the average face; workspace.json
}

TEST_F(WorkspaceTest, hidden_subjects_are_known_to_the_workspace) {
    base::write_atomically(database_ / "unallowed_subjects.txt", "BS001\n");
    (void)preprocess();
    const Workspace workspace(workspace_);
    EXPECT_TRUE(workspace.hidden("bs001"));
    EXPECT_TRUE(workspace.hidden("Bs001"));
    EXPECT_THROW(workspace.refuse_hidden("bs001"), InputError);
    EXPECT_FALSE(workspace.hidden("bs000"));
}

TEST_F(WorkspaceTest, bare_files_of_hidden_subjects_are_refused_in_a_workspace_until_they_may_be_shown_again) {
    const auto list = database_ / "unallowed_subjects.txt";
    base::write_atomically(list, "BS001\n");
    (void)preprocess();
    EXPECT_THROW(database::refuse_hidden_file(face_file("bs001_N_N_0.ply")), InputError);
    EXPECT_NO_THROW(database::refuse_hidden_file(face_file("bs000_N_N_0.ply")));
    base::write_atomically(list, "bs000\n");
    (void)preprocess();
    EXPECT_THROW(database::refuse_hidden_file(face_file("bs000_N_N_0.ply")), InputError);
    EXPECT_NO_THROW(database::refuse_hidden_file(face_file("bs001_N_N_0.ply")));
    fs::remove(list);
    (void)preprocess();
    EXPECT_NO_THROW(database::refuse_hidden_file(face_file("bs000_N_N_0.ply")));
    EXPECT_FALSE(Workspace(workspace_).hidden("bs000"));
}

TEST_F(WorkspaceTest, a_list_that_somebody_put_into_the_workspace_is_kept_and_only_grows) {
    (void)preprocess();
    const auto list = workspace_ / "unallowed_subjects.txt";
    base::write_atomically(list, "bs000");
    (void)preprocess();
    EXPECT_EQ(base::read_text(list), "bs000");
    base::write_atomically(database_ / "unallowed_subjects.txt", "bs001\n");
    (void)preprocess();
    (void)preprocess();
    EXPECT_EQ(base::read_text(list), "bs000\nbs001\n");
}

TEST_F(WorkspaceTest, who_is_put_on_the_list_after_preprocessing_is_hidden_at_once) {
    base::write_atomically(database_ / "unallowed_subjects.txt", "bs001\n");
    (void)preprocess();
    base::write_atomically(folder_.path() / "unallowed_subjects.txt", "BS000\nsomebody else\n");  // above both
    EXPECT_TRUE(Workspace(workspace_).hidden("bs000"));
    fs::remove(folder_.path() / "unallowed_subjects.txt");
    EXPECT_FALSE(Workspace(workspace_).hidden("bs000"));
    base::write_atomically(database_ / "unallowed_subjects.txt", "2\n");
    const Workspace workspace(workspace_);
    EXPECT_TRUE(workspace.hidden("bs002"));
    EXPECT_TRUE(workspace.hidden("bs001"));  // as it was preprocessed
    fs::rename(database_, folder_.path() / "moved");
    EXPECT_TRUE(Workspace(workspace_).hidden("bs001"));
}

TEST_F(WorkspaceTest, the_sheet_of_a_subject_hidden_since_is_deleted_by_the_next_preprocessing) {
    (void)preprocess();
    for (const char* name : {"bs001.png", "bs001.done", "bs000.png"})
        base::write_atomically(workspace_ / "sheets" / name, "a sheet");
    base::write_atomically(database_ / "unallowed_subjects.txt", "bs001\n");
    (void)preprocess();
    EXPECT_FALSE(fs::exists(workspace_ / "sheets/bs001.png"));
    EXPECT_FALSE(fs::exists(workspace_ / "sheets/bs001.done"));
    EXPECT_TRUE(fs::exists(workspace_ / "sheets/bs000.png"));
}

TEST_F(WorkspaceTest, a_selection_that_names_what_is_not_there_is_refused_by_name) {
    auto options = quick();
    options.subjects = {"BS000", "bs001", "bs777"};
    EXPECT_THAT(message_of<InputError>([&] { (void)preprocess(options); }), HasSubstr("no subject bs777"));
    options.subjects = {"BS000", "bs001"};
    options.expressions = {*facs::parse_expression("AU12"), *facs::parse_expression("27")};
    EXPECT_THAT(message_of<InputError>([&] { (void)preprocess(options); }), HasSubstr("no scan of expression 27"));
    options.expressions = {*facs::parse_expression("AU12")};
    EXPECT_EQ(selected_scans(database::open_database(database_), options).size(), 4U);
    options.subjects = {"bs001"};
    EXPECT_THAT(message_of<InputError>([&] { (void)preprocess(options); }),
                HasSubstr("1 of 1 selected subjects have a usable neutral face, and the average face needs two"));
}

TEST_F(WorkspaceTest, bad_options_are_refused_before_any_scan_is_read) {
    auto options = quick();
    options.steps.gridding.rows = 1;
    EXPECT_THROW((void)preprocess(options), InputError);
    EXPECT_FALSE(fs::exists(workspace_));
}

TEST_F(WorkspaceTest, what_is_missing_or_damaged_is_named) {
    (void)preprocess();
    const Workspace workspace(workspace_);
    EXPECT_THAT(message_of<InputError>([&] { (void)workspace.neutral("bs009"); }),
                HasSubstr("'bs009' has no neutral face there; there are: bs000, bs001, bs002"));
    fs::remove(face_file("bs001_N_N_0.ply"));
    EXPECT_THAT(message_of<InputError>([&] { (void)workspace.face(workspace.neutral("bs001")); }),
                HasSubstr("bs001_N_N_0.ply"));
    base::write_atomically(face_file("bs002_N_N_0.json"), "{}");
    EXPECT_THAT(message_of<InputError>([&] { (void)workspace.face(workspace.neutral("bs002")); }),
                HasSubstr("bs002_N_N_0.json: schema is 0"));
}

TEST_F(WorkspaceTest, a_face_of_another_scan_or_with_a_texture_from_elsewhere_is_refused) {
    (void)preprocess();
    const Workspace workspace(workspace_);
    const auto id = workspace.neutral("bs001");
    auto face = workspace.face(id);
    const auto error = [&] {
        write_face(workspace.stem(id), face);
        return message_of<InputError>([&] { (void)workspace.face(id); });
    };
    face.texture_file = workspace.database_root() / "bs001" / ".." / ".." / "secret.png";
    EXPECT_THAT(error(),
                AllOf(HasSubstr("bs001_N_N_0.json: texture_file '"), HasSubstr("does not lie in the database")));
    face.texture_file = workspace.database_root() / "bs001" / "bs001_N_N_0.png";
    EXPECT_EQ(error(), "nothing was thrown");
    face.id.subject = "bs000";  // as if a hidden subject's face were renamed
    EXPECT_THAT(error(), HasSubstr("bs001_N_N_0.json: scan is 'bs000_N_N_0'"));
}

TEST_F(WorkspaceTest, a_face_reads_back_bit_for_bit) {
    (void)preprocess();
    const Workspace workspace(workspace_);
    const auto face = workspace.face(workspace.neutral("bs000"));
    write_face(folder_.path() / "copy", face);
    EXPECT_EQ(base::read_text(folder_.path() / "copy.ply"), base::read_text(face_file("bs000_N_N_0.ply")));
    EXPECT_EQ(base::read_text(folder_.path() / "copy.json"), base::read_text(face_file("bs000_N_N_0.json")));
    std::size_t outside = 0;
    for (std::size_t v = 0; v < face.grid.size(); ++v)
        if (!face.grid.inside(v)) {
            ++outside;
            EXPECT_TRUE(std::isnan(face.grid.vertices_mm[v].z()) && face.grid.texture_coordinates[v].hasNaN());
        }
    EXPECT_GT(outside, 0U);
}

}  // namespace
}  // namespace mimik::preprocessing
