#include "database/manifest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "io/landmark_io.h"
#include "tests/database/made_face.h"
#include "tests/database/temporary_folder.h"

namespace mimik::database {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string manifest_error(const std::string& text) {
    return message_of<InputError>([&] { (void)parse_manifest(text, "/data/manifest.csv"); });
}

TEST(Manifest, a_line_gives_a_scan_with_absolute_paths_and_a_unit) {
    const auto manifest =
        parse_manifest("unit,sex,landmarks,scan,expression,subject\ncm,F,a/x.pp,a/x.ply,12L,S1\n,,,b.obj,N,S1\n",
                       "/data/manifest.csv");
    ASSERT_EQ(manifest.scans.size(), 2U);
    const auto& smile = manifest.scans[0];
    EXPECT_EQ(smile.id.name(), "S1_LFAU_12L_0");
    EXPECT_EQ(smile.scan_file, "/data/a/x.ply");
    EXPECT_EQ(smile.landmarks_file, "/data/a/x.pp");
    EXPECT_EQ(smile.unit, io::LengthUnit::centimetre);
    EXPECT_EQ(smile.sex, "f");
    EXPECT_EQ(manifest.scans[1].unit, io::LengthUnit::millimetre);
    EXPECT_TRUE(manifest.scans[1].landmarks_file.empty());
    EXPECT_THAT(manifest.remarks, IsEmpty());
}

TEST(Manifest, scans_of_one_subject_and_expression_are_numbered_in_order) {
    const auto manifest = parse_manifest("subject,expression,scan\nA,N,1.ply\nA,neutral,2.ply\nB,N,3.ply\n", "m.csv");
    EXPECT_EQ(manifest.scans[0].id.repetition, 0);
    EXPECT_EQ(manifest.scans[1].id.repetition, 1);
    EXPECT_EQ(manifest.scans[2].id.repetition, 0);
}

TEST(Manifest, names_that_would_break_file_names_are_changed_or_refused) {
    const auto manifest = parse_manifest("subject,expression,scan\nJane_D,grin,1.ply\n", "m.csv");
    EXPECT_EQ(manifest.scans[0].id.name(), "Jane-D_OTHER_GRIN_0");
    EXPECT_THAT(manifest.remarks,
                ElementsAre(HasSubstr("subject 'Jane_D' is called 'Jane-D'"), HasSubstr("expression 'grin' is none")));
    EXPECT_THAT(manifest_error("subject,expression,scan\n../x,N,1.ply\n"), HasSubstr("subject '../x'"));
    EXPECT_THAT(manifest_error("subject,expression,scan\nJos\xe9,N,1.ply\n"), HasSubstr("not written in UTF-8"));
    EXPECT_THAT(manifest_error("subject,expression,scan\na,E_" + std::string(101, 'x') + ",1.ply\n"),
                HasSubstr("give at most 100 bytes"));
    std::string smiles;
    for (int i = 0; i < 34; ++i) smiles += "\u5fae";
    // 40 bytes are shown: 13 letters of three and the cut one left out.
    EXPECT_THAT(manifest_error("subject,expression,scan\na," + smiles + ",1.ply\n"),
                HasSubstr("expression '" + smiles.substr(0, 39) + "...'"));
}

TEST(Manifest, expressions_in_other_letters_are_different_expressions) {
    const auto manifest = parse_manifest(
        "subject,expression,scan\na,E_\u00e9,1.ply\na,E_\u00fc,2.ply\na,\u5fae\u7b11,3.ply\na,\u6124\u6012,4.ply\n",
        "m.csv");
    std::vector<std::string> names;
    for (const auto& scan : manifest.scans) names.push_back(scan.id.name());
    EXPECT_THAT(names, ElementsAre("a_E_\u00e9_0", "a_E_\u00fc_0", "a_OTHER_\u5fae\u7b11_0", "a_OTHER_\u6124\u6012_0"));
}

TEST(Manifest, two_spellings_that_fall_together_are_remarked_and_two_ways_to_separate_words_are_not) {
    const auto together = [](const std::string& rows) {
        std::vector<std::string> found;
        for (const auto& remark : parse_manifest("subject,expression,scan\n" + rows, "m.csv").remarks)
            if (remark.find("both called") != std::string::npos) found.push_back(remark);
        return found;
    };
    EXPECT_THAT(together("a,E_lips?,1.ply\nb,E_lips!,2.ply\nb,E_lips!,3.ply\n"),
                ElementsAre("m.csv: expressions 'E_lips?' and 'E_lips!' are both called E_LIPS- and count as one; use "
                            "other letters or digits if they are two"));
    EXPECT_THAT(together("a,E_\xE9,1.ply\na,E_\xFC,2.ply\n"), ElementsAre(HasSubstr("are both called E_-")));
    EXPECT_THAT(together("a,bite lip,1.ply\na,bite-lip,2.ply\na,BITE_LIP,3.ply\na,AU12,4.ply\na,12,5.ply\n"),
                IsEmpty());
}

TEST(Manifest, paths_that_leave_the_folder_are_refused_with_line_and_value) {
    EXPECT_THAT(manifest_error("subject,expression,scan\nA,N,../secret.ply\n"),
                HasSubstr("line 2: scan '../secret.ply' leads out"));
    EXPECT_THAT(manifest_error("subject,expression,scan\nA,N,a/../../secret.ply\n"), HasSubstr("leads out"));
    EXPECT_THAT(manifest_error("subject,expression,scan\nA,N,/etc/passwd\n"), HasSubstr("leads out"));
    EXPECT_THAT(manifest_error("subject,expression,scan,landmarks\nA,N,a.ply,../b.pp\n"),
                HasSubstr("landmarks '../b.pp' leads out"));
}

TEST(Manifest, from_windows_has_backslashes_semicolons_and_a_row_without_content) {
    for (const char* text : {"subject,expression,scan,landmarks\nA,N,a\\1.ply,a\\1.csv\n,,,\n",
                             "subject;expression;scan;landmarks\r\nA;N;a\\1.ply;a\\1.csv\r\n;;;\r\n",
                             "sep=\t\nsubject\texpression\tscan\tlandmarks\t\nA\tN\ta/1.ply\ta/1.csv\t\n\t\t\t\n"}) {
        const auto manifest = parse_manifest(text, "/data/manifest.csv");
        ASSERT_EQ(manifest.scans.size(), 1U) << text;
        EXPECT_EQ(manifest.scans[0].scan_file, "/data/a/1.ply") << text;
        EXPECT_EQ(manifest.scans[0].landmarks_file, "/data/a/1.csv") << text;
    }
    for (const char* scan : {"C:\\faces\\a.ply", "C:/faces/a.ply", "..\\a.ply", "\\\\server\\a.ply"})
        EXPECT_THAT(manifest_error("subject,expression,scan\nA,N," + std::string(scan) + "\n"), HasSubstr("leads out"))
            << scan;
}

TEST(Manifest, of_more_rows_than_memory_should_hold_is_refused) {
    std::string text = "subject,expression,scan\n";
    for (int row = 0; row <= 100'000; ++row) text += "a,N,b\n";
    EXPECT_THAT(manifest_error(text), HasSubstr("more than 100000 scans; split the database"));
}

TEST(Manifest, bad_fields_are_named_with_line_and_value) {
    EXPECT_THAT(manifest_error("subject,scan\nA,a.ply\n"), HasSubstr("expression"));
    EXPECT_THAT(manifest_error("subject,expression,scan\nA,,a.ply\n"), HasSubstr("line 2: expression is empty"));
    EXPECT_THAT(manifest_error("subject,expression,scan\nA,N,\n"), HasSubstr("line 2: scan is empty"));
    EXPECT_THAT(manifest_error("subject,expression,scan,sex\nA,N,a.ply,x\n"), HasSubstr("line 2: sex is 'x'"));
    EXPECT_THAT(manifest_error("subject,expression,scan,unit\nA,N,a.ply,feet\n"),
                testing::AllOf(HasSubstr("line 2"), HasSubstr("feet")));
}

/// A folder with one PLY in centimetres, landmarks in `landmark_file`.
ScanDatabase ply_database(const TemporaryFolder& folder, const std::string& landmark_file,
                          const geometry::Landmarks& landmarks_cm) {
    const auto face = make_face();
    geometry::Mesh mesh;
    for (const auto& p : face.scan.points_mm) mesh.vertices_mm.push_back(p / 10);
    for (int row = 0; row + 1 < face.scan.rows; ++row)
        for (int col = 0; col + 1 < face.scan.cols; ++col) {
            const auto a = static_cast<std::uint32_t>(row * face.scan.cols + col),
                       up = a + static_cast<std::uint32_t>(face.scan.cols);
            mesh.faces.add(std::array{a, a + 1, up + 1, up});
        }
    io::write_mesh(folder.path() / "anna.ply", mesh);
    io::write_landmarks(folder.path() / landmark_file, landmarks_cm);
    base::write_atomically(
        folder.path() / "manifest.csv",
        "subject,expression,scan,landmarks,sex,unit\nanna,neutral,anna.ply," + landmark_file + ",f,cm\n");
    return open_database(folder.path());
}

class LandmarkFile : public testing::TestWithParam<const char*> {};

TEST_P(LandmarkFile, of_a_ply_scan_in_centimetres_comes_out_in_millimetres_under_our_names) {
    const TemporaryFolder folder;
    const auto face = make_face();
    geometry::Transform to_cm = geometry::Transform::Identity();
    to_cm.linear() *= 0.1;  // .mrk.json says mm all the same, as Slicer does
    const std::string file = GetParam();
    const bool bosphorus = file.ends_with(".lm3");
    const auto database = ply_database(
        folder, file, transformed(bosphorus ? to_bosphorus_labels(face.landmarks) : face.landmarks, to_cm));
    EXPECT_EQ(database.layout, DatabaseLayout::manifest);
    const auto loaded = load(database.scans.at(0));
    ASSERT_EQ(loaded.scan.points_mm.size(), face.scan.points_mm.size());
    // Two roundings, divided by 10 and multiplied again, of values up to 80 mm; .fcsv and .mrk.json keep all digits.
    EXPECT_LT((loaded.scan.points_mm[100] - face.scan.points_mm[100]).norm(), 1e-12);
    for (const auto& mark : face.landmarks.all())
        EXPECT_LT((loaded.landmarks.position_mm(mark.name) - mark.position_mm).norm(), 1e-12) << mark.name;
    EXPECT_GT(loaded.scan.faces.size(), 0U);
    EXPECT_FALSE(loaded.scan.organised());
}

INSTANTIATE_TEST_SUITE_P(Formats, LandmarkFile,
                         testing::Values("anna.csv", "anna.pp", "anna.fcsv", "anna.mrk.json", "anna.lm3"));

TEST(Manifest, image_and_image_landmarks_beside_a_scan_belong_to_it_and_its_texture_is_checked) {
    const TemporaryFolder folder;
    auto face = make_face("elsewhere.png");  // the name that the scan file has leads nowhere
    for (auto& t : face.scan.texture_coordinates) t.y() = 1 - t.y();
    write_scan(folder.path(), "bs000_N_N_0", face);
    const auto files = folder.path() / "bs000";
    std::filesystem::rename(files / "bs000_N_N_0.png", files / "bs000_N_N_0.PNG");
    base::write_atomically(folder.path() / "manifest.csv",
                           "subject,expression,scan,landmarks\nanna,N,./bs000/bs000_N_N_0.bnt,bs000/bs000_N_N_0.lm3\n");
    const auto database = open_database(folder.path());
    const auto& entry = database.scans.at(0);
    EXPECT_EQ(entry.landmarks2d_file.filename(), "bs000_N_N_0.lm2");
    EXPECT_EQ(entry.texture_file.filename(), "bs000_N_N_0.PNG");
    const auto loaded = load(entry);
    ASSERT_TRUE(loaded.checks.texture);
    EXPECT_EQ(loaded.checks.texture->best, TextureAxes::u_right_v_down);
    EXPECT_THAT(loaded.remarks, testing::Contains(HasSubstr("were turned")));
}

TEST(Manifest, a_list_without_a_scan_is_refused) {
    const TemporaryFolder folder;
    base::write_atomically(folder.path() / "manifest.csv", "subject,expression,scan\n");
    EXPECT_THAT(message_of<InputError>([&] { (void)open_database(folder.path()); }),
                HasSubstr("manifest.csv: lists no scan"));
}

TEST(SubjectTable, gives_the_sex_in_a_bosphorus_layout) {
    const TemporaryFolder folder;
    write_scan(folder.path(), "bs000_N_N_0", make_face());
    base::write_atomically(folder.path() / "subjects.csv", "subject,sex,age\nBS000,female,30\n");
    EXPECT_EQ(open_database(folder.path()).scans[0].sex, "f");
}

TEST(SubjectTable, errors_name_file_line_and_value) {
    const auto error = [](const std::string& text) {
        return message_of<InputError>([&] { (void)parse_subjects(text, "s.csv"); });
    };
    EXPECT_THAT(error("subject,sex\nbs000,m\nbs001,7\n"), HasSubstr("s.csv: line 3: sex is '7'"));
    EXPECT_THAT(error("subject,sex\n,m\n"), HasSubstr("s.csv: line 2: subject is empty"));
    EXPECT_THAT(error("subject,sex\nbs000,m\nBS000,f\n"), HasSubstr("s.csv: line 3: subject 'bs000' stands twice"));
    EXPECT_THAT(error("subject\nbs000\n"), HasSubstr("s.csv: column 'sex' is missing"));
}

}  // namespace
}  // namespace mimik::database
