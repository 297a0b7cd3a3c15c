#include "database/scan_database.h"

#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "database/doctor.h"
#include "io/landmark_io.h"
#include "tests/database/made_face.h"
#include "tests/database/temporary_folder.h"

namespace mimik::database {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> names_of(const std::vector<const ScanEntry*>& entries) {
    std::vector<std::string> names;
    for (const auto* entry : entries) names.push_back(entry->id.name());
    return names;
}

std::vector<std::string> names_of(const ScanDatabase& database) {
    std::vector<std::string> names;
    for (const auto& entry : database.scans) names.push_back(entry.id.name());
    return names;
}

TEST(ScanDatabase, a_folder_in_bosphorus_layout_is_listed_in_order) {
    const TemporaryFolder folder;
    for (const char* name : {"bs001_N_N_0", "bs000_LFAU_12_0", "bs000_N_N_1", "bs000_N_N_0", "bs000_LFAU_9_0"})
        write_scan(folder.path(), name, make_face());
    const auto database = open_database(folder.path());
    EXPECT_THAT(names_of(database),
                ElementsAre("bs000_N_N_0", "bs000_N_N_1", "bs000_LFAU_9_0", "bs000_LFAU_12_0", "bs001_N_N_0"));
    EXPECT_THAT(database.subjects(), ElementsAre("bs000", "bs001"));
    EXPECT_EQ(database.neutrals("bs000").size(), 2U);
    ASSERT_NE(database.find(*parse_scan_name("bs000_lfau_12_0")), nullptr);
    EXPECT_EQ(database.find(*parse_scan_name("bs000_LFAU_13_0")), nullptr);
    EXPECT_TRUE(database.scans[0].scan_file.is_absolute());
    EXPECT_THAT(database.remarks, IsEmpty());
}

TEST(ScanDatabase, a_scan_whose_texture_name_leads_elsewhere_is_loaded_without_it) {
    const TemporaryFolder folder;
    const auto at = [&](const char* name) { return folder.path() / name; };
    base::write_atomically(at("a.obj"),
                           "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 0.5 0.5\n"
                           "f 1/1 2/2 3/3\nf 1/1 3/4 2/2\n");
    base::write_atomically(at("a.mtl"), "newmtl x\nmap_Kd C:\\scans\\face.jpg\n");
    base::write_atomically(at("manifest.csv"), "subject,expression,scan\nanna,N,a.obj\n");
    const auto entry = open_database(folder.path()).scans.at(0);
    const auto loaded = load(entry);
    EXPECT_EQ(loaded.scan.points_mm.size(), 3U);
    EXPECT_THAT(loaded.remarks, Contains(HasSubstr("a.mtl: texture name is 'C:\\scans\\face.jpg'")));
    EXPECT_THAT(loaded.remarks, Contains(HasSubstr("several charts (1 point lies in more than one)")));
    const auto findings = check_scan(entry, nullptr);
    const auto finding =
        std::find_if(findings.begin(), findings.end(), [](const Finding& f) { return f.kind == "texture"; });
    ASSERT_NE(finding, findings.end());
    EXPECT_EQ(finding->severity, Severity::warning);
    EXPECT_THAT(finding->what, HasSubstr("a.mtl: texture name is"));
}

TEST(ScanDatabase, files_that_fit_no_pattern_are_remarked_not_lost) {
    const TemporaryFolder folder;
    write_scan(folder.path(), "bs000_N_N_0", make_face());
    std::filesystem::copy_file(folder.path() / "bs000/bs000_N_N_0.bnt", folder.path() / "bs000/odd.bnt");
    std::filesystem::copy_file(folder.path() / "bs000/bs000_N_N_0.lm3", folder.path() / "bs000/bs000_N_N_7.lm3");
    std::filesystem::create_directories(folder.path() / "other");
    std::filesystem::copy_file(folder.path() / "bs000/bs000_N_N_0.bnt", folder.path() / "other/bs009_N_N_0.bnt");
    const auto database = open_database(folder.path());
    EXPECT_THAT(names_of(database), ElementsAre("bs000_N_N_0", "bs009_N_N_0"));
    EXPECT_THAT(database.remarks, Contains(HasSubstr("odd.bnt: the name is not of the form")));
    EXPECT_THAT(database.remarks, Contains(HasSubstr("there is no bs000_N_N_7.bnt beside it")));
    EXPECT_THAT(database.remarks, Contains(HasSubstr("lies in the folder 'other' though its subject is 'bs009'")));
}

TEST(ScanDatabase, what_a_mac_leaves_beside_files_is_passed_over) {
    const TemporaryFolder folder;
    write_scan(folder.path(), "bs000_N_N_0", make_face());
    const auto before = open_database(folder.path());
    for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "bs000"))
        if (!entry.path().filename().string().starts_with("._"))
            base::write_atomically(folder.path() / "bs000" / ("._" + entry.path().filename().string()),
                                   std::string("\0\5\x16\7", 4));
    base::write_atomically(folder.path() / "._bs000", "x");
    base::write_atomically(folder.path() / ".DS_Store", "x");
    base::write_atomically(folder.path() / "__MACOSX/bs000/._bs000_N_N_0.bnt", "x");
    const auto after = open_database(folder.path());
    EXPECT_THAT(names_of(after), ElementsAre("bs000_N_N_0"));
    EXPECT_EQ(after.remarks, before.remarks);
    EXPECT_EQ(after.scans[0].scan_file, before.scans[0].scan_file);
}

