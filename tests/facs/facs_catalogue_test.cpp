#include "facs/facs_catalogue.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "facs/reference_face.h"
#include "geometry/face_axes.h"
#include "tests/support/thrown.h"

namespace mimik::facs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<SidedUnit> units_of(const std::string& text) {
    return builtin_catalogue().units(builtin_catalogue().expression(text));
}
std::string arkit_name_of(const std::string& text) {
    return arkit_name(builtin_catalogue(), builtin_catalogue().expression(text));
}

/// A whole catalogue whose line 12 is `point`.
std::string catalogue_with(const std::string& point) {
    return R"(schema = 1
[[au]]
number = 12
name = "Lip Corner Puller"
region = "lower"
sides = "paired"
muscles = [{ name = "zygomaticus major", source = "cheek bone to mouth corner", reference = "FACS" }]
arkit = "mouthSmile"
zone = [{ at = { mouth_corner = 1.0 }, radii = [0.3, 0.4] }]
points = [
  { name = "corner", kind = "muscle", at = { mouth_corner = 1.0 } },
)" + point +
           "\n]\n";
}

std::string only_finding(const std::string& text, unsigned line, bool error = true) {
    const auto findings = lint_catalogue(text);
    if (findings.size() != 1) return "findings: " + std::to_string(findings.size());
    if (findings[0].line != line) return "line " + std::to_string(findings[0].line);
    if (findings[0].error != error) return findings[0].error ? "an error, not a warning" : "a warning, not an error";
    return findings[0].what;
}

TEST(BuiltinCatalogue, has_nothing_for_the_linter_to_find) {
    for (const auto& finding : lint_catalogue(std::string(builtin_catalogue_text())))
        ADD_FAILURE() << finding.line << ": " << finding.what;
}

TEST(BuiltinCatalogue, has_the_eight_units_of_the_thesis_and_those_that_show_on_a_scan) {
    for (const int number :
         {1, 2, 4, 12, 14, 15, 17, 20, 5, 6, 7, 9, 10, 11, 13, 16, 18, 22, 23, 24, 25, 26, 27, 28, 34, 43, 44})
        EXPECT_NE(builtin_catalogue().find(number), nullptr) << number;
}

TEST(BuiltinCatalogue, has_the_lids_of_one_skin_in_41_42_43_45_and_46) {
    const auto* closed = builtin_catalogue().find(43);
    ASSERT_NE(closed, nullptr);
    for (const int number : {41, 42, 45, 46}) {
        const auto* unit = builtin_catalogue().find(number);
        ASSERT_NE(unit, nullptr) << number;
        ASSERT_EQ(unit->zone.size(), closed->zone.size()) << number;
        EXPECT_EQ(unit->zone.front().lateral_radius, closed->zone.front().lateral_radius) << number;
        ASSERT_EQ(unit->points.size(), closed->points.size()) << number;
        for (std::size_t k = 0; k < closed->points.size(); ++k) {
            EXPECT_EQ(unit->points[k].name, closed->points[k].name) << number;
            EXPECT_EQ(unit->points[k].placement.lateral, closed->points[k].placement.lateral) << number;
            EXPECT_EQ(unit->points[k].placement.up, closed->points[k].placement.up) << number;
        }
        // A blendshape is the full motion.
        EXPECT_EQ(unit->arkit, number < 43 ? "" : "eyeBlink") << number;
    }
}

TEST(BuiltinCatalogue, knows_the_muscles_that_the_thesis_names) {
    const auto muscle = [](int number) { return builtin_catalogue().find(number)->muscles.front().name; };
    EXPECT_EQ(muscle(1), "frontalis, pars medialis");
    EXPECT_EQ(muscle(2), "frontalis, pars lateralis");
    EXPECT_EQ(muscle(4), "corrugator supercilii");
    EXPECT_EQ(muscle(12), "zygomaticus major");
    EXPECT_EQ(muscle(14), "buccinator");
    EXPECT_EQ(muscle(15), "depressor anguli oris (triangularis)");
    EXPECT_EQ(muscle(17), "mentalis");
    EXPECT_EQ(muscle(20), "risorius");
}

