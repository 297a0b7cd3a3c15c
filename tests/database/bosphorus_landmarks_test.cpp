#include "database/bosphorus_landmarks.h"

#include <limits>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "base/errors.h"
#include "base/file.h"
#include "tests/database/temporary_folder.h"

namespace mimik::database {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* good_lm3 =
    "# 3D landmark file\r\n\r\n3 landmarks:\r\nOuter left eye corner\r\n-45.5 30 10\r\nOuter Right EYE corner\r\n44 "
    "31.25 1e1\r\n"
    "Nose tip\r\n0.125 -1 50\r\n";

geometry::Landmarks marks(std::initializer_list<std::pair<const char*, double>> labels_and_x) {
    std::vector<geometry::Landmark> result;
    for (const auto& [label, x] : labels_and_x) result.push_back({label, {x, 0, 0}, label});
    return geometry::Landmarks(std::move(result));
}

std::string lm3_error(const std::string& text) {
    return message_of<InputError>([&] { (void)parse_lm3(text, "bad.lm3"); });
}
std::string lm2_error(const std::string& text) {
    return message_of<InputError>([&] { (void)parse_lm2(text, "bad.lm2"); });
}

TEST(Lm3, carriage_returns_do_not_stick_to_labels) {
    const auto raw = parse_lm3(good_lm3, "a.lm3");
    ASSERT_EQ(raw.size(), 3U);
    EXPECT_EQ(raw.all()[0].name, "Outer left eye corner");
    EXPECT_EQ(raw.all()[1].name, "Outer Right EYE corner");
    EXPECT_EQ(raw.all()[1].position_mm, geometry::Point(44, 31.25, 10));
}

TEST(Lm3, free_text_between_a_star_and_an_empty_line_is_skipped) {
    const auto raw =
        parse_lm3("# x\n* made by hand\nfive landmarks not seen\n\n1 landmarks:\nNose tip\n1 2 3\n", "a.lm3");
    ASSERT_EQ(raw.size(), 1U);
    EXPECT_EQ(raw.all()[0].position_mm, geometry::Point(1, 2, 3));
}

TEST(Lm3, what_is_written_is_read_back_bit_exact) {
    const TemporaryFolder folder;
    const geometry::Landmarks raw(
        {{"Nose tip", {0.1, -1.0 / 3, 1e-300}, "Nose tip"}, {"A label of mine", {1, 2, 3}, ""}});
    write_lm3(folder.path() / "a.lm3", raw);
    const auto again = read_lm3(folder.path() / "a.lm3");
    ASSERT_EQ(again.size(), 2U);
    EXPECT_EQ(again.all()[0].position_mm, raw.all()[0].position_mm);
    EXPECT_EQ(again.all()[1].name, "A label of mine");
}

TEST(Lm3, a_written_file_has_the_lines_that_other_readers_count_on) {
    const TemporaryFolder folder;
    write_lm3(folder.path() / "a.lm3", geometry::Landmarks({{"Nose tip", {1, 2.5, -3}, ""}}));
    EXPECT_EQ(base::read_text(folder.path() / "a.lm3"),
              "# 3D landmarks, millimetres\n\n1 landmarks:\nNose tip\n1 2.5 -3\n");
}

TEST(Lm3, damage_is_reported_with_file_and_line) {
    EXPECT_THAT(lm3_error(""), HasSubstr("bad.lm3: has no line '<N> landmarks:'"));
    EXPECT_THAT(lm3_error("# x\n\n1000000 landmarks:\n"),
                HasSubstr("bad.lm3: line 3: the number of landmarks is 1000000"));
    EXPECT_THAT(lm3_error("# x\n\n2 landmarks:\nNose tip\n1 2 3\n"), HasSubstr("has 1 of the 2 landmarks"));
    EXPECT_THAT(lm3_error("# x\n\n1 landmarks:\nNose tip\n1 2\n"),
                HasSubstr("bad.lm3: line 5: coordinate of landmark 'Nose tip'"));
    EXPECT_THAT(lm3_error("# x\n\n1 landmarks:\nNose tip\n1 2 nan\n"), HasSubstr("'nan', not a finite number"));
    EXPECT_THAT(lm3_error("# x\n\n2 landmarks:\nA\n1 2 3\nA\n1 2 3\n"), HasSubstr("landmark 'A' appears twice"));
}

TEST(Lm2, labels_and_positions_are_matched_in_order) {
    const auto read = parse_lm2(
        "# x\n\n2 landmarks:\n\nLabels:\nNose tip\nChin middle\n\n2D Image coordinates:\n10.5 20\n11 30\n", "a.lm2");
    ASSERT_EQ(read.size(), 2U);
    EXPECT_EQ(read[0].label, "Nose tip");
    EXPECT_EQ(read[0].column, 10.5);
    EXPECT_EQ(read[1].row, 30);
}

TEST(Lm2, what_is_written_is_read_back_bit_exact) {
    const TemporaryFolder folder;
    write_lm2(folder.path() / "a.lm2", {{"Nose tip", 0.1, 1.0 / 3}, {"Chin middle", 7, 1e-9}});
    const auto again = read_lm2(folder.path() / "a.lm2");
    ASSERT_EQ(again.size(), 2U);
    EXPECT_EQ(again[0].row, 1.0 / 3);
    EXPECT_EQ(again[1].label, "Chin middle");
}

TEST(Lm2, damage_is_reported_with_file_and_line) {
    EXPECT_THAT(lm2_error("# x\n\n2 landmarks:\n\nNose tip\n"),
                HasSubstr("bad.lm2: line 5: 'Nose tip' stands where 'Labels:'"));
    EXPECT_THAT(lm2_error("# x\n\n2 landmarks:\n\nLabels:\nNose tip\n"), HasSubstr("ends before label 2 of 2"));
    EXPECT_THAT(lm2_error("# x\n\n1 landmarks:\n\nLabels:\nA\nB\n"),
                HasSubstr("'B' stands where '2D Image coordinates:'"));
    EXPECT_THAT(lm2_error("# x\n\n1 landmarks:\n\nLabels:\nA\n\n2D Image coordinates:\n1 inf\n"),
                HasSubstr("x y of landmark 'A'"));
}

TEST(BosphorusFiles, the_head_of_lm2_and_lm3_is_one_format) {
    const std::string in_3d = "Nose tip\n1 2 3\n", in_2d = "\nLabels:\nNose tip\n\n2D Image coordinates:\n1 2\n";
    for (const char* head : {"1 landmarks:\n", "# x\r\n\r\n1 Landmarks: \r\n",
                             "* made by hand\n5 landmarks: are not seen\n\n1 landmarks:\n",
                             "made by hand\n1 landmarks:\n", "* no empty line follows\n1 landmarks:\n"}) {
        EXPECT_EQ(parse_lm3(head + in_3d, "a.lm3").size(), 1U) << head;
        EXPECT_EQ(parse_lm2(head + in_2d, "a.lm2").size(), 1U) << head;
    }
    for (const auto& [head, fault] :
         {std::pair{"",
                    "has no line '<N> landmarks:', such as '22 landmarks:'; it is empty, truncated or of another "
                    "format"},
          {"# 22 landmarks:\n", "has no line '<N> landmarks:'"},
          {"# x\n\n2 landmark:\n", "line 3: '2 landmark:' stands where the number of landmarks is expected"},
          {"# x\n-1 landmarks:\n", "line 2: the number of landmarks is -1; a face has 0 to 10000"},
          {"10001 landmarks:\n", "line 1: the number of landmarks is 10001; a face has 0 to 10000"},
          {"few landmarks:\n", "line 1: the number of landmarks is 'few', not a whole number"}}) {
        EXPECT_THAT(lm3_error(head), HasSubstr(std::string("bad.lm3: ") + fault));
        EXPECT_THAT(lm2_error(head), HasSubstr(std::string("bad.lm2: ") + fault));
    }
}

TEST(BosphorusLabels, left_labels_on_the_image_left_are_the_subjects_right) {
    SideReport report;
    const auto named = from_bosphorus_labels(marks({{"Outer left eye corner", -40},
                                                    {"Outer right eye corner", 40},
                                                    {"Left mouth corner", -25},
                                                    {"Nose tip", 0}}),
                                             &report);
    EXPECT_EQ(named.position_mm("eye_outer_right").x(), -40);
    EXPECT_EQ(named.position_mm("eye_outer_left").x(), 40);
    EXPECT_EQ(named.at("mouth_corner_right").original_label, "Left mouth corner");
    EXPECT_TRUE(report.left_label_is_subject_right);
    EXPECT_EQ(report.pairs_agreeing, 1);
}

TEST(BosphorusLabels, left_labels_on_the_subjects_left_are_recognised_by_position) {
    SideReport report;
    const auto named = from_bosphorus_labels(
        marks({{"Outer left eye corner", 40}, {"Outer right eye corner", -40}, {"Left nose peak", 15}}), &report);
    EXPECT_FALSE(report.left_label_is_subject_right);
    EXPECT_EQ(named.position_mm("eye_outer_left").x(), 40);
    EXPECT_EQ(named.position_mm("nose_wing_left").x(), 15);
}

TEST(BosphorusLabels, a_pair_swapped_against_the_rest_is_named) {
    SideReport report;
    (void)from_bosphorus_labels(marks({{"Outer left eye corner", -40},
                                       {"Outer right eye corner", 40},
                                       {"Inner left eye corner", -15},
                                       {"Inner right eye corner", 15},
                                       {"Left mouth corner", 25},
                                       {"Right mouth corner", -25}}),
                                &report);
    EXPECT_TRUE(report.left_label_is_subject_right);
    EXPECT_THAT(report.swapped_pairs, ElementsAre("mouth_corner"));
}

TEST(BosphorusLabels, unknown_labels_are_kept_in_lower_case_and_known_ones_need_no_exact_spelling) {
    const auto named = from_bosphorus_labels(marks({{"My  odd-Label", 1}, {"outer  LEFT eye corner", 2}}));
    EXPECT_EQ(named.all()[0].name, "my_odd_label");
    EXPECT_EQ(named.all()[0].original_label, "My  odd-Label");
    EXPECT_EQ(named.position_mm("eye_outer_right").x(), 2);  // blanks and case do not matter
}

TEST(BosphorusLabels, all_22_regular_labels_come_back_in_bosphorus_spelling_and_order) {
    std::vector<geometry::Landmark> ours;
    double x = -100;  // any order of names; right before left
    for (const auto name : geometry::standard_landmark_names()) {
        const double side = name.ends_with("_left") ? 1 : name.ends_with("_right") ? -1 : 0;
        ours.push_back({std::string(name), {side * 30, x++, 0}, ""});
    }
    const auto labelled = to_bosphorus_labels(geometry::Landmarks(ours));
    ASSERT_EQ(labelled.size(), 22U);
    EXPECT_EQ(labelled.all()[0].name, "Outer left eyebrow");
    EXPECT_EQ(labelled.all()[0].position_mm.x(), -30);  // the subject's right, image-left
    EXPECT_EQ(labelled.all()[21].name, "Chin middle");
    const auto again = from_bosphorus_labels(labelled);
    for (const auto& mark : ours) EXPECT_EQ(again.position_mm(mark.name), mark.position_mm) << mark.name;
}

TEST(AnyLabels, ours_anatomical_and_bosphorus_names_are_recognised) {
    const auto named = from_any_labels(
        marks({{"eye_outer_left", 1}, {"ex_r", 2}, {"Cheilion left", 3}, {"prn", 4}, {"Chin middle", 5}, {"sn", 6}}));
    EXPECT_EQ(named.position_mm("eye_outer_left").x(), 1);
    EXPECT_EQ(named.position_mm("eye_outer_right").x(), 2);
    EXPECT_EQ(named.position_mm("mouth_corner_left").x(), 3);
    EXPECT_EQ(named.position_mm("nose_tip").x(), 4);
    EXPECT_EQ(named.position_mm("chin").x(), 5);
    EXPECT_EQ(named.position_mm("sn").x(), 6);
}

TEST(AnyLabels, our_own_name_of_a_nose_saddle_keeps_its_side_and_the_bosphorus_label_of_it_means_the_viewers) {
    EXPECT_NE(from_any_labels(marks({{"nose_saddle_left", 9}})).find("nose_saddle_left"), nullptr);
    EXPECT_NE(from_any_labels(marks({{"nose_saddle_left", 9}, {"ex_l", 40}, {"ex_r", -40}})).find("nose_saddle_left"),
              nullptr);
    EXPECT_NE(from_any_labels(marks({{"Nose saddle left", -9}})).find("nose_saddle_right"), nullptr);
    // A file of Bosphorus labels in another spelling.
    const auto bosphorus = marks({{"nose_saddle_left", -9}, {"outer_left_eye_corner", -40}});
    EXPECT_NE(from_any_labels(bosphorus).find("nose_saddle_right"), nullptr);
}

TEST(AnyLabels, a_swapped_pair_is_named_whatever_its_names_and_however_the_head_is_turned) {
    const std::vector<std::vector<std::pair<std::string, double>>> files = {
        {{"eye_outer_left", 40},
         {"eye_outer_right", -40},
         {"eye_inner_left", 15},
         {"eye_inner_right", -15},
         {"mouth_corner_left", -25},
         {"mouth_corner_right", 25}},
        {{"ex_l", 40}, {"ex_r", -40}, {"en_l", 15}, {"en_r", -15}, {"ch_l", -25}, {"ch_r", 25}},
        {{"eye_outer_left", 40},
         {"eye_outer_right", -40},
         {"brow_outer_left", 45},
         {"brow_outer_right", -45},
         {"Cheilion left", -25},
         {"Cheilion right", 25}}};
    for (const auto& file : files)
        for (const double angle : {0.0, 1.57, 3.14}) {
            const Eigen::AngleAxisd turn(angle, geometry::Vector::UnitZ());
            std::vector<geometry::Landmark> raw;
            for (const auto& [name, x] : file) raw.push_back({name, turn * geometry::Point(x, 0, 0), ""});
            SideReport report;
            (void)from_any_labels(geometry::Landmarks(raw), &report);
            EXPECT_THAT(report.swapped_pairs, ElementsAre("mouth_corner")) << file[0].first << " " << angle;
        }
    SideReport report;
    (void)from_any_labels(marks({{"ex_l", -40}, {"ex_r", 40}, {"ch_l", -25}, {"ch_r", 25}}), &report);
    EXPECT_THAT(report.swapped_pairs, testing::IsEmpty());  // all alike: the scan is mirrored
}

// Each paired with each, 5000 by 5000, they took 600 MB; the labels themselves take some 2 MB.
TEST(AnyLabels, ten_thousand_spellings_of_two_labels_are_refused_in_bounded_memory) {
    std::vector<geometry::Landmark> raw;
    for (int i = 0; i < 5000; ++i)
        for (const std::string side : {"left", "right"}) {
            std::string label = "outer " + side + " eye corner";  // the bits of i say which letters are capitals
            for (std::size_t bit = 0, at = 0; bit < 13; ++at)
                if (label[at] != ' ' && (i >> bit++ & 1) != 0) label[at] = static_cast<char>(label[at] - 'a' + 'A');
            raw.push_back({label, {0, 0, 0}, ""});
        }
    const geometry::Landmarks spellings(std::move(raw));
    const auto peak_kb = [] {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        return usage.ru_maxrss;
    };
    const auto before_kb = peak_kb();
    EXPECT_THROW((void)from_any_labels(spellings), InputError);
    EXPECT_LT(peak_kb() - before_kb, 100'000);
}

TEST(AnyLabels, the_68_numbers_are_recognised_counted_from_0_and_from_1) {
    for (const int first : {0, 1}) {
        std::vector<geometry::Landmark> raw;
        for (int i = 0; i < 68; ++i) raw.push_back({std::to_string(i + first), {static_cast<double>(i), 0, 0}, ""});
        const auto named = from_any_labels(geometry::Landmarks(raw));
        EXPECT_EQ(named.position_mm("nose_tip").x(), 30);
        EXPECT_EQ(named.position_mm("eye_outer_right").x(), 36);  // image-left: smaller x than 45
        EXPECT_EQ(named.position_mm("mouth_corner_left").x(), 54);
    }
}

TEST(AnyLabels, a_handful_of_numbers_is_no_68_point_scheme) {
    const auto named = from_any_labels(marks({{"30", 1}, {"36", 2}}));
    EXPECT_EQ(named.find("nose_tip"), nullptr);
    EXPECT_EQ(named.position_mm("30").x(), 1);
}

}  // namespace
}  // namespace mimik::database
