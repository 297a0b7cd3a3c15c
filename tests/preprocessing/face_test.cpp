#include "preprocessing/face.h"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "preprocessing/workspace.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/thrown.h"

namespace mimik::preprocessing {
namespace {

using test::message_of;
using testing::HasSubstr;
using testing::StartsWith;

Face small_face() {
    Face face;
    face.id = {"bs000", "N", "N", 0};
    face.grid.rows = 2;
    face.grid.cols = 2;
    face.grid.vertices_mm = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
    face.grid.origin.assign(4, geometry::VertexOrigin::measured);
    face.landmarks = face.snapped_landmarks = geometry::Landmarks({{"nose_tip", {0, 0, 1}, ""}});
    return face;
}

/// The .json of a small face with one place changed.
std::string changed(const std::string& from, const std::string& to) {
    const test::TemporaryFolder folder;
    write_face(folder.path() / "face", small_face());
    auto text = base::read_text(folder.path() / "face.json");
    const auto place = text.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    return text.replace(place, from.size(), to);
}

TEST(FaceFile, hostile_values_are_refused_with_file_and_field) {
    EXPECT_EQ(decode_face(changed("bs000", "bs001"), "f.json").id.subject, "bs001");
    const auto error = [](const std::string& from, const std::string& to) {
        return message_of<InputError>([&] { (void)decode_face(changed(from, to), "f.json"); });
    };
    for (const char* rows : {"-2", "4294967298", "2.5", "1e300", "null", "\"2\""})
        EXPECT_THAT(error("\"rows\": 2", std::string("\"rows\": ") + rows), StartsWith("f.json: rows is "));
    EXPECT_THAT(error("bs000_N_N_0", "../../x_N_N_0"), StartsWith("f.json: scan: '../../x_N_N_0' is no scan name"));
    EXPECT_THAT(error("bs000_N_N_0", ".._N_N_0"), StartsWith("f.json: scan: "));
    EXPECT_THAT(error("\"remarks\": []", "\"remarks\": [7]"), StartsWith("f.json: remarks: type must be string"));
    EXPECT_THAT(error("\"alignment_rms_mm\": 0.0", "\"alignment_rms_mm\": null"),
                StartsWith("f.json: alignment_rms_mm: type must be number"));
    EXPECT_THAT(error("\"average_from_scan\": [", "\"average_from_scan\": [7, "),
                StartsWith("f.json: average_from_scan: not an invertible 4x4 matrix"));
    EXPECT_THAT(error("}", ""), StartsWith("f.json: byte "));
}

TEST(FaceFile, a_grid_must_have_as_many_of_everything_as_its_json_says) {
    const auto grid = small_face().grid;
    geometry::Mesh mesh;
    mesh.vertices_mm = grid.vertices_mm;
    mesh.attributes.push_back({"origin", 1, {1, 1, 1, 0}});
    EXPECT_EQ(to_grid(mesh, 2, 2, "g.ply").origin.back(), geometry::VertexOrigin::outside);
    const auto error = [](const geometry::Mesh& with, int rows, int cols) {
        return message_of<InputError>([&] { (void)to_grid(with, rows, cols, "g.ply"); });
    };
    EXPECT_THAT(error(mesh, 20000, 20000), StartsWith("g.ply: 4 vertices where its .json says 20000 x 20000"));
    EXPECT_THAT(error(mesh, 1, 4), StartsWith("g.ply: 4 vertices"));
    auto textured = mesh;
    textured.texture_coordinates = {{0.5, 0.5}};  // with texture corners a mesh may have fewer than vertices
    EXPECT_THAT(error(textured, 2, 2), StartsWith("g.ply: 1 texture coordinates for 4 vertices"));
    mesh.attributes[0].values[2] = 1.5;
    EXPECT_THAT(error(mesh, 2, 2), StartsWith("g.ply: origin 1.5 is none of 0, 1, 2"));
    mesh.attributes.clear();
    EXPECT_THAT(error(mesh, 2, 2), StartsWith("g.ply: property 'origin' is missing"));
}

TEST(FaceFile, a_vertex_without_a_place_in_the_image_is_written_and_read_back) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const test::TemporaryFolder folder;
    geometry::QuadGrid grid;
    grid.rows = grid.cols = 2;
    grid.vertices_mm = {{0, 0, 1}, {1, 0, 2}, {0, 1, 3}, {1, 1, 4}};
    grid.origin.assign(4, geometry::VertexOrigin::measured);
    grid.texture_coordinates = {{0.1, 0.2}, {nan, nan}, {0.3, 0.4}, {0.5, 0.6}};
    write_grid(folder.path() / "grid.ply", grid);
    const auto read = read_grid(folder.path() / "grid.ply", 2, 2);
    EXPECT_EQ(read.vertices_mm[1], grid.vertices_mm[1]);
    EXPECT_EQ(read.texture_coordinates[3], grid.texture_coordinates[3]);
}

TEST(WorkspaceFile, hostile_values_are_refused_with_file_and_field) {
    const std::string sound =
        R"({"schema": 1, "database": "/db", "truth": false, "scans": ["bs000_N_N_0"], "hidden_subjects": ["bs009"]})";
    EXPECT_EQ(decode_workspace(sound, "w.json").hidden_subjects.front(), "bs009");
    const auto error = [&](const std::string& from, const std::string& to) {
        auto text = sound;
        text.replace(text.find(from), from.size(), to);
        return message_of<InputError>([&] { (void)decode_workspace(text, "w.json"); });
    };
    EXPECT_THAT(error("bs000_N_N_0", "../bs000_N_N_0"), StartsWith("w.json: scans[0]: '../bs000_N_N_0' is no scan"));
    EXPECT_THAT(error("\"bs000_N_N_0\"", "null"), StartsWith("w.json: scans[0]: type must be string, but is null"));
    EXPECT_THAT(error("false", "1"), StartsWith("w.json: truth: type must be boolean"));
    EXPECT_THAT(error("[\"bs009\"]", "7"), StartsWith("w.json: hidden_subjects: "));
    EXPECT_THAT(error("\"database\"", "\"data\""), StartsWith("w.json: database: key 'database' not found"));
}

}  // namespace
}  // namespace mimik::preprocessing