TEST(BuiltinCatalogue, has_every_unit_of_table_3_2_of_the_thesis_and_says_where_each_muscle_was_published) {
    for (const int number : {1,  2,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17, 18,
                             20, 22, 23, 24, 25, 26, 27, 28, 38, 39, 41, 42, 43, 44, 45, 46})
        EXPECT_NE(builtin_catalogue().find(number), nullptr) << number;
    EXPECT_THAT(builtin_catalogue().find(13)->name, HasSubstr("Cheek Puffer"));
    for (const auto& unit : builtin_catalogue().action_units())
        for (const auto& muscle : unit.muscles)
            EXPECT_THAT(muscle.reference, testing::ContainsRegex("\\(pp?\\. 3[67]"))
                << unit.number << ' ' << muscle.name;
}

TEST(BuiltinCatalogue, calls_no_lip_or_lid_a_muscle_of_a_unit_that_only_carries_it) {
    const auto kind_of = [](int number, const std::string& name) {
        for (const auto& point : builtin_catalogue().find(number)->points)
            if (point.name == name) return point.kind;
        throw std::runtime_error("no point " + name);
    };
    EXPECT_EQ(kind_of(12, "zygomaticus_high"), ControlKind::muscle);
    EXPECT_EQ(kind_of(12, "upper_lip_side"), ControlKind::carried);
    EXPECT_EQ(kind_of(4, "upper_lid_fold"), ControlKind::carried);
    EXPECT_EQ(kind_of(17, "mentalis"), ControlKind::muscle);
    EXPECT_EQ(kind_of(17, "upper_lip"), ControlKind::carried);
    EXPECT_EQ(kind_of(24, "upper_lip"), ControlKind::muscle);  // the ring around the mouth is what it is
}

TEST(BuiltinCatalogue, makes_emotions_of_table_3_3_where_that_set_is_chosen) {
    const auto thesis = builtin_catalogue().with_emotions("thesis");
    const auto of = [](const FacsCatalogue& catalogue, const std::string& name) {
        std::vector<int> numbers;
        const auto expression = catalogue.expression(name);
        for (const auto& part : expression.units()) numbers.push_back(part.unit);
        return numbers;
    };
    using testing::ElementsAre;
    EXPECT_THAT(of(thesis, "fear"), ElementsAre(1, 2, 4, 5, 20, 27));
    EXPECT_THAT(of(thesis, "ANGER"), ElementsAre(4, 5, 7, 23, 25));
    EXPECT_THAT(of(thesis, "disgust"), ElementsAre(9, 17));
    EXPECT_THAT(of(thesis, "happy"), ElementsAre(6, 12));
    EXPECT_THAT(of(thesis, "sadness"), ElementsAre(1, 4, 15));
    EXPECT_THAT(of(thesis, "surprise"), ElementsAre(1, 2, 5, 26));
    EXPECT_THAT(of(builtin_catalogue(), "disgust"), ElementsAre(9, 15, 16));
    EXPECT_NE(thesis.content_hash(), builtin_catalogue().content_hash());
    try {
        (void)builtin_catalogue().with_emotions("mine");
        FAIL() << "not refused";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(),
                    HasSubstr("emotions 'mine' are not in the built-in catalogue; there are: emfacs, thesis"));
    }
}

TEST(ThesisCatalogue, is_the_built_in_one_but_for_points_that_moved_by_at_most_8_mm) {
    const auto& tuned = thesis_catalogue();
    const double mm = geometry::outer_eye_distance_mm(reference_landmarks());
    double farthest_mm = 0;
    ASSERT_EQ(tuned.action_units().size(), builtin_catalogue().action_units().size());
    for (const auto& unit : builtin_catalogue().action_units()) {
        const auto& other = *tuned.find(unit.number);
        ASSERT_EQ(other.points.size(), unit.points.size()) << unit.number;
        for (std::size_t k = 0; k < unit.points.size(); ++k) {
            const auto &a = unit.points[k].placement, &b = other.points[k].placement;
            EXPECT_EQ(other.points[k].name, unit.points[k].name);
            farthest_mm = std::max(farthest_mm, mm * std::hypot(a.lateral - b.lateral, a.up - b.up));
        }
    }
    EXPECT_LE(farthest_mm, 8.1);  // offsets are written to a tenth of a millimetre
    EXPECT_GT(farthest_mm, 1.0);
    for (const auto& finding : lint_catalogue(std::string(thesis_catalogue_text())))
        EXPECT_FALSE(finding.error) << finding.what;
}

