#include "animation/facial_examples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/thrown.h"

namespace mimik::animation {
namespace {

using testing::HasSubstr;

FacialExamples square() {
    FacialExamples set;
    set.neutral.vertices_mm = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
    set.neutral.faces.add(std::vector<std::uint32_t>{0, 1, 2, 3});
    set.examples = {{"up", {"jawOpen"}, {{0, 0, 1}, {0, 0, 0}, {0, 0, 0}, {0, 0.125, 0}}},
                    {"down", {}, {{0, 0, -1}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}};
    set.feature_vertices = {{"chin", 2}};
    return set;
}

std::string refusal(std::string text, const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
    return test::message_of([&] { (void)decode_example_list(text, "e.toml"); });
}

constexpr const char* list =
    "schema = 1\nneutral = \"n.ply\"\n[[example]]\nname = \"a\"\nfile = \"a.ply\"\n"
    "arkit = [\"jawOpen\"]\n[feature_vertices]\nchin = 2\n";

TEST(FacialExamples, what_was_written_reads_back) {
    const test::TemporaryFolder folder;
    write_facial_examples(folder.path(), square());
    const auto set = read_facial_examples(folder.path());
    ASSERT_EQ(set.examples.size(), 2U);
    EXPECT_EQ(set.examples[0].name, "up");
    EXPECT_EQ(set.examples[0].arkit, std::vector<std::string>{"jawOpen"});
    EXPECT_EQ(set.examples[0].displacement_mm, square().examples[0].displacement_mm);
    EXPECT_EQ(set.feature_vertices, square().feature_vertices);
    EXPECT_EQ(set.neutral.faces.corners, square().neutral.faces.corners);
}

TEST(FacialExamples, a_mesh_of_another_topology_is_named) {
    const test::TemporaryFolder folder;
    write_facial_examples(folder.path(), square());
    auto other = square().neutral;
    other.vertices_mm.emplace_back(5, 5, 5);
    other.faces.add(std::vector<std::uint32_t>{0, 1, 4});
    io::write_mesh(folder.path() / "down.ply", other);
    EXPECT_THAT(test::message_of([&] { (void)read_facial_examples(folder.path()); }),
                HasSubstr("down.ply: 5 vertices where "));
    other = square().neutral;
    other.faces = {};
    other.faces.add(std::vector<std::uint32_t>{0, 2, 1, 3});
    io::write_mesh(folder.path() / "down.ply", other);
    EXPECT_THAT(test::message_of([&] { (void)read_facial_examples(folder.path()); }),
                HasSubstr("down.ply: its faces are not those of "));
}

TEST(FacialExamples, what_is_wrong_in_the_list_is_named_with_its_line) {
    EXPECT_EQ(decode_example_list(list, "e.toml").entries.at(0).file, "a.ply");
    EXPECT_THAT(refusal(list, "schema = 1", "schema = 2"), HasSubstr("schema is not 1"));
    EXPECT_THAT(refusal(list, "n.ply", "../n.ply"),
                HasSubstr("e.toml: line 2: 'neutral' is '../n.ply'; give the name"));
    EXPECT_THAT(refusal(list, "file = ", "fil = "), HasSubstr("unknown key 'fil'"));
    EXPECT_THAT(refusal(list, "name = \"a\"", "name = \"neutral\""), HasSubstr("and not 'neutral'"));
    EXPECT_THAT(refusal(list, "jawOpen", "jawClosed"), HasSubstr("ARKit has no blendshape 'jawClosed'"));
    EXPECT_THAT(refusal(list, "chin = 2", "chin = -2"), HasSubstr("e.toml: line 8: 'chin' is no vertex"));
    EXPECT_THAT(refusal(list, "[[example]]", "[[example"), HasSubstr("e.toml: line 3: "));
    EXPECT_THAT(refusal(list, "[feature", "[[example]]\nname = \"a\"\nfile = \"b.ply\"\n[feature"),
                HasSubstr("two examples are called a"));
}

}  // namespace
}  // namespace mimik::animation
