#include "capture/marker_set.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "facs/reference_face.h"
#include "tests/support/thrown.h"

namespace mimik::capture {
namespace {

using test::message_of;
using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string three =
    "schema = 1\n"
    "[[marker]]\nname = \"a\"\nsides = \"paired\"\nat = { mouth_corner = 1.0 }\ngroup = [\"b\", \"c\", \"d\"]\n"
    "[[marker]]\nname = \"b\"\nsides = \"middle\"\nat = { chin = 1.0 }\ngroup = [\"a\", \"c\", \"d\"]\n"
    "[[marker]]\nname = \"c\"\nsides = \"middle\"\nat = { nose_tip = 1.0 }\ngroup = [\"a\", \"b\", \"d\"]\n"
    "[[marker]]\nname = \"d\"\nsides = \"middle\"\nat = { upper_lip_outer = 1.0 }\ngroup = [\"a\", \"b\", \"c\"]\n";

TEST(MarkerSet, the_built_in_one_has_68_markers_eight_derived_ones_and_no_fault) {
    EXPECT_THAT(lint_marker_set(builtin_marker_set_text()), IsEmpty());
    EXPECT_EQ(builtin_marker_set().markers.size(), 68U);
    EXPECT_EQ(builtin_marker_set().derived.size(), 8U);
}

TEST(MarkerSet, left_and_right_are_mirror_images) {
    const auto places = place_markers(builtin_marker_set(), facs::reference_landmarks());
    for (const auto& mark : places.all()) {
        if (!mark.name.ends_with("_left")) continue;
        const auto& other = places.position_mm(mark.name.substr(0, mark.name.size() - 5) + "_right");
        EXPECT_LT((other - geometry::Point(-mark.position_mm.x(), mark.position_mm.y(), mark.position_mm.z())).norm(),
                  1e-9);
        EXPECT_GT(mark.position_mm.x(), 0) << "the subject's left is +x";
    }
}

TEST(MarkerSet, no_lip_is_carried_by_the_other) {
    for (const auto& marker : builtin_marker_set().markers)
        for (const auto& other : marker.group) {
            EXPECT_FALSE(marker.name.starts_with("lip_upper") && other.starts_with("lip_lower")) << marker.name;
            EXPECT_FALSE(marker.name.starts_with("lip_lower") && other.starts_with("lip_upper")) << marker.name;
        }
}

TEST(MarkerSet, names_without_a_side_mean_the_same_side_or_both) {
    const auto set = decode_marker_set(three, "three.toml");
    ASSERT_NE(set.find("a_right"), nullptr);
    EXPECT_THAT(set.find("b")->group, ElementsAre("a_right", "a_left", "c", "d"));
    EXPECT_THAT(set.find("a_left")->group, ElementsAre("b", "c", "d"));
}

/// All of them, one a line.
std::string findings_of(const std::string& text) {
    std::string all;
    for (const auto& one : lint_marker_set(text)) all += one.what + '\n';
    return all.empty() ? "none" : all;
}

std::string with(const std::string& old_text, const std::string& new_text) {
    auto text = three;
    return text.replace(text.find(old_text), old_text.size(), new_text);
}

TEST(MarkerSet, the_linter_names_every_kind_of_fault) {
    EXPECT_EQ(findings_of(three), "none");
    EXPECT_FALSE(lint_marker_set("x = ").empty());
    EXPECT_THAT(findings_of("schema = 1\n"), HasSubstr("there is no [[marker]]"));
    EXPECT_THAT(findings_of(with("schema = 1", "schema = 2")), HasSubstr("schema is not 1"));
    EXPECT_THAT(findings_of(with("\"b\", \"c\", \"d\"", "\"b\", \"c\"")), HasSubstr("the group of 'a' has 2 markers"));
    EXPECT_THAT(findings_of(with("\"b\", \"c\", \"d\"", "\"b\", \"c\", \"e\"")), HasSubstr("there is no marker 'e'"));
    EXPECT_THAT(findings_of(with("\"b\", \"c\", \"d\"", "\"b\", \"c\", \"a\"")), HasSubstr("'a' hangs on itself"));
    EXPECT_THAT(findings_of(with("\"b\", \"c\", \"d\"", "\"b\", \"c\", \"c\"")), HasSubstr("names a marker twice"));
    EXPECT_THAT(findings_of(with("name = \"b\"", "name = \"c\"")), HasSubstr("'c' is there twice"));
    EXPECT_THAT(findings_of(with("mouth_corner = 1.0", "mouth = 1.0")), HasSubstr("there is no landmark 'mouth'"));
    EXPECT_THAT(findings_of(with("chin = 1.0", "chin = 0.5")), HasSubstr("weights add up to 0.5"));
    EXPECT_THAT(findings_of(with("chin = 1.0", "nose_tip = 1.0")), HasSubstr("0.0 mm apart on the reference face"));
    EXPECT_THAT(findings_of(with("mouth_corner = 1.0", "chin = 1.0")), HasSubstr("and its mirror image fall together"));
    EXPECT_THAT(findings_of(with("sides = \"middle\"", "sides = \"center\"")), HasSubstr("neither paired nor middle"));
    EXPECT_THAT(findings_of(with("sides = \"paired\"", "sides = \"paired\"\ncolour = 1")),
                HasSubstr("unknown key 'colour'"));
    const std::string derived =
        three + "[[derived]]\nname = \"i\"\nsides = \"middle\"\nat = { lower_lip_inner = 1.0 }\n";
    EXPECT_EQ(findings_of(derived + "group = [\"a\", \"b\"]\n"), "none");
    EXPECT_EQ(findings_of(derived + "sibling = \"d\"\nalong = [\"a\"]\ntowards = \"c\"\n"), "none");
    EXPECT_THAT(findings_of(derived + "sibling = \"d\"\n"), HasSubstr("a sibling needs along"));
    EXPECT_THAT(findings_of(derived + "sibling = \"d\"\nalong = [\"b\", \"b\"]\ntowards = \"c\"\n"),
                HasSubstr("not three different ones"));
    EXPECT_THAT(findings_of(derived + "sibling = \"d\"\nalong = [\"a\"]\ntowards = \"c\"\ngroup = [\"a\"]\n"),
                HasSubstr("a group and a sibling"));
    EXPECT_THAT(findings_of(derived + "sibling = \"a\"\nalong = [\"b\", \"c\"]\ntowards = \"d\"\n"),
                HasSubstr("'a' stands on both sides"));
    EXPECT_THAT(message_of([] { (void)decode_marker_set("schema = 3\n", "own.toml"); }), HasSubstr("own.toml: line "));
}

TEST(MarkerSet, the_linter_checks_the_surface_and_the_openings) {
    const auto surface = [](const std::string& triangle) {
        return findings_of(three + "[surface]\ntriangles = [[\"b\", \"a\", \"d\"], " + triangle +
                           "]\n[[opening]]\nname = \"mouth\"\nsides = \"middle\"\nupper = [\"c\"]\nlower = "
                           "[\"b\"]\n");
    };
    EXPECT_EQ(surface(R"(["d", "a", "c"])"), "none");
    EXPECT_THAT(surface(R"(["d", "a", "e"])"), HasSubstr("there is no marker 'e'"));
    EXPECT_THAT(surface(R"(["d", "a"])"), HasSubstr("not three names"));
    EXPECT_THAT(surface(R"(["c", "a", "d"])"), HasSubstr("is flipped"));
    EXPECT_THAT(surface(R"(["b", "a", "d"])"), HasSubstr("is there twice"));
    EXPECT_THAT(surface(R"(["b", "a", "c"])"), HasSubstr("bridges 'mouth'"));
}

}  // namespace
}  // namespace mimik::capture