TEST(Placement, names_the_landmarks_that_are_missing_as_landmarks_are_named) {
    const Placement chin{{{"chin", 0.5}, {"mouth_corner", 0.5}}, 0, 0};
    std::vector<geometry::Landmark> marks;
    for (const auto& mark : reference_landmarks().all())
        if (mark.name != "chin" && mark.name != "mouth_corner_right") marks.push_back(mark);
    const geometry::Landmarks few(marks);
    EXPECT_THAT(missing_marks(chin, few, Side::left), testing::ElementsAre("chin"));
    EXPECT_THAT(missing_marks(chin, few, Side::right), testing::ElementsAre("chin", "mouth_corner_right"));
    try {
        (void)place(chin, few, Side::left);
        FAIL() << "not refused";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::AllOf(HasSubstr("chin"), testing::Not(HasSubstr("chin_left"))));
    }
}

TEST(BuiltinCatalogue, resolves_the_six_emotions_to_their_units) {
    for (const auto* name : {"HAPPY", "SADNESS", "SURPRISE", "FEAR", "ANGER", "DISGUST"})
        EXPECT_GE(units_of(name).size(), 2U) << name;
    const auto happy = units_of("happy");
    ASSERT_EQ(happy.size(), 2U);
    EXPECT_EQ(happy[0].unit->number, 6);
    EXPECT_EQ(happy[1].unit->number, 12);
}

TEST(FacsCatalogue, knows_the_units_of_an_emotion_that_was_read_without_it_and_none_of_a_databases_own_word) {
    const auto happy = *parse_expression("HAPPY");
    ASSERT_TRUE(happy.units().empty());
    EXPECT_EQ(builtin_catalogue().units(happy).size(), 2U);
    EXPECT_TRUE(builtin_catalogue().units(*parse_expression("sneer")).empty());  // a database's own word
    EXPECT_THROW((void)builtin_catalogue().expression("sneer"), InputError);
}

TEST(FacsCatalogue, splits_a_code_into_units_and_sides) {
    const auto units = units_of("A12LA15");
    ASSERT_EQ(units.size(), 2U);
    EXPECT_EQ(units[0].side, facs::Side::left);
    EXPECT_EQ(units[1].unit->number, 15);
    EXPECT_EQ(units[1].side, facs::Side::both);
}

TEST(FacsCatalogue, reads_every_way_in_which_mimik_spells_an_expression_as_one) {
    const std::vector<std::pair<std::string, std::vector<std::string>>> spellings = {
        {"12", {"12", "AU12", "au12", "LFAU_12", "A12"}},
        {"12L", {"12L", "12l", "AU12_L", "au12_l", "AU12L"}},
        {"12LW", {"12LW", "12lw", "AU12_LW"}},
        {"A12LWA15", {"A12LWA15", "AU12_LW+AU15"}},
        {"A12A15", {"A12A15", "AU12+AU15", "a12a15"}},
        {"A12LA15", {"A12LA15", "AU12_L+AU15"}},
        {"HAPPY", {"HAPPY", "happy", "E_HAPPY", "joy"}}};
    for (const auto& [code, words] : spellings)
        for (const auto& word : words) {
            const auto expression = builtin_catalogue().expression(word);
            EXPECT_EQ(expression.code(), code) << word;
            // What a model, a morph target and a picture are called can be typed back.
            EXPECT_EQ(builtin_catalogue().expression(expression.name()), expression) << word;
        }
}

TEST(FacsCatalogue, names_low_intensity_apart_from_the_full_motion) {
    EXPECT_EQ(builtin_catalogue().expression("12LW").name(), "AU12_LW");
    EXPECT_EQ(builtin_catalogue().expression("A12LWA15L").name(), "AU12_LW+AU15_L");
    EXPECT_EQ(arkit_name_of("17"), "mouthShrugLower");
    EXPECT_EQ(arkit_name_of("17LW"), "AU17_LW");
}

TEST(FacsCatalogue, refuses_what_is_no_expression_and_says_what_is) {
    for (const auto* word : {"", "N", "smile", "4,12", "12X", "A12A", "AU", "12+"})
        EXPECT_THAT(test::message_of<InputError>([&] { (void)builtin_catalogue().expression(word); }),
                    testing::AllOf(HasSubstr("neither an AU"), HasSubstr("HAPPY")))
            << word;
}

TEST(FacsCatalogue, refuses_half_of_a_unit_that_moves_both_sides_at_once) {
    try {
        (void)builtin_catalogue().expression("17L");
        FAIL() << "accepted";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("AU17 (Chin Raiser) moves both sides at once"));
    }
}

