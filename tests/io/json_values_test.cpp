#include "io/json_values.h"

#include <optional>
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

enum class Colour { red, green };
constexpr const char* to_string(Colour colour) { return colour == Colour::red ? "red" : "green"; }

struct Inner {
    double width_mm = 0.5;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("width_mm", self.width_mm);
    }
};
struct Outer {
    int count = 3;
    bool on = false;
    Colour colour = Colour::red;
    std::optional<double> limit_mm;
    Inner inner;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("count", self.count);
        visit("on", self.on);
        visit("colour", self.colour);
        visit("limit_mm", self.limit_mm);
        visit("inner", self.inner);
    }
};
static_assert(base::lists_every_field<Outer>());

TEST(Fields, stand_in_json_by_name_and_read_back) {
    EXPECT_EQ(fields_to_json(Outer{}).dump(),
              R"({"colour":"red","count":3,"inner":{"width_mm":0.5},"limit_mm":null,"on":false})");
    const Outer other{.count = 7, .on = true, .colour = Colour::green, .limit_mm = 2.5, .inner = {.width_mm = 9}};
    Outer read;
    read_fields(fields_to_json(other), read);
    EXPECT_EQ(base::field_text(read), base::field_text(other));
    read_fields(fields_to_json(Outer{}), read);
    EXPECT_EQ(base::field_text(read), base::field_text(Outer{}));
}

TEST(Fields, a_missing_field_and_one_of_another_kind_are_refused_by_the_way_to_it) {
    const auto error = [](const char* field, const json& value) {
        auto document = fields_to_json(Outer{});
        if (value.is_discarded())
            document.erase(field);
        else
            document[field] = value;
        return test::message_of([&] {
            Outer read;
            read_fields(document, read);
        });
    };
    EXPECT_THAT(error("count", json(json::value_t::discarded)), StartsWith("count: key 'count' not found"));
    EXPECT_THAT(error("on", 1), StartsWith("on: type must be boolean"));
    EXPECT_THAT(error("limit_mm", "wide"), StartsWith("limit_mm: type must be number"));
    EXPECT_THAT(error("inner", {{"width", 1}}), StartsWith("inner: width_mm: key 'width_mm' not found"));
    EXPECT_EQ(error("colour", "blue"), "colour: \"blue\" is none of red, green");
    EXPECT_THAT(error("colour", 0), StartsWith("colour: type must be string"));
}

TEST(Fields, an_enum_is_read_by_its_word) { EXPECT_EQ(enum_from_json<Colour>(json("green")), Colour::green); }

}  // namespace
}  // namespace mimik::io
