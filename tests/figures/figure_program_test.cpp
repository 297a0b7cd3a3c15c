// The programs as a shell meets them. MIMIK_PROGRAMS is the folder of `mimik` and `mimik-figure`.
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "io/mesh_io.h"
#include "tests/figures/shapes.h"

namespace mimik::figures {
namespace {

using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

struct Ended {
    int code = -1;
    std::string said;  ///< both streams
};

Ended run(const std::string& command) {
    Ended ended;
    FILE* stream = popen((command + " 2>&1").c_str(), "r");
    std::array<char, 4096> buffer{};
    for (std::size_t count = 0; (count = fread(buffer.data(), 1, buffer.size(), stream)) > 0;)
        ended.said.append(buffer.data(), count);
    const int status = pclose(stream);
    if (WIFEXITED(status)) ended.code = WEXITSTATUS(status);
    return ended;
}

class FigureProgram : public testing::Test {
protected:
    FigureProgram() {
        fs::create_directories(folder_);
        io::write_mesh(folder_ / "face.ply", square(100));
    }
    ~FigureProgram() override { fs::remove_all(folder_); }
    [[nodiscard]] Ended figure(const std::string& arguments) const {
        return run("cd '" + folder_.string() + "' && '" + MIMIK_PROGRAMS "/mimik' figure " + arguments);
    }
    fs::path folder_ = fs::path(testing::TempDir()) /
                       ("mimik_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(FigureProgram, draws_panels_with_captions_through_the_main_program) {
    SKIP_WITHOUT_RENDERER();
    const auto ended = figure("-o out.png face.ply - face.ply --size 120x100 --caption '(a)' --view front --json");
    ASSERT_EQ(ended.code, 0) << ended.said;
    EXPECT_THAT(ended.said, AllOf(HasSubstr("\"output\": \"out.png\""), HasSubstr("\"panels\": 3")));
    const auto size = io::image_size(folder_ / "out.png");
    EXPECT_EQ(size[0], 3 * 120 + 4 * (Figure{}.font_size_px / 2));
    EXPECT_GT(size[1], 100 + 2 * (Figure{}.font_size_px / 2));
}

TEST_F(FigureProgram, bad_input_ends_with_2_and_one_line_that_names_it) {
    struct Case {
        std::string arguments, expected;
    };
    for (const auto& [arguments, expected] :
         std::vector<Case>{{"-o out.png", "no mesh is given"},
                           {"-o out.jpg face.ply", "'out.jpg'"},
                           {"-o out.png none.ply", "none.ply"},
                           {"-o out.png face.ply --view above", "'above'"},
                           {"-o out.png face.ply --size 12", "--size is '12'"},
                           {"-o out.png face.ply --range 0 1", "--range needs --scalar"},
                           {"-o out.png face.ply --scalar depth", "no attribute 'depth'"},
                           {"-o out.png face.ply --caption a --caption b", "--caption is given 2 times for 1 panel"},
                           {"-o out.png face.ply - - --view left --view right", "--view is given 2 times for 3 panels"},
                           {"-o out.png --description d.json --title t", "--title and --description exclude"},
                           {"-o out.png --frobnicate", "--frobnicate"}}) {
        const auto ended = figure(arguments);
        EXPECT_EQ(ended.code, 2) << arguments;
        EXPECT_THAT(ended.said, HasSubstr(expected)) << arguments;
        EXPECT_FALSE(fs::exists(folder_ / "out.png")) << arguments;
    }
}

TEST_F(FigureProgram, help_is_that_of_the_figure_program) {
    const auto ended = figure("--help");
    EXPECT_EQ(ended.code, 0);
    EXPECT_THAT(ended.said, HasSubstr("--scale-bar-mm"));
}

TEST_F(FigureProgram, the_main_program_says_what_is_missing_when_it_stands_alone) {
    fs::copy_file(fs::path(MIMIK_PROGRAMS) / "mimik", folder_ / "mimik");
    const auto ended = run("PATH= '" + (folder_ / "mimik").string() + "' figure -o out.png face.ply");
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.said, AllOf(HasSubstr("mimik-figure is neither"), HasSubstr("install it")));
}

}  // namespace
}  // namespace mimik::figures