TEST(FacsCatalogue, names_the_units_there_are_when_one_is_unknown) {
    try {
        (void)builtin_catalogue().expression("88");
        FAIL() << "accepted";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::AllOf(HasSubstr("AU88 is not in the catalogue"), HasSubstr("12")));
    }
}

TEST(FacsCatalogue, gives_arkit_names_only_where_arkit_has_that_shape) {
    EXPECT_EQ(arkit_name_of("12L"), "mouthSmileLeft");
    EXPECT_EQ(arkit_name_of("4R"), "browDownRight");
    EXPECT_EQ(arkit_name_of("17"), "mouthShrugLower");
    EXPECT_EQ(arkit_name_of("1"), "browInnerUp");  // ARKit raises both inner brows with one shape
    EXPECT_EQ(arkit_name_of("1L"), "AU1_L");
    EXPECT_EQ(arkit_name_of("12"), "AU12");
}

TEST(CatalogueLinter, is_content_with_a_sound_file) { EXPECT_THAT(lint_catalogue(catalogue_with("")), IsEmpty()); }

TEST(CatalogueLinter, finds_an_unknown_key_with_its_line) {
    EXPECT_THAT(
        only_finding(catalogue_with(R"(  { name = "x", kind = "muscle", weight = 2, at = { nose_wing = 1.0 } },)"), 12),
        HasSubstr("unknown key 'weight'"));
}

TEST(CatalogueLinter, finds_an_unknown_landmark_with_its_line) {
    EXPECT_THAT(only_finding(catalogue_with(R"(  { name = "x", kind = "muscle", at = { mouth_centre = 1.0 } },)"), 12),
                HasSubstr("unknown landmark 'mouth_centre'"));
}

TEST(CatalogueLinter, finds_weights_that_do_not_add_up_to_one) {
    EXPECT_THAT(
        only_finding(catalogue_with(R"(  { name = "x", kind = "muscle", at = { mouth_corner = 0.5, chin = 0.4 } },)"),
                     12),
        HasSubstr("weights add up to 0.9, not 1"));
}

TEST(CatalogueLinter, finds_a_point_name_used_twice) {
    EXPECT_THAT(
        only_finding(catalogue_with(R"(  { name = "corner", kind = "muscle", at = { nose_wing = 1.0 } },)"), 12),
        HasSubstr("point 'corner' stands twice in AU12"));
}

TEST(CatalogueLinter, finds_a_sampling_that_is_no_table_with_its_line) {
    // Line 1 is the schema; what is above the first table stands at the top of the document.
    auto number = catalogue_with("");
    number.insert(number.find('\n') + 1, "sampling = 5\n");
    EXPECT_THAT(only_finding(number, 2), HasSubstr("'sampling' is not a table"));
    const auto text = catalogue_with("") + "\n[[sampling]]\ncoverage_spacing = 0.2\n";
    const auto line = static_cast<unsigned>(std::count(text.begin(), text.begin() + text.find("[[sampling"), '\n')) + 1;
    EXPECT_THAT(only_finding(text, line), HasSubstr("'sampling' is not a table"));
}

TEST(CatalogueLinter, finds_an_emotion_that_stands_twice_whatever_its_case) {
    const auto text = catalogue_with("") + "\n[[emotion]]\nname = \"GLAD\"\nunits = [12]\n";
    EXPECT_THAT(lint_catalogue(text), IsEmpty());
    const auto line = static_cast<unsigned>(std::count(text.begin(), text.end(), '\n')) + 1;
    EXPECT_THAT(only_finding(text + "[[emotion]]\nname = \"glad\"\nunits = [12]\n", line),
                HasSubstr("emotion 'GLAD' stands twice"));
}

TEST(CatalogueLinter, finds_a_point_that_mirrors_on_to_itself) {
    // Half a millimetre beside the midline: too far to count as central, too near to have an image of its own.
    EXPECT_THAT(
        only_finding(
            catalogue_with(R"(  { name = "x", kind = "wrinkle", at = { nose_tip = 1.0 }, offset = [0.005, 0.3] },)"),
            12),
        HasSubstr("fall together on the midline"));
}