TEST(ScanDatabase, a_missing_or_empty_folder_is_refused_by_name) {
    const TemporaryFolder folder;
    EXPECT_THAT(message_of<InputError>([&] { (void)open_database(folder.path() / "none"); }),
                HasSubstr("none: is not a folder"));
    EXPECT_THAT(message_of<InputError>([&] { (void)open_database(folder.path()); }), HasSubstr("no scan found"));
}

TEST(ScanDatabase, unallowed_subjects_are_hidden_by_number_or_name) {
    const TemporaryFolder folder;
    for (const char* name : {"bs000_N_N_0", "bs001_N_N_0", "bs002_N_N_0"}) write_scan(folder.path(), name, make_face());
    base::write_atomically(folder.path() / "Unallowed_Subjects.txt",
                           "# not to be shown: bs002\r\nBS000\r\nbs1, bs077\nnobody\n");
    const auto database = open_database(folder.path());
    EXPECT_THAT(database.hidden_subjects, ElementsAre("bs000", "bs001", "bs077"));
    EXPECT_TRUE(database.hidden("BS000"));
    EXPECT_FALSE(database.hidden("bs002"));
    EXPECT_THAT(database.remarks, Contains(HasSubstr("'nobody' is no subject")));
    base::write_atomically(folder.path() / "Unallowed_Subjects.txt", "nobody\n");
    EXPECT_THAT(message_of<InputError>([&] { (void)open_database(folder.path()); }),
                HasSubstr("Unallowed_Subjects.txt: line 1: 'nobody' is no subject"));
}

TEST(ScanDatabase, a_list_above_the_database_hides_too_also_where_one_subjects_folder_is_opened) {
    const TemporaryFolder folder;
    for (const char* name : {"bs000_N_N_0", "bs001_N_N_0"}) write_scan(folder.path() / "db", name, make_face());
    base::write_atomically(folder.path() / "unallowed_subjects.txt", "bs001\nsomebody else\n");
    const auto database = open_database(folder.path() / "db");
    EXPECT_TRUE(database.hidden("bs001"));
    EXPECT_FALSE(database.hidden("bs000"));
    EXPECT_THAT(database.remarks, IsEmpty());
    EXPECT_TRUE(open_database(folder.path() / "db/bs001").hidden("bs001"));
    EXPECT_FALSE(open_database(folder.path() / "db/bs000").hidden("bs000"));
}

TEST(ScanDatabase, facs_codes_give_intensities_with_the_stronger_side) {
    const TemporaryFolder folder;
    write_scan(folder.path(), "bs000_LFAU_12_0", make_face());
    write_scan(folder.path(), "bs000_N_N_0", make_face());
    base::write_atomically(folder.path() / "facscodes.lst",
                           "header\nheader\nbs000_LFAU_12_0 -> 6B+L12C+R12D+25\nbs000_N_N_0 -> 0\n");
    const auto database = open_database(folder.path());
    const auto* smile = database.find(*parse_scan_name("bs000_LFAU_12_0"));
    EXPECT_EQ(smile->intensities, (std::map<int, char>{{6, 'B'}, {12, 'D'}, {25, 0}}));
    ASSERT_EQ(smile->facs_scores.size(), 4U);
    EXPECT_EQ(smile->facs_scores[1], (FacsScore{12, facs::Side::left, 'C'}));
    EXPECT_THAT(database.scans[0].intensities, IsEmpty());
}

