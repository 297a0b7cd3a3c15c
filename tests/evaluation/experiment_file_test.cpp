#include "evaluation/experiment_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "tests/database/temporary_folder.h"

namespace mimik::evaluation {
namespace {

using database::message_of;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string shortest = "schema = 1\nexpressions = [\"12\"]\nmethods = [\"mean\"]\n";

std::string refusal(const std::string& text) {
    return message_of<InputError>([&] { (void)parse_experiment(text, "e.toml"); });
}

TEST(ExperimentFile, that_names_expressions_and_methods_has_the_documented_defaults) {
    const auto file = parse_experiment(shortest, "e.toml");
    EXPECT_THAT(file.expressions, ElementsAre("12"));
    ASSERT_EQ(file.methods.size(), 1U);
    EXPECT_EQ(file.methods[0]->name(), "mean");
    EXPECT_THAT(file.magnitudes, ElementsAre(1.0));
    EXPECT_EQ(file.seed, 1U);
    EXPECT_EQ(file.targets, SubjectChoice());
    EXPECT_EQ(file.zones, ZoneSource::automatic);
    EXPECT_TRUE(file.whole_face);
    EXPECT_TRUE(file.reference);
    EXPECT_EQ(file.resamples, 2000);
    EXPECT_DOUBLE_EQ(file.confidence, 0.95);
}

TEST(ExperimentFile, every_key_is_read) {
    const auto file = parse_experiment(R"(schema = 1
database = "db"
unit = "cm"
expressions = ["12L", "HAPPY"]
methods = ["thesis", "default"]
magnitudes = [0.8, 1]
seed = 7
[subjects]
targets = ["bs000", "bs001"]
sources = { next = 4 }
[evaluation]
zones = "data"
whole_face = false
reference = false
[statistics]
resamples = 500
confidence = 0.9
)",
                                       "e.toml");
    EXPECT_EQ(file.database, "db");
    EXPECT_EQ(file.unit, "cm");
    EXPECT_THAT(file.expressions, ElementsAre("12L", "HAPPY"));
    EXPECT_THAT(file.magnitudes, ElementsAre(0.8, 1.0));
    EXPECT_EQ(file.seed, 7U);
    EXPECT_THAT(file.targets.names, ElementsAre("bs000", "bs001"));
    EXPECT_EQ(file.sources.next, 4);
    EXPECT_EQ(file.zones, ZoneSource::data);
    EXPECT_FALSE(file.whole_face);
    EXPECT_FALSE(file.reference);
    EXPECT_EQ(file.resamples, 500);
    EXPECT_DOUBLE_EQ(file.confidence, 0.9);
    EXPECT_EQ(file.place("subjects.targets"), "e.toml:9: subjects.targets");
    EXPECT_EQ(file.place("workspace"), "e.toml");
}

TEST(ExperimentFile, subjects_can_be_all_or_of_one_sex) {
    EXPECT_EQ(parse_experiment(shortest + "[subjects]\ntargets = \"all\"\n", "e.toml").targets, SubjectChoice());
    EXPECT_EQ(parse_experiment(shortest + "[subjects]\ntargets = { sex = \"f\" }\n", "e.toml").targets.sex, "f");
}

TEST(ExperimentFile, a_fault_is_told_with_its_line_its_key_and_the_mend) {
    EXPECT_EQ(refusal(""), "e.toml:1: 'schema' is missing; write schema = 1");
    EXPECT_EQ(refusal("schema = 2\n"), "e.toml:1: 'schema' is not 1, the one that this mimik knows");
    EXPECT_EQ(refusal("schema = 1\nmethods = [\"mean\"]\n"), "e.toml:1: 'expressions' is missing");
    EXPECT_THAT(refusal(shortest + "method = 3\n"), HasSubstr("e.toml:4: unknown key 'method'; known here: schema, "));
    EXPECT_THAT(refusal(shortest + "[subjects]\nwho = 3\n"),
                HasSubstr("e.toml:5: unknown key 'subjects.who'; known in [subjects]: targets, sources"));
    EXPECT_THAT(refusal("schema = 1\nexpressions = [\"12\"]\nmethods = [\"maen\"]\n"), HasSubstr("e.toml:3: "));
    EXPECT_THAT(refusal("schema = 1\nexpressions = [\"12\"]\nmethods = [\"mean\", \"mean\"]\n"),
                HasSubstr("method 'mean' is asked for twice"));
    EXPECT_THAT(refusal("schema = 1\nexpressions = [12]\nmethods = [\"mean\"]\n"),
                HasSubstr("e.toml:2: 'expressions' has an element that is not a text in quotes"));
    EXPECT_THAT(refusal("schema = 1\nexpressions = [\"12\", \"12\"]\nmethods = [\"mean\"]\n"),
                HasSubstr("'expressions' has '12' twice"));
    EXPECT_THAT(refusal(shortest + "magnitudes = [0]\n"), HasSubstr("give numbers above 0"));
    EXPECT_THAT(refusal(shortest + "magnitudes = [nan]\n"), HasSubstr("'magnitudes' is not a number"));
    EXPECT_THAT(refusal(shortest + "seed = -1\n"), HasSubstr("e.toml:4: 'seed' is not a whole number from 0"));
    EXPECT_THAT(refusal(shortest + "database = \"a\"\nworkspace = \"b\"\n"), HasSubstr("stands beside 'database'"));
    EXPECT_THAT(refusal(shortest + "[evaluation]\nzones = \"everywhere\"\n"),
                HasSubstr("e.toml:5: 'evaluation.zones' is none of automatic, truth, data, catalogue"));
    EXPECT_THAT(refusal(shortest + "[statistics]\nconfidence = 1\n"), HasSubstr("0.95 is usual"));
    EXPECT_THAT(refusal(shortest + "[subjects]\ntargets = { next = 3 }\n"), HasSubstr("unknown key"));
    EXPECT_THAT(refusal(shortest + "[subjects]\nsources = { next = 0 }\n"), HasSubstr("from 1 to"));
    EXPECT_THAT(refusal(shortest + "[subjects]\nsources = {}\n"), HasSubstr("says nothing"));
    EXPECT_THAT(refusal("schema = 1\nexpressions = [\n"), HasSubstr("e.toml:"));
}

TEST(ExperimentFile, folders_start_at_the_files_own) {
    const database::TemporaryFolder folder;
    const auto path = folder.path() / "sub" / "e.toml";
    base::write_atomically(path, shortest + "workspace = \"../work\"\n");
    EXPECT_EQ(read_experiment_file(path).workspace, folder.path() / "work");
    base::write_atomically(path, shortest + "workspace = \"/elsewhere\"\n");
    EXPECT_EQ(read_experiment_file(path).workspace, "/elsewhere");
}

}  // namespace
}  // namespace mimik::evaluation