TEST(CatalogueLinter, finds_a_landmark_of_one_side_wherever_it_stands) {
    const auto message = HasSubstr("no mirror image: write 'nose_wing'");
    EXPECT_THAT(
        only_finding(catalogue_with(R"(  { name = "x", kind = "wrinkle", at = { nose_wing_left = 1.0 } },)"), 12),
        message);
    // An offset does not make it one that can be mirrored.
    EXPECT_THAT(only_finding(catalogue_with(R"(  { name = "x", kind = "wrinkle", at = { nose_wing_left = 1.0 }, )"
                                            R"(offset = [0.1, 0.0] },)"),
                             12),
                message);
    auto zone = catalogue_with("");
    zone.replace(zone.find("zone = [{ at = { mouth_corner"), 29, "zone = [{ at = { mouth_corner_left");
    EXPECT_THAT(only_finding(zone, 9), HasSubstr("write 'mouth_corner', or"));
    const auto both = [](const char* right) {
        return catalogue_with(fmt::format(
            R"(  {{ name = "x", kind = "wrinkle", at = {{ nose_wing_left = 0.5, nose_wing_right = {} }} }},)", right));
    };
    EXPECT_THAT(lint_catalogue(both("0.5")), IsEmpty());
    EXPECT_EQ(lint_catalogue(both("0.6")).size(), 3U);  // neither weight is the other's, and they add up to 1.1
}

TEST(CatalogueLinter, knows_the_shapes_of_arkit) {
    const auto with = [](const std::string& line) {
        auto text = catalogue_with("");
        return text.replace(text.find("arkit = \"mouthSmile\""), 20, line);
    };
    EXPECT_THAT(only_finding(with("arkit = \"mouthSmail\""), 8), HasSubstr("'mouthSmailLeft' and 'mouthSmailRight'"));
    EXPECT_THAT(only_finding(with("arkit = \"jawOpen\""), 8), HasSubstr("'jawOpenLeft'"));
    EXPECT_THAT(only_finding(with("arkit_whole = \"mouthSmile\""), 8), HasSubstr("no blendshape 'mouthSmile'"));
    EXPECT_THAT(lint_catalogue(with("arkit_whole = \"jawOpen\"")), IsEmpty());
}

TEST(CatalogueLinter, wants_a_published_reference_of_every_muscle) {
    const auto with = [](const std::string& reference) {
        auto text = catalogue_with("");
        return text.replace(text.find(", reference = \"FACS\""), 20, reference);
    };
    EXPECT_THAT(only_finding(with(""), 7), HasSubstr("'reference' is missing"));
    EXPECT_THAT(only_finding(with(", reference = \" \""), 7), HasSubstr("reference of 'zygomaticus major' is empty"));
}

TEST(CatalogueLinter, finds_a_point_on_the_half_that_is_made_by_mirroring) {
    EXPECT_THAT(
        only_finding(
            catalogue_with(R"(  { name = "x", kind = "muscle", at = { nose_wing = 1.0 }, offset = [-0.5, 0.0] },)"),
            12),
        HasSubstr("lies on the subject's right half"));
}

TEST(CatalogueLinter, finds_a_point_off_the_face) {
    EXPECT_THAT(
        only_finding(
            catalogue_with(R"(  { name = "x", kind = "muscle", at = { mouth_corner = 1.0 }, offset = [0.8, 0.0] },)"),
            12, false),
        HasSubstr("point 'x' lies off the reference face"));
}

TEST(CatalogueLinter, warns_of_points_that_fall_together) {
    EXPECT_THAT(
        only_finding(catalogue_with(
                         R"(  { name = "x", kind = "wrinkle", at = { mouth_corner = 1.0 }, offset = [0.0, 0.005] },)"),
                     12, false),
        HasSubstr("points 'x' and 'corner' fall together"));
}

TEST(CatalogueLinter, wants_a_muscle_point) {
    auto text = catalogue_with("");
    text.replace(text.find("kind = \"muscle\""), 15, "kind = \"wrinkle\"");
    EXPECT_THAT(only_finding(text, 2), HasSubstr("AU12 has no muscle point"));
}

TEST(CatalogueLinter, wants_the_whole_shape_of_a_central_unit) {
    auto text = catalogue_with("");
    text.replace(text.find("\"paired\""), 8, "\"central\"");
    EXPECT_THAT(only_finding(text, 2), HasSubstr("use arkit_whole"));
}

TEST(CatalogueLinter, reports_broken_toml_where_it_breaks) {
    const auto findings = lint_catalogue("schema = 1\n[[au]\n");
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_TRUE(findings[0].error);
    EXPECT_EQ(findings[0].line, 2U);
}

