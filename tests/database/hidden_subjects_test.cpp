#include "database/hidden_subjects.h"

#include <cstdlib>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "database/known_databases.h"
#include "database/scan_database.h"
#include "tests/database/made_face.h"
#include "tests/database/temporary_folder.h"

namespace mimik::database {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

HiddenSubjects parsed(std::string_view text, const std::vector<std::string>& subjects) {
    return parse_hidden_subjects(text, "list.txt", subjects);
}
std::string error_of(std::string_view text, const std::vector<std::string>& subjects) {
    return message_of<InputError>([&] { (void)parsed(text, subjects); });
}

TEST(HiddenSubjects, a_subject_is_found_by_any_spelling_of_its_number_and_kept_as_the_database_spells_it) {
    for (const char* entry : {"bs001", "BS001", "bs1", "bs01", "bs0001", "1", "01", "001"}) {
        const auto list = parsed(entry, {"Bs001", "bs010", "bs011"});
        EXPECT_THAT(list.subjects, ElementsAre("Bs001")) << entry;
        EXPECT_THAT(list.remarks, IsEmpty()) << entry;
    }
}

TEST(HiddenSubjects, a_line_that_is_a_subject_as_a_whole_is_that_subject_whatever_its_letters) {
    const std::vector<std::string> subjects = {"müller", "j.doe", "anna-maria", "anna", "doe"};
    EXPECT_THAT(parsed("  müller \n", subjects).subjects, ElementsAre("müller"));
    EXPECT_THAT(parsed("J.Doe\r\n", subjects).subjects, ElementsAre("j.doe"));
    EXPECT_THAT(parsed("Anna Maria\n", subjects).subjects, ElementsAre("anna-maria"));
    EXPECT_THAT(parsed("anna_maria # left the study\n", subjects).subjects, ElementsAre("anna-maria"));
    EXPECT_THAT(parsed("j.doe, müller; (anna)\n", subjects).subjects, ElementsAre("anna", "j.doe", "müller"));
}

TEST(HiddenSubjects, every_entry_that_matches_no_subject_is_remarked_with_its_line) {
    const auto list = parsed("bs000\nnobody\nbs077 x.y\n", {"bs000"});
    EXPECT_THAT(list.subjects, ElementsAre("bs000", "bs077"));  // also one whose scans are not here
    EXPECT_THAT(list.remarks, ElementsAre(HasSubstr("list.txt: line 2: 'nobody' is no subject"),
                                          HasSubstr("line 3: no scan of 'bs077' is here"),
                                          HasSubstr("line 3: 'x' is no subject"), HasSubstr("'y' is no subject")));
}

TEST(HiddenSubjects, a_list_of_a_size_that_no_list_has_is_refused_before_it_is_read) {
    const TemporaryFolder folder;
    write_scan(folder.path(), "bs000_N_N_0", make_face());
    const auto file = folder.path() / "unallowed_subjects.txt";
    base::write_atomically(file, "bs000\n");
    std::filesystem::resize_file(file, std::uintmax_t{1} << 40);  // sparse: nobody could hold it
    const auto expected = AllOf(HasSubstr("unallowed_subjects.txt: has 1099511627776 bytes"), HasSubstr("1048576"));
    EXPECT_THAT(message_of<InputError>([&] { (void)open_database(folder.path()); }), expected);
    EXPECT_THAT(message_of<InputError>([&] { refuse_hidden_file(folder.path() / "bs000/bs000_N_N_0.bnt"); }), expected);
}

TEST(HiddenSubjects, a_list_that_would_hide_nobody_is_refused) {
    EXPECT_THAT(error_of("# names\n\nnobody\n", {"bs000"}),
                AllOf(HasSubstr("list.txt: line 3: 'nobody'"), HasSubstr("write one subject a line")));
    EXPECT_THAT(error_of("12\n", {"anna", "müller"}), HasSubstr("line 1: '12'"));   // numbers are no subjects there
    EXPECT_THAT(error_of("m\xfcller\n", {"anna", "müller"}), HasSubstr("line 1"));  // Latin-1
    EXPECT_THAT(error_of(std::string_view("b\0s\0"
                                          "0\0",
                                          6),
                         {"bs000"}),
                HasSubstr("not plain text"));                                                         // UTF-16
    EXPECT_THAT(parsed("bs000\rbs001", {"bs000", "bs001"}).subjects, ElementsAre("bs000", "bs001"));  // two lines
}

TEST(HiddenSubjects, a_list_of_comments_hides_nobody) {
    EXPECT_THAT(parsed("", {"bs000"}).subjects, IsEmpty());
    EXPECT_THAT(parsed("# bs000\n\n", {"bs000"}).subjects, IsEmpty());
}

TEST(HiddenSubjects, the_lists_name_is_taken_without_regard_to_case) {
    const TemporaryFolder folder;
    EXPECT_THAT(hidden_subjects_files(folder.path()), IsEmpty());
    base::write_atomically(folder.path() / "Unallowed_Subjects.TXT", "1\n");
    EXPECT_THAT(hidden_subjects_files(folder.path()), ElementsAre(folder.path() / "Unallowed_Subjects.TXT"));
}

class RefuseHiddenFile : public testing::Test {
protected:
    std::string refused(const std::filesystem::path& file) {
        base::write_atomically(folder_.path() / file, "a scan");
        return message_of<InputError>([&] { refuse_hidden_file(folder_.path() / file); });
    }
    void list(const std::string& text) { base::write_atomically(folder_.path() / "Unallowed_subjects.txt", text); }
    static constexpr const char* shown = "nothing was thrown";
    TemporaryFolder folder_;
};

TEST(HiddenSubjectsOf, lists_in_the_folder_and_the_two_above_it_count_and_those_above_refuse_nothing) {
    const TemporaryFolder folder;
    const auto root = folder.path() / "a/b";
    std::filesystem::create_directories(root / "c");
    base::write_atomically(folder.path() / "unallowed_subjects.txt", "bs002\nof another database\n");
    base::write_atomically(folder.path() / "a/unallowed_subjects.txt", "nobody\n");
    base::write_atomically(root / "unallowed_subjects.txt", "1 nobody\n");
    const std::vector<std::string> subjects = {"bs000", "bs001", "bs002"};
    for (const auto& spelling : {root, root / "", root / "c/.."}) {
        const auto hidden = hidden_subjects_of(spelling, subjects);
        EXPECT_THAT(hidden.subjects, ElementsAre("bs001", "bs002"));
        EXPECT_THAT(hidden.remarks, ElementsAre(HasSubstr("'nobody' is no subject")));
    }
    EXPECT_THAT(hidden_subjects_of(root / "c", subjects).subjects, ElementsAre("bs001"));  // bs002's is three above
    const TemporaryFolder elsewhere;
    std::filesystem::create_symlink(root, elsewhere.path() / "link");
    base::write_atomically(elsewhere.path() / "unallowed_subjects.txt", "bs000\n");
    EXPECT_THAT(hidden_subjects_of(elsewhere.path() / "link", subjects).subjects,
                ElementsAre("bs000", "bs001", "bs002"));
}

TEST(HiddenSubjectsOf, where_only_some_subjects_are_known_a_list_that_names_none_of_them_is_no_mistake) {
    const TemporaryFolder folder;
    base::write_atomically(folder.path() / "unallowed_subjects.txt", "anna\n");
    const std::vector<std::string> subjects = {"ben"};
    EXPECT_THAT(hidden_subjects_of(folder.path(), subjects, KnownSubjects::some).subjects, IsEmpty());
    EXPECT_THAT(message_of<InputError>([&] { (void)hidden_subjects_of(folder.path(), subjects); }),
                HasSubstr("nobody would be hidden"));
}

TEST(HiddenSubjects, the_text_of_a_list_reads_back_as_the_same_subjects) {
    const std::vector<std::string> subjects = {"anna-maria", "bs001", "j.doe"};
    EXPECT_EQ(parsed(hidden_subjects_text(subjects), subjects).subjects, subjects);
    EXPECT_EQ(hidden_subjects_text({}), "");
}

TEST_F(RefuseHiddenFile, a_file_is_refused_by_its_own_name_or_its_folders_up_to_four_below_the_list) {
    list("BS000\n7\nnobody\n");
    EXPECT_THAT(refused("bs000_N_N_0.ply"), HasSubstr("subject 'bs000' stands in"));
    EXPECT_THAT(refused("bs000/x.bnt"), HasSubstr("subject 'bs000'"));
    EXPECT_THAT(refused("truth/bs007/x.ply"), HasSubstr("subject 'bs007'"));
    EXPECT_EQ(refused("bs001/bs001_N_N_0.bnt"), shown);
    EXPECT_EQ(refused("bs001_N_N_0.bnt"), shown);
    EXPECT_THAT(refused("sheets/bs000.png"), HasSubstr("subject 'bs000'"));
    EXPECT_EQ(refused("a/7.ply"), shown);  // an action unit, more likely
    EXPECT_THAT(refused("a/b/truth/bs000/x.ply"), HasSubstr("subject 'bs000'"));
    EXPECT_EQ(refused("a/b/c/d/bs000/x.bnt"), shown);  // five below
}

TEST_F(RefuseHiddenFile, a_link_to_a_hidden_file_is_refused) {
    list("bs000\n");
    (void)refused("bs000/x.bnt");
    const TemporaryFolder elsewhere;
    std::filesystem::create_symlink(folder_.path() / "bs000/x.bnt", elsewhere.path() / "y.bnt");
    EXPECT_THAT(message_of<InputError>([&] { refuse_hidden_file(elsewhere.path() / "y.bnt"); }),
                HasSubstr("subject 'bs000'"));
}

TEST_F(RefuseHiddenFile, a_manifest_beside_or_below_the_list_says_whose_file_it_is) {
    list("müller\n");
    base::write_atomically(folder_.path() / "manifest.csv",
                           "subject,expression,scan\nmüller,N,scans/1.ply\nanna,N,scans/2.ply\n");
    EXPECT_THAT(refused("scans/1.ply"), HasSubstr("subject 'müller'"));
    EXPECT_EQ(refused("scans/2.ply"), shown);
    base::write_atomically(folder_.path() / "db/manifest.csv", "subject,expression,scan\nmüller,N,1.ply\n");
    EXPECT_THAT(refused("db/1.ply"), HasSubstr("subject 'müller'"));  // a manifest below the list
}

TEST_F(RefuseHiddenFile, a_list_of_the_database_hides_the_files_of_a_workspace_that_was_made_before) {
    const TemporaryFolder elsewhere;
    const auto face = elsewhere.path() / "work/faces/bs001/bs001_N_N_0.ply";
    base::write_atomically(face, "ply");
    base::write_atomically(elsewhere.path() / "work/workspace.json",
                           R"({"database": ")" + folder_.path().string() + R"(", "hidden_subjects": ["bs003"]})");
    const auto error = [](const std::filesystem::path& file) {
        return message_of<InputError>([&] { refuse_hidden_file(file); });
    };
    EXPECT_EQ(error(face), shown);
    list("1\n");
    EXPECT_THAT(error(face), AllOf(HasSubstr("subject 'bs001' stands in"), HasSubstr(folder_.path().string())));
    EXPECT_THAT(error(elsewhere.path() / "work/models/default/bs001/AU12.json"), HasSubstr("subject 'bs001'"));
    EXPECT_THAT(error(elsewhere.path() / "work/faces/bs003/bs003_N_N_0.json"),
                HasSubstr("subject 'bs003' was hidden when"));
    EXPECT_EQ(error(elsewhere.path() / "work/faces/bs002/bs002_N_N_0.ply"), shown);
    // While a run writes the workspace, too.
    std::filesystem::rename(elsewhere.path() / "work/workspace.json", elsewhere.path() / "work/workspace.before.json");
    EXPECT_THAT(error(face), HasSubstr("subject 'bs001' stands in"));
}

TEST_F(RefuseHiddenFile, a_mesh_that_says_whose_it_is_is_refused_wherever_it_lies) {
    list("bs001\n");
    const TemporaryFolder elsewhere;
    const auto database = folder_.path().string();
    const auto write = [&](const char* name, const std::string& text) {
        base::write_atomically(elsewhere.path() / name, text);
        return message_of<InputError>([&] { refuse_hidden_file(elsewhere.path() / name); });
    };
    const auto ply = [&](const std::string& target) {
        return "ply\nformat ascii 1.0\ncomment made_by: Mimik\ncomment target: " + target +
               "\ncomment database: " + database + "\nend_header\n";
    };
    EXPECT_THAT(write("a.ply", ply("bs001_N_N_0")), HasSubstr("subject 'bs001' stands in"));
    EXPECT_EQ(write("b.ply", ply("bs002_N_N_0")), shown);
    EXPECT_THAT(write("c.obj", "# source: the mean (bs002_N_N_0 bs001_N_N_0)\n# database: " + database + "\nv 0 0 0\n"),
                HasSubstr("subject 'bs001' stands in"));
    const auto array = [](const std::string& name, const std::string& value) {
        std::string numbers;
        for (const char c : value) numbers += std::to_string(static_cast<unsigned char>(c)) + " ";
        return "<Array type=\"String\" Name=\"" + name +
               "\" NumberOfComponents=\"1\" NumberOfTuples=\"1\" format=\"ascii\">\n" + numbers + "0\n</Array>\n";
    };
    EXPECT_THAT(write("d.vtp", "<VTKFile><PolyData><FieldData>\n" + array("subjects", "bs007 bs001") +
                                   array("database", database) + "</FieldData></PolyData></VTKFile>"),
                HasSubstr("subject 'bs001' stands in"));
    const auto glb = [](std::string json) {
        while (json.size() % 4 != 0) json += ' ';
        const auto word = [](std::size_t value) {
            return std::string{static_cast<char>(value & 0xff), static_cast<char>(value >> 8 & 0xff), 0, 0};
        };
        return "glTF" + word(2) + word(20 + json.size()) + word(json.size()) + "JSON" + json;
    };
    EXPECT_THAT(
        write("e.glb", glb(R"({"asset":{"extras":{"target":"bs001_N_N_0","database":")" + database + R"("}}})")),
        HasSubstr("subject 'bs001' stands in"));
    EXPECT_THAT(write("f.json", R"({"sources": ["bs001_N_N_0"], "schema": 1})"), shown);  // a model says no database
    EXPECT_EQ(write("g.ply", "ply\ncomment target: bs001_N_N_0\ncomment database: ../db\nend_header\n"), shown);
    EXPECT_EQ(write("h.glb", "glTF"), shown);
}

TEST_F(RefuseHiddenFile, a_file_that_has_the_mark_of_its_database_is_refused_by_who_remembers_it) {
    list("bs001\n");
    const TemporaryFolder elsewhere, cache;
    const char* before = std::getenv("XDG_CACHE_HOME");
    const std::string kept = before ? before : "";
    ::setenv("XDG_CACHE_HOME", cache.path().c_str(), 1);
    const auto refused_as = [&](const std::string& database) {
        base::write_atomically(
            elsewhere.path() / "a.ply",
            "ply\nformat ascii 1.0\ncomment target: bs001_N_N_0\ncomment database: " + database + "\nend_header\n");
        return message_of<InputError>([&] { refuse_hidden_file(elsewhere.path() / "a.ply"); });
    };
    const auto mark = database_mark(folder_.path());
    EXPECT_EQ(mark.find(folder_.path().parent_path().string()), std::string::npos);
    EXPECT_TRUE(mark.starts_with(folder_.path().filename().string() + " ("));
    EXPECT_EQ(refused_as(mark), shown);  // nobody knows where that is
    EXPECT_EQ(remember_database(folder_.path() / ""), mark);
    EXPECT_EQ(database_of_mark(mark), folder_.path());
    EXPECT_THAT(refused_as(mark), HasSubstr("subject 'bs001' stands in"));

    // What is made of a file of an earlier version, which says the path, does not.
    (void)refused_as(folder_.path().string());
    const std::vector<std::filesystem::path> files = {elsewhere.path() / "a.ply"};
    const auto said = said_in_files(origin_to_carry(files));
    EXPECT_THAT(said, testing::Contains(testing::Pair("database", mark)));

    // A memory that is of another folder is none; nor is what looks like a mark.
    for (const auto& entry : std::filesystem::directory_iterator(cache.path() / "mimik" / "databases"))
        base::write_atomically(entry.path(), "/somewhere/else");
    EXPECT_TRUE(database_of_mark(mark).empty());
    for (const char* other : {"db", "db (0123456789abcde)", "db (../../../etc/pass)", "()", ""})
        EXPECT_TRUE(database_of_mark(other).empty()) << other;
    before ? ::setenv("XDG_CACHE_HOME", kept.c_str(), 1) : ::unsetenv("XDG_CACHE_HOME");
}

TEST_F(RefuseHiddenFile, a_list_that_is_a_folder_is_an_error_and_hides_nobody_in_silence) {
    std::filesystem::create_directories(folder_.path() / "Unallowed_Subjects.txt");
    EXPECT_THAT(refused("bs001/x.bnt"),
                HasSubstr("Unallowed_Subjects.txt: is a folder, so nobody knows whom it hides"));
    const std::vector<std::string> subjects = {"bs001"};
    EXPECT_THAT(message_of<InputError>([&] { (void)hidden_subjects_of(folder_.path(), subjects); }),
                HasSubstr("is a folder, so nobody knows whom it hides"));
    EXPECT_THAT(message_of<InputError>([&] { (void)hidden_subjects_of(folder_.path() / "a", subjects); }),
                HasSubstr("is a folder"));
}

}  // namespace
}  // namespace mimik::database
