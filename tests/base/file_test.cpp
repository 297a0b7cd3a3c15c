#include "base/file.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <locale>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/errors.h"
#include "base/output_folder.h"
#include "base/temporary.h"

namespace mimik::base {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class File : public testing::Test {
protected:
    void SetUp() override {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  (std::string("mimik_file_") + test->name() + "_" + std::to_string(::getpid()));
        std::filesystem::remove_all(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    std::filesystem::path folder_;
};

template <class Action>
std::string input_error(Action action) {
    try {
        action();
    } catch (const InputError& e) {
        return e.what();
    }
    return "no InputError";
}

TEST_F(File, comes_back_as_it_was_written_zero_bytes_included) {
    const std::string content("a\0b\r\n\xff", 6);
    write_atomically(folder_ / "deep" / "er" / "x.bin", content);
    EXPECT_EQ(read_text(folder_ / "deep" / "er" / "x.bin"), content);
    const auto bytes = read_bytes(folder_ / "deep" / "er" / "x.bin");
    ASSERT_EQ(bytes.size(), 6U);
    EXPECT_EQ(bytes[5], 0xff);
}

TEST_F(File, an_empty_one_is_read_as_empty) {
    write_atomically(folder_ / "empty", "");
    EXPECT_TRUE(read_bytes(folder_ / "empty").empty());
}

TEST_F(File, a_missing_one_a_folder_and_a_device_are_refused_by_name) {
    write_atomically(folder_ / "x", "x");
    EXPECT_THAT(input_error([&] { (void)read_bytes(folder_ / "none.bnt"); }),
                AllOf(HasSubstr("none.bnt"), HasSubstr("no such file")));
    EXPECT_THAT(input_error([&] { (void)read_text(folder_); }),
                AllOf(HasSubstr(folder_.string()), HasSubstr("folder")));
    EXPECT_THAT(input_error([] { (void)read_bytes("/dev/zero"); }),
                AllOf(HasSubstr("/dev/zero"), HasSubstr("regular file")));
}

TEST_F(File, one_larger_than_allowed_is_refused_with_both_sizes) {
    write_atomically(folder_ / "big", "12345");
    EXPECT_THAT(input_error([&] { (void)read_bytes(folder_ / "big", 4); }),
                AllOf(HasSubstr("5 bytes"), HasSubstr("4")));
    EXPECT_EQ(read_bytes(folder_ / "big", 5).size(), 5U);
}

TEST_F(File, a_writer_that_throws_leaves_the_old_content_and_no_litter) {
    write_atomically(folder_ / "kept", "old");
    EXPECT_THROW(write_atomically(folder_ / "kept",
                                  [](std::ostream& out) {
                                      out << "half";
                                      throw std::runtime_error("stop");
                                  }),
                 std::runtime_error);
    EXPECT_EQ(read_text(folder_ / "kept"), "old");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(File, a_full_disk_is_an_error_that_names_the_file) {
    // A stream that a writer spoils behaves like a full disk.
    EXPECT_THAT(input_error([&] {
                    write_atomically(folder_ / "full", [](std::ostream& out) { out.setstate(std::ios::badbit); });
                }),
                AllOf(HasSubstr("full"), HasSubstr("could not be written")));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "full"));
}

TEST_F(File, a_folder_or_a_place_below_a_file_cannot_be_written) {
    write_atomically(folder_ / "x", "x");
    EXPECT_THAT(input_error([&] { write_atomically(folder_, "y"); }), HasSubstr("is a folder"));
    EXPECT_THAT(input_error([&] { write_atomically(folder_ / "x" / "y", "y"); }),
                AllOf(HasSubstr("x/y"), HasSubstr("folder cannot be made")));
}

TEST_F(File, numbers_are_written_with_a_point_whatever_the_global_locale) {
    struct CommaNumbers : std::numpunct<char> {
        [[nodiscard]] char do_decimal_point() const override { return ','; }
    };
    const auto before = std::locale::global(std::locale(std::locale::classic(), new CommaNumbers));
    write_atomically(folder_ / "number", [](std::ostream& out) { out << 1.5; });
    std::locale::global(before);
    EXPECT_EQ(read_text(folder_ / "number"), "1.5");
}

TEST_F(File, of_a_long_file_the_head_is_read_and_of_a_short_one_the_whole) {
    const auto file = folder_ / "long";
    write_atomically(file, std::string(1000, 'a') + "b");
    std::filesystem::resize_file(file, std::uintmax_t{1} << 40);  // sparse: nobody could hold it
    EXPECT_EQ(read_text_head(file, 1001), std::string(1000, 'a') + "b");
    write_atomically(file, "short");
    EXPECT_EQ(read_text_head(file, 1001), "short");
    EXPECT_THAT(input_error([&] { (void)read_text_head(folder_, 10); }), HasSubstr("is a folder"));
}

TEST_F(File, a_name_with_a_line_break_is_refused_before_anything_is_written) {
    for (const auto* name : {"a\nb.ply", "a\x1b[31m.ply", "a\x7f"})
        EXPECT_THAT(input_error([&] { write_atomically(folder_ / name, "x"); }), HasSubstr("control character"))
            << name;
    EXPECT_FALSE(std::filesystem::exists(folder_));
}

TEST_F(File, a_link_is_written_through_only_where_that_is_asked_for) {
    write_atomically(folder_ / "store" / "real", "old");
    std::filesystem::create_symlink("store/real", folder_ / "link");
    std::filesystem::create_symlink("link", folder_ / "link2");
    EXPECT_EQ(where_links_lead(folder_ / "link2"), folder_ / "store" / "real");
    write_atomically(where_links_lead(folder_ / "link2"), "new");
    EXPECT_EQ(read_text(folder_ / "store" / "real"), "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link"));
    write_atomically(folder_ / "link", "own");
    EXPECT_FALSE(std::filesystem::is_symlink(folder_ / "link"));
    EXPECT_EQ(read_text(folder_ / "store" / "real"), "new");
    std::filesystem::create_symlink("loop", folder_ / "loop");
    EXPECT_THAT(input_error([&] { (void)where_links_lead(folder_ / "loop"); }), HasSubstr("leads nowhere"));
    EXPECT_EQ(where_links_lead(folder_ / "not there"), folder_ / "not there");
}

TEST_F(File, a_folder_is_tried_without_touching_what_is_there) {
    write_atomically(folder_ / "mimik.probe", "somebody's");
    check_takes_files(folder_);
    EXPECT_EQ(read_text(folder_ / "mimik.probe"), "somebody's");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(File, what_a_killed_writer_left_is_removed_and_what_lives_stays) {
    std::filesystem::create_directories(folder_);
    const TemporaryFile living(folder_);
    const TemporaryFolder living_folder(folder_);
    for (const auto* name :
         {".mimik-0123456789abcdef.part", ".mimik-0123456789ABCDEF.part", ".mimik-0123.part", "x.part"})
        std::ofstream(folder_ / name) << "left";
    std::filesystem::create_directories(folder_ / ".mimik-00000000ffffffff.part" / "bs000");
    std::ofstream(folder_ / "target") << "kept";
    std::filesystem::create_symlink("target", folder_ / ".mimik-1111111111111111.part");
    remove_leftovers(folder_);
    EXPECT_FALSE(std::filesystem::exists(folder_ / ".mimik-0123456789abcdef.part"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / ".mimik-00000000ffffffff.part"));
    for (const auto* name : {".mimik-0123456789ABCDEF.part", ".mimik-0123.part", "x.part", "target"})
        EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;  // not ours
    EXPECT_TRUE(std::filesystem::exists(living.path()));
    EXPECT_TRUE(std::filesystem::exists(living_folder.path()));
}

TEST_F(File, a_temporary_without_a_name_is_nobody_elses_and_goes_with_its_writer) {
    std::filesystem::create_directories(folder_);
    TemporaryFile file(folder_);
    file.lose_name();
    if (file.path().parent_path() == folder_) GTEST_SKIP() << "no /proc here";
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
    std::ofstream(file.path()) << "rows";
    EXPECT_EQ(read_text(file.path()), "rows");
}

}  // namespace
}  // namespace mimik::base