TEST(CatalogueLinter, numbers_that_no_catalogue_has_are_errors_at_their_line) {
    EXPECT_THAT(
        only_finding(catalogue_with("{ name = \"x\", kind = \"muscle\", at = { chin = 1e300, nose_wing = -1e300, "
                                    "mouth_corner = 1.0 } }"),
                     12),
        HasSubstr("findings: 3"));  // two weights, and their sum
    const auto findings = lint_catalogue("schema = 1\n[[au]]\nnumber = 1e300\n");
    EXPECT_EQ(findings.back().line, 3U);
    EXPECT_EQ(findings.back().what, "number is 1e+300, not a whole number of 0 to 999");
    EXPECT_THAT(only_finding(catalogue_with("{ name = \"x\", kind = \"muscle\", at = { nose_wing = nan } }"), 12),
                HasSubstr("findings: 2"));  // no number, and the sum
}

TEST(CatalogueLinter, a_file_full_of_faults_costs_neither_memory_nor_patience) {
    std::string text = "schema = 1\n";
    for (int k = 0; k < 100'000; ++k) text += "key" + std::to_string(k) + " = 1\n";
    const auto findings = lint_catalogue(text);
    ASSERT_EQ(findings.size(), 1001U);
    EXPECT_TRUE(std::any_of(findings.begin(), findings.end(),
                            [](const auto& f) { return f.what.starts_with("more than 1000 findings"); }));
    std::string points;  // all in one place: every pair would be worth a warning
    for (int k = 0; k < 20'000; ++k)
        points += "{ name = \"" + std::to_string(k) + "\", kind = \"muscle\", at = { mouth_corner = 1.0 } },\n";
    EXPECT_EQ(lint_catalogue(catalogue_with(points)).size(), 1001U);
    const std::string long_name(1'000'000, 'x');
    EXPECT_LT(
        only_finding(catalogue_with("{ name = \"y\", kind = \"" + long_name + "\", at = { chin = 1.0 } }"), 12).size(),
        100U);
}

std::string many(const std::string& part, std::size_t count) {
    std::string text;
    for (std::size_t k = 0; k < count; ++k) text += part;
    return text;
}

TEST(CatalogueLinter, what_nests_too_deep_for_the_stack_is_an_error_at_its_line) {
    constexpr std::size_t deep = 200'000;
    const auto parts = many("a.", deep) + "a";
    // Quotes that end early or late hide nothing: four of them end a text of three.
    for (const auto& line : {parts + " = 1", "[" + parts + "]", "[[" + parts + "]]", "x = { " + parts + " = 1 }",
                             many("\"a\" . ", deep) + "'b' = 1", "a = " + many("[", deep), "a = " + many("{a=", deep),
                             "x = { y = '''b'''', " + parts + " = 1 }", "x = { y = \"\", " + parts + " = 1 }"})
        EXPECT_THAT(only_finding("schema = 1\n# a.b.c\n" + line + "\n", 3), HasSubstr("deeper than 32"))
            << line.substr(0, 30);
}

TEST(CatalogueLinter, dots_and_brackets_in_texts_and_comments_are_not_depth) {
    const auto dots = many(".", 100), brackets = many("[", 100);
    const auto point = "  { name = \"x" + dots + brackets + "\\\"\", kind = \"muscle\", at = { nose_wing = 1.0 } }, # ";
    EXPECT_THAT(lint_catalogue(catalogue_with(point + dots + brackets)), IsEmpty());
}

TEST(CatalogueReader, refuses_a_faulty_file_by_name_and_line) {
    try {
        (void)parse_catalogue(catalogue_with(R"(  { name = "x", kind = "bone", at = { nose_wing = 1.0 } },)"),
                              "mine.toml");
        FAIL() << "accepted";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("mine.toml:12: kind 'bone' is none of muscle, carried, wrinkle"));
    }
}

TEST(SplitMagnitude, reads_code_and_magnitude) {
    EXPECT_EQ(split_magnitude("12").text, "12");
    EXPECT_EQ(split_magnitude("12").magnitude, 1.0);
    EXPECT_EQ(split_magnitude("4L:0.3").text, "4L");
    EXPECT_EQ(split_magnitude("4L:0.3").magnitude, 0.3);
    for (const auto* bad : {"12:", "12:half", "12:-1", "12:nan", "12:0.5x", ":1"})
        EXPECT_THROW((void)split_magnitude(bad), InputError) << bad;
}

}  // namespace
}  // namespace mimik::facs