class OneSided : public testing::TestWithParam<bool> {};

TEST_P(OneSided, codes_are_taken_as_the_side_whose_mouth_corner_moves) {
    const bool names_are_the_viewers = GetParam();
    const TemporaryFolder folder;
    const auto face = make_face();
    for (const char* subject : {"bs000", "bs001"}) {
        write_scan(folder.path(), std::string(subject) + "_N_N_0", face);
        for (const bool left : {true, false}) {
            MadeFace smile = face;
            // 8 mm up and out, as a smile does; the whole head 5 mm aside, which must not matter.
            smile.landmarks = moved(face.landmarks,
                                    {{left ? "mouth_corner_left" : "mouth_corner_right", {left ? 5.0 : -5.0, 6, -2}}});
            geometry::Transform head = geometry::Transform::Identity();
            head.translate(geometry::Vector(5, 1, 0)).rotate(Eigen::AngleAxisd(0.1, geometry::Vector::UnitY()));
            smile.landmarks = transformed(smile.landmarks, head);
            const bool named_left = left != names_are_the_viewers;
            write_scan(folder.path(), std::string(subject) + (named_left ? "_LFAU_12L_0" : "_LFAU_12R_0"), smile);
        }
    }
    const auto database = open_database(folder.path());
    EXPECT_EQ(database.code_sides.swapped, names_are_the_viewers);
    EXPECT_EQ(names_are_the_viewers ? database.code_sides.other_side : database.code_sides.own_side, 4);
    const auto* left = database.find(*parse_scan_name("bs001_LFAU_12L_0"));
    ASSERT_NE(left, nullptr);
    EXPECT_EQ(left->id.side(), facs::Side::left);
    EXPECT_EQ(left->file_name_stem, names_are_the_viewers ? "bs001_LFAU_12R_0" : "bs001_LFAU_12L_0");
    const auto neutral = load(*database.find(*parse_scan_name("bs001_N_N_0"))).landmarks;
    EXPECT_EQ(decide_side(neutral, load(*left).landmarks).side, facs::Side::left);
}

INSTANTIATE_TEST_SUITE_P(NamesAreTheSubjectsAndTheViewers, OneSided, testing::Values(false, true));

/// A neutral scan and one-sided smiles whose names are the viewer's, with the landmarks in `format`.
void write_viewers_smiles(const std::filesystem::path& root, const std::string& subject,
                          const std::vector<std::string>& codes, const std::string& extension) {
    const auto face = make_face();
    const auto write = [&](const std::string& name, const geometry::Landmarks& marks) {
        MadeFace made = face;
        made.landmarks = marks;
        write_scan(root, name, made);
        const auto stem = root / subject / name;
        std::filesystem::remove(stem.string() + ".lm3");
        io::write_landmarks(stem.string() + extension, marks);
    };
    write(subject + "_N_N_0", face.landmarks);
    for (const auto& code : codes)
        write(subject + "_LFAU_" + code + "_0",
              moved(face.landmarks, {{code.back() == 'L' ? "mouth_corner_right" : "mouth_corner_left", {0, 8, -2}}}));
}

TEST(OneSidedCodes, are_decided_by_landmarks_of_any_format) {
    for (const char* extension : {".pp", ".csv", ".fcsv", ".mrk.json"}) {
        const TemporaryFolder folder;
        write_viewers_smiles(folder.path(), "bs000", {"12L", "12R", "14L"}, extension);
        const auto database = open_database(folder.path());
        EXPECT_EQ(database.code_sides.other_side, 3) << extension;
        EXPECT_TRUE(database.code_sides.swapped) << extension;
    }
}

