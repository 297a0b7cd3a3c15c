#include "io/json_values.h"

#include <algorithm>
#include <chrono>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/thrown.h"

namespace mimik::io {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

template <class Read>
std::string refused(const std::string& text, const Read& read) {
    return test::message_of([&] { (void)read_json_document(text, "f.json", "mend it", read); });
}
std::string refused(const std::string& text) {
    return refused(text, [](const json&) { return 0; });
}

TEST(JsonDocument, damage_depth_and_number_of_values_are_refused_with_the_file) {
    EXPECT_EQ(refused(R"({"schema": 1})"), "nothing was thrown");
    EXPECT_EQ(refused(R"({"schema": 1)"), "f.json: byte 13: the JSON is damaged or truncated");
    EXPECT_THAT(refused(R"({"schema": NaN})"), StartsWith("f.json: byte 12: "));
    EXPECT_THAT(refused(R"({"schema": 1e999})"), HasSubstr("f.json: the JSON holds a number too large"));
    EXPECT_THAT(refused(std::string(1'000'000, '[')), HasSubstr("f.json: the JSON nests deeper than 32 levels"));
    std::string many = "[";
    for (int k = 0; k < 1000; ++k) many += "{},";
    EXPECT_EQ(parse_json(many + "0]", "f.json", {.most_values = 1002}).size(), 1001U);
    EXPECT_THAT(test::message_of([&] { (void)parse_json(many + "0]", "f.json", {.most_values = 1000}); }),
                HasSubstr("f.json: the JSON has more than 1000 values"));
}

TEST(JsonDocument, a_long_list_of_objects_takes_no_longer_than_a_list_of_numbers_of_its_length) {
    std::string objects = "[", numbers = "[";
    for (int k = 0; k < 200'000; ++k) {
        objects += "{},";
        numbers += "00,";
    }
    std::replace(numbers.begin(), numbers.end(), '0', '1');
    const auto seconds = [](const std::string& text) {
        const auto start = std::chrono::steady_clock::now();
        EXPECT_EQ(parse_json(text + "0]", "f.json").size(), 200'001U);
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    // Some 5 times on an idle machine; quadratic time would be 1000 times.
    EXPECT_LT(seconds(objects), 100 * seconds(numbers));
}

TEST(JsonDocument, another_schema_and_what_is_no_object_are_refused) {
    EXPECT_EQ(refused("[1]"), "f.json: is a list, not a JSON object");
    EXPECT_THAT(refused("{}"), StartsWith("f.json: schema is 0;"));
    EXPECT_THAT(refused(R"({"schema": 2})"), StartsWith("f.json: schema is 2;"));
    EXPECT_THAT(refused(R"({"schema": 1.5})"), StartsWith("f.json: schema is 1.5;"));
    EXPECT_THAT(refused(R"({"schema": "one"})"), StartsWith("f.json: schema is \"one\";"));
}

TEST(JsonDocument, every_complaint_names_the_way_to_its_field) {
    const auto marks = [](const json& document) { return landmarks_from_json(document, "marks").size(); };
    const auto with = [&](const std::string& list) {
        return refused(R"({"schema": 1, "marks": )" + list + "}", marks);
    };
    EXPECT_EQ(with(R"([{"name": "chin", "position_mm": [1, 2, 3]}])"), "nothing was thrown");
    EXPECT_THAT(refused(R"({"schema": 1})", marks), StartsWith("f.json: marks: key 'marks' not found"));
    EXPECT_EQ(with("7"), "f.json: marks: 7 is no list");
    EXPECT_EQ(with("[null]"), "f.json: marks[0]: null is no object");
    EXPECT_THAT(with(R"([{"name": "chin", "position_mm": [1, null, 3]}])"),
                StartsWith("f.json: marks[0]: position_mm: type must be number, but is null"));
    EXPECT_THAT(with(R"([{"name": "chin", "position_mm": [1, 2, 3, 4]}])"), HasSubstr("position_mm: 4 numbers, not 3"));
    EXPECT_THAT(with(R"([{"name": "chin", "position_mm": [1, 2, 3]}, {"name": 1}])"),
                StartsWith("f.json: marks[1]: name: type must be string, but is number"));
    EXPECT_THAT(with(R"([{"name": "a", "position_mm": [1, 2, 3]}, {"name": "a", "position_mm": [1, 2, 3]}])"),
                StartsWith("f.json: marks: landmark 'a' appears twice"));
    std::string million = "[";
    for (int k = 0; k < 10'001; ++k)
        million += R"({"name": "m)" + std::to_string(k) + R"(", "position_mm": [1, 2, 3]},)";
    million.back() = ']';
    EXPECT_EQ(with(million), "f.json: marks[10000]: more than the 10000 landmarks that are read");
}

TEST(JsonDocument, a_transform_that_cannot_be_undone_is_refused) {
    const auto transform = [](const std::string& rows) {
        return refused(R"({"schema": 1, "pose": )" + rows + "}", [](const json& document) {
            return read_field(document, "pose", transform_from_json).matrix().sum();
        });
    };
    EXPECT_EQ(transform("[[1,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,1]]"), "nothing was thrown");
    for (const char* rows : {"[[1,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,2]]", "[[1,0,0,5],[0,1,0,0],[0,0,0,0],[0,0,0,1]]",
                             "[[1,0,0,5],[0,1,0,0],[0,0,1,0]]", "[[1,0,0],[0,1,0],[0,0,1]]", "7",
                             "[[1e200,0,0,5],[0,1e200,0,0],[0,0,1,0],[0,0,0,1]]"})
        EXPECT_THAT(transform(rows), StartsWith("f.json: pose: not an invertible 4x4 matrix")) << rows;
    EXPECT_THAT(transform("[[1,0,0,null],[0,1,0,0],[0,0,1,0],[0,0,0,1]]"), StartsWith("f.json: pose: type must be"));
}

}  // namespace
}  // namespace mimik::io
