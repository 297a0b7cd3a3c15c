#include "database/truth.h"

#include <cstdint>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/thrown.h"

namespace mimik::database {
namespace {

using test::message_of;
using testing::HasSubstr;

/// A truth.json whose face model has 4 vertices and one triangle, with one place changed.
std::string small_truth(const std::string& from = "", const std::string& to = "") {
    std::string text = R"({"schema": 1, "seed": 1, "face_model": {"name": "m", "vertices": 4, "faces": [[0, 1, 2]],)"
                       R"( "regions": {"lip": [3]}, "landmark_vertices": {"nose_tip": 2}}, "subjects": [],)"
                       R"( "scans": ["bs000_N_N_0"]})";
    if (!from.empty()) text.replace(text.find(from), from.size(), to);
    return text;
}

TEST(Truth, numbers_that_do_not_fit_the_faces_are_refused_with_file_field_and_value) {
    EXPECT_EQ(decode_truth(small_truth(), "t.json").vertex_regions.at(3), "lip");
    const auto error = [](const std::string& from, const std::string& to) {
        return message_of<InputError>([&] { (void)decode_truth(small_truth(from, to), "t.json"); });
    };
    for (const char* vertices : {"100000000000", "-1", "1e11", "2.5", "null"})
        EXPECT_THAT(error("\"vertices\": 4", std::string("\"vertices\": ") + vertices),
                    HasSubstr("t.json: face_model.vertices is "));
    EXPECT_THAT(error("[0, 1, 2]", "[0, 1, 4]"), HasSubstr("t.json: a corner in face_model.faces is 4"));
    EXPECT_THAT(error("[0, 1, 2]", "[0, 1]"), HasSubstr("t.json: a face of face_model.faces has 2 corners"));
    EXPECT_THAT(error("[3]", "[100]"), HasSubstr("t.json: a vertex in face_model.regions is 100"));
    EXPECT_THAT(error("\"nose_tip\": 2", "\"nose_tip\": -2"),
                HasSubstr("t.json: a vertex in face_model.landmark_vertices is -2"));
    EXPECT_THAT(error("\"seed\": 1,", "\"seed\": 1, \"variances\": {\"identity\": \"x\"},"),
                HasSubstr("t.json: variances: "));
    EXPECT_THAT(error("bs000_N_N_0", "bs000"), HasSubstr("t.json: scans[0]: 'bs000' is no scan name"));
    EXPECT_THAT(message_of<InputError>([] { (void)decode_truth("[1]", "t.json"); }), HasSubstr("t.json: "));
}

TEST(Truth, a_name_given_to_many_vertices_stays_short_and_no_scan_lies_elsewhere) {
    const auto error = [](const std::string& from, const std::string& to) {
        return message_of<InputError>([&] { (void)decode_truth(small_truth(from, to), "t.json"); });
    };
    EXPECT_THAT(error("\"lip\"", '"' + std::string(1'000'000, 'x') + '"'),
                HasSubstr("in face_model.regions has 1000000 letters, more than 64"));
    EXPECT_THAT(error("bs000_N_N_0", "../bs000_N_N_0"),
                HasSubstr("t.json: scans[0]: '../bs000_N_N_0' is no scan name"));
    EXPECT_THAT(error("\"seed\": 1", "\"seed\": -1"), HasSubstr("t.json: seed: -1 is no whole number"));
    const std::string largest = "18446744073709551615";
    EXPECT_EQ(decode_truth(small_truth("\"seed\": 1", "\"seed\": " + largest), "t.json").seed,
              std::numeric_limits<std::uint64_t>::max());
    EXPECT_THAT(error("\"subjects\": []", "\"subjects\": [{\"name\": \"bs000\", \"sex\": null}]"),
                HasSubstr("t.json: subjects[0]: sex: type must be string, but is null"));
}

TEST(Truth, of_one_scan_hostile_values_are_refused_with_file_and_field) {
    const std::string sound =
        R"({"schema": 1, "scan": "bs000_N_N_0", "scanner_from_head": [[1,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,1]],)"
        R"( "landmarks": {"chin": [0, -60, 0.5]}, "shape_weights": {"smile": 0.7}, "amplitude": 1, "asymmetry": 0})";
    EXPECT_EQ(decode_true_scan(sound, "s.json").landmarks.position_mm("chin").y(), -60);
    const auto error = [&](const std::string& from, const std::string& to) {
        auto text = sound;
        text.replace(text.find(from), from.size(), to);
        return message_of<InputError>([&] { (void)decode_true_scan(text, "s.json"); });
    };
    EXPECT_THAT(error("[0,0,1,0]", "[0,0,0,0]"), HasSubstr("s.json: scanner_from_head: not an invertible 4x4 matrix"));
    EXPECT_THAT(error("[0, -60, 0.5]", "[0, -60]"), HasSubstr("s.json: landmarks: chin: "));
    EXPECT_THAT(error("0.7", "NaN"), HasSubstr("s.json: byte "));
    EXPECT_THAT(error("0.7", "\"much\""), HasSubstr("s.json: shape_weights: type must be number"));
    EXPECT_THAT(error("bs000", ".."), HasSubstr("s.json: scan: '.._N_N_0' is no scan name"));
}

}  // namespace
}  // namespace mimik::database