TEST(OneSidedCodes, left_and_right_of_one_subject_turn_the_names_where_nobody_contradicts) {
    const TemporaryFolder folder;
    write_viewers_smiles(folder.path(), "bs000", {"12L", "12R"}, ".csv");
    EXPECT_TRUE(open_database(folder.path()).code_sides.swapped);
    auto own = make_face();
    write_scan(folder.path(), "bs001_N_N_0", own);
    own.landmarks = moved(own.landmarks, {{"mouth_corner_left", {0, 8, -2}}});
    write_scan(folder.path(), "bs001_LFAU_12L_0", own);
    const auto database = open_database(folder.path());
    EXPECT_EQ(database.code_sides.own_side, 1);
    EXPECT_FALSE(database.code_sides.swapped);
}

TEST(OneSidedCodes, two_votes_for_one_side_of_one_subject_turn_no_names_and_of_two_subjects_do) {
    const TemporaryFolder folder;
    write_viewers_smiles(folder.path(), "bs000", {"12L", "14L"}, ".csv");
    const auto few = open_database(folder.path());
    EXPECT_EQ(few.code_sides.other_side, 2);
    EXPECT_FALSE(few.code_sides.swapped);
    EXPECT_THAT(few.remarks, ElementsAre(HasSubstr("taken as the subject's left: to turn all names takes 3 scans, two "
                                                   "subjects or 12L and 12R of one")));
    write_viewers_smiles(folder.path(), "bs001", {"12L"}, ".csv");
    EXPECT_TRUE(open_database(folder.path()).code_sides.swapped);
}

TEST(OneSidedCodes, that_nobody_can_decide_are_remarked) {
    const TemporaryFolder folder;
    for (const char* name : {"bs000_N_N_0", "bs000_LFAU_12L_0"}) write_scan(folder.path(), name, make_face());
    EXPECT_THAT(open_database(folder.path()).remarks,
                ElementsAre(HasSubstr("0 scans move the subject's own side, 0 the other, 1 are undecided")));
}

TEST(OneSidedCodes, equal_motion_of_both_corners_decides_nothing) {
    const auto neutral = make_face().landmarks;
    const auto smile = moved(neutral, {{"mouth_corner_left", {5, 6, -2}}, {"mouth_corner_right", {-5, 6, -2}}});
    EXPECT_EQ(decide_side(neutral, smile).side, facs::Side::both);
    EXPECT_EQ(decide_side(neutral, neutral).side, facs::Side::both);
}

TEST(OneSidedCodes, defaults_are_valid_and_a_bad_option_is_named) {
    EXPECT_NO_THROW(SideDecisionOptions{}.check());
    EXPECT_THAT(message_of<InputError>([] { SideDecisionOptions{.min_ratio = 0.5}.check(); }),
                HasSubstr("min_ratio is 0.5"));
}

TEST(Selecting, goes_by_subject_group_action_unit_and_side) {
    const TemporaryFolder folder;
    for (const char* name :
         {"bs000_N_N_0", "bs000_LFAU_12_0", "bs000_LFAU_12LW_0", "bs000_LFAU_12L_0", "bs000_UFAU_4_0", "bs001_N_N_0"})
        write_scan(folder.path(), name, make_face());
    const auto database = open_database(folder.path());
    EXPECT_THAT(names_of(select(database, {.subjects = {"BS001"}})), ElementsAre("bs001_N_N_0"));
    EXPECT_THAT(names_of(select(database, {.groups = {"ufau"}})), ElementsAre("bs000_UFAU_4_0"));
    EXPECT_THAT(names_of(select(database, {.action_units = {12}, .side = facs::Side::left})),
                ElementsAre("bs000_LFAU_12L_0"));
    EXPECT_EQ(select(database, {.action_units = {12, 4}}).size(), 4U);
    EXPECT_EQ(select(database, {}).size(), 6U);
    EXPECT_THAT(message_of<InputError>([&] { (void)select(database, {.subjects = {"bs009"}}); }),
                HasSubstr("subject 'bs009' is not in"));
    EXPECT_THAT(message_of<InputError>([&] { (void)select(database, {.groups = {"X"}}); }),
                HasSubstr("there are N, LFAU, UFAU"));
}

TEST(Load, a_scan_comes_with_its_landmarks_on_the_subjects_own_side) {
    const TemporaryFolder folder;
    const auto face = make_face();
    write_scan(folder.path(), "bs000_N_N_0", face);
    const auto loaded = load(open_database(folder.path()).scans[0]);
    EXPECT_EQ(loaded.scan.points_mm, face.scan.points_mm);
    for (const auto& mark : face.landmarks.all())
        EXPECT_EQ(loaded.landmarks.position_mm(mark.name), mark.position_mm) << mark.name;
    EXPECT_TRUE(loaded.checks.sides.left_label_is_subject_right);
    EXPECT_THAT(loaded.remarks, IsEmpty());
}

TEST(Load, the_texture_is_checked_against_the_landmarks_and_turned_if_it_lies_otherwise) {
    const TemporaryFolder folder;
    auto face = make_face();
    const auto right = face.scan.texture_coordinates;
    for (auto& t : face.scan.texture_coordinates) t.y() = 1 - t.y();
    write_scan(folder.path(), "bs000_N_N_0", face);
    const auto loaded = load(open_database(folder.path()).scans[0]);
    ASSERT_TRUE(loaded.checks.texture);
    EXPECT_EQ(loaded.checks.texture->best, TextureAxes::u_right_v_down);
    EXPECT_THAT(loaded.remarks, ElementsAre(HasSubstr("texture coordinates lie u to the right, v up and were turned")));
    for (std::size_t i = 0; i < right.size(); ++i)
        ASSERT_LT((loaded.scan.texture_coordinates[i] - right[i]).norm(), 1e-12);  // 1 - (1 - v)
    EXPECT_EQ(load_texture(loaded.entry)->width, 100);
}

TEST(Load, a_missing_texture_is_remarked_by_name) {
    const TemporaryFolder folder;
    write_scan(folder.path(), "bs000_N_N_0", make_face());
    std::filesystem::remove(folder.path() / "bs000/bs000_N_N_0.png");
    const auto loaded = load(open_database(folder.path()).scans[0]);
    EXPECT_THAT(loaded.remarks, ElementsAre(HasSubstr("'bs000_N_N_0.png' is not beside it")));
    EXPECT_FALSE(load_texture(loaded.entry));
}

TEST(Load, bad_pixel_landmarks_do_not_forbid_the_scan) {
    const TemporaryFolder folder;
    write_scan(folder.path(), "bs000_N_N_0", make_face());
    base::write_atomically(folder.path() / "bs000/bs000_N_N_0.lm2", "# x\n");
    EXPECT_THAT(load(open_database(folder.path()).scans[0]).remarks,
                ElementsAre(HasSubstr("bs000_N_N_0.lm2: has no line")));
}

TEST(Load, files_that_only_the_scan_file_names_are_listed) {
    const TemporaryFolder folder;
    base::write_atomically(folder.path() / "a.obj", "mtllib a.mtl\nv 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n");
    base::write_atomically(folder.path() / "manifest.csv", "subject,expression,scan\nanna,N,a.obj\n");
    EXPECT_THAT(load(open_database(folder.path()).scans[0]).files_looked_for,
                ElementsAre(std::filesystem::canonical(folder.path()) / "a.mtl"));
    base::write_atomically(folder.path() / "a.mtl", "newmtl face\nmap_Kd skin.png\n");
    EXPECT_THAT(load(open_database(folder.path()).scans[0]).files_looked_for,
                ElementsAre(std::filesystem::canonical(folder.path()) / "a.mtl",
                            std::filesystem::canonical(folder.path()) / "skin.png"));
}

TEST(Load, two_labels_for_one_point_are_refused_with_the_file) {
    const TemporaryFolder folder;
    write_scan(folder.path(), "bs000_N_N_0", make_face());
    base::write_atomically(folder.path() / "bs000/bs000_N_N_0.lm3",
                           "# x\n\n2 landmarks:\nNose tip\n0 0 70\nnose  TIP\n0 2 70\n");
    EXPECT_THAT(message_of<InputError>([&] { (void)load(open_database(folder.path()).scans[0]); }),
                HasSubstr("bs000_N_N_0.lm3: landmark 'nose_tip' appears twice"));
}

TEST(Load, many_threads_read_the_same) {
    const TemporaryFolder folder;
    write_scan(folder.path(), "bs000_N_N_0", make_face());
    const auto entry = open_database(folder.path()).scans[0];
    const auto expected = load(entry).scan.points_mm;
    std::vector<char> same(4, 0);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < same.size(); ++t)
        threads.emplace_back([&, t] { same[t] = load(entry).scan.points_mm == expected; });
    for (auto& thread : threads) thread.join();
    EXPECT_THAT(same, testing::Each(1));
}

TEST(Load, a_mirrored_scan_is_remarked) {
    const TemporaryFolder folder;
    auto face = make_face();
    for (auto& p : face.scan.points_mm) p.x() = -p.x();
    write_scan(folder.path(), "bs000_N_N_0", face);
    EXPECT_THAT(load(open_database(folder.path()).scans[0]).remarks,
                Contains(HasSubstr("x falls as the texture's u grows")));
}

TEST(Load, a_scan_without_any_point_is_refused) {
    const TemporaryFolder folder;
    auto face = make_face();
    for (auto& p : face.scan.points_mm) p.setConstant(std::numeric_limits<double>::quiet_NaN());
    write_scan(folder.path(), "bs000_N_N_0", face);
    EXPECT_THAT(message_of<InputError>([&] { (void)load(open_database(folder.path()).scans[0]); }),
                HasSubstr("bs000_N_N_0.bnt: holds no measured point"));
}

TEST(Load, a_texture_name_with_a_folder_is_remarked_with_the_file_and_not_followed) {
    const TemporaryFolder folder;
    write_scan(folder.path(), "bs000_N_N_0", make_face());
    const auto file = folder.path() / "bs000/bs000_N_N_0.bnt";
    Bnt bnt = read_bnt(file);
    bnt.texture_file = "../../secret.png";
    write_bnt(file, bnt);
    const auto loaded = load(open_database(folder.path()).scans[0]);
    EXPECT_THAT(loaded.remarks,
                Contains(testing::AllOf(HasSubstr("bs000_N_N_0.bnt: "), HasSubstr("../../secret.png"))));
    EXPECT_EQ(loaded.entry.texture_file.filename(), "bs000_N_N_0.png");  // the one beside it, by its name
    EXPECT_THAT(message_of<InputError>([&] { (void)read_bnt_scan(file); }), HasSubstr("../../secret.png"));
}

TEST(DatabaseNames, a_subject_called_mean_twins_by_case_and_bytes_that_are_no_utf8_are_refused) {
    const TemporaryFolder folder;
    const auto error = [&](const std::string& rows) {
        base::write_atomically(folder.path() / "manifest.csv", "subject,expression,scan\n" + rows);
        return message_of<InputError>([&] { (void)open_database(folder.path()); });
    };
    EXPECT_THAT(error("Mean,N,a.ply\n"),
                AllOf(HasSubstr("a.ply: its subject is called 'Mean'"), HasSubstr("give the subject another name")));
    EXPECT_THAT(
        error("anna,N,a.ply\nAnna,AU12,b.ply\n"),
        AllOf(HasSubstr("subjects 'anna' and 'Anna' differ by case alone"), HasSubstr("a.ply"), HasSubstr("b.ply")));
    EXPECT_THAT(error("anna,N,\xe4.ply\n"), HasSubstr("bytes that are no UTF-8"));
    EXPECT_EQ(error("anna,N,\xc3\xa4.ply\n"), "nothing was thrown");
    const auto latin = folder.path() / "\xe4";
    base::write_atomically(latin / "manifest.csv", "subject,expression,scan\nanna,N,a.ply\n");
    EXPECT_THAT(message_of<InputError>([&] { (void)open_database(latin); }), HasSubstr("the folder's path has bytes"));
}

TEST(DatabaseUnit, a_unit_is_given_to_scans_of_which_the_manifest_says_none) {
    const TemporaryFolder folder;
    base::write_atomically(folder.path() / "manifest.csv",
                           "subject,expression,scan,unit\nanna,N,a.ply,\nben,N,b.ply,mm\ncaro,N,c.ply,inch\n");
    const auto database = open_database(folder.path(), io::LengthUnit::centimetre);
    EXPECT_EQ(database.scans[0].unit, io::LengthUnit::centimetre);
    EXPECT_EQ(database.scans[1].unit, io::LengthUnit::millimetre);
    EXPECT_EQ(database.scans[2].unit, io::LengthUnit::inch);
    EXPECT_EQ(open_database(folder.path()).scans[0].unit, io::LengthUnit::millimetre);
}

}  // namespace
}  // namespace mimik::database
