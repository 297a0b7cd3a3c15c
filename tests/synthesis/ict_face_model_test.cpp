#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "geometry/landmarks.h"
#include "synthesis/face_model.h"
#include "synthesis/ict_obj.h"
#include "synthesis/posed_expression.h"
#include "synthesis/subject.h"
#include "tests/database/temporary_folder.h"

namespace mimik::synthesis {
namespace {

namespace fs = std::filesystem;

fs::path ict_folder() {
    const char* shared = std::getenv("MIMIK_SHARED_DATA");
    return (shared ? fs::path(shared) : fs::path(MIMIK_SOURCE_DIR) / ".." / "shared" / "data") / "ict-facekit";
}

TEST(IctFaceModel, mean_face_has_adult_measures_and_all_landmarks_on_their_side) {
    if (!fs::exists(ict_folder())) GTEST_SKIP() << "no ICT-FaceKit in " << ict_folder();
    const auto model = load_ict_face_model(ict_folder().string());
    EXPECT_EQ(model->vertex_regions().size(), 11248U);
    EXPECT_EQ(model->landmark_vertices().size(), geometry::standard_landmark_names().size());
    const auto mean = model->draw_identity(0, Sex::female, 0.0);
    EXPECT_NEAR(mean.measurements_mm.at("outer_eye_distance"), 89.2, 0.1);  // published mean face: 8.92 cm
    EXPECT_NEAR(mean.measurements_mm.at("mouth_width"), 50.7, 0.1);         // 5.07 cm
    const auto face = model->neutral_mm(mean);
    for (const auto& [name, vertex] : model->landmark_vertices())
        if (name.ends_with("_left")) {
            EXPECT_GT(face[vertex].x(), 0.0) << name;
        }
    for (const auto& region : {"lip", "brow", "lid", "nostril"})
        EXPECT_THAT(model->vertex_regions(), testing::Contains(region));
}

TEST(IctFaceModel, smile_moves_its_own_side_and_every_expression_can_be_made) {
    if (!fs::exists(ict_folder())) GTEST_SKIP() << "no ICT-FaceKit in " << ict_folder();
    const auto model = load_ict_face_model((ict_folder() / "FaceXModel").string());
    const auto identity = model->draw_identity(0, Sex::female, 0.0);
    const auto smile = model->shape_displacement_mm(identity, "mouthSmile_L");
    EXPECT_GT(smile[model->landmark_vertices().at("mouth_corner_left")].norm(), 12.0);  // 15.6 mm as published
    EXPECT_LT(smile[model->landmark_vertices().at("mouth_corner_right")].norm(), 0.5);
    for (const auto& expression : make_expressions("all")) EXPECT_TRUE(missing_shapes(expression, *model).empty());
    EXPECT_THROW((void)model->shape_displacement_mm(identity, "noSuchShape"), InputError);
}

TEST(IctFaceModel, a_wrong_folder_and_a_cut_file_are_named) {
    const auto folder = fs::temp_directory_path() / "mimik_ict_cut";
    fs::create_directories(folder);
    try {
        (void)load_ict_face_model(folder.string());
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::HasSubstr("generic_neutral_mesh.obj"));
    }
    EXPECT_THAT(database::message_of<InputError>([] { (void)load_ict_face_model(std::string(5000, 'x')); }),
                testing::HasSubstr("no generic_neutral_mesh.obj"));
    std::ofstream(folder / "generic_neutral_mesh.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    try {
        (void)load_ict_face_model(folder.string());
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::HasSubstr("3 vertices, the face model needs 11248"));
    }
    fs::remove_all(folder);
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

TEST(IctObj, the_skin_is_what_comes_first_in_millimetres) {
    const std::string text =
        "v 0 0 1\nv 1 0 1\nv 0 1 1\nv 9 9 9\nvt 0.25 1.5\nvt -0.25 0\nf 1/1 2/2 3/1\nf 2/1 3/1 4/1\n";
    const auto skin = decode_ict_skin(bytes_of(text), "m.obj", 3);
    EXPECT_EQ(skin.vertices_mm, (std::vector<geometry::Point>{{0, 0, 10}, {10, 0, 10}, {0, 10, 10}}));
    EXPECT_EQ(skin.faces.corners, (std::vector<std::uint32_t>{0, 1, 2}));  // the other one is behind the skin
    EXPECT_EQ(decode_ict_vertices(text.substr(0, 26), "m.obj", 3), skin.vertices_mm);  // "v 9 9" is half a line
}

TEST(IctObj, hostile_files_are_refused_with_file_line_and_value) {
    const auto error = [](const std::string& text) {
        return database::message_of<InputError>([&] { (void)decode_ict_vertices(text, "s.obj", 2); });
    };
    EXPECT_THAT(error("v 0 0 0\nv 0 nan 0\n"), testing::HasSubstr("s.obj: line 2: coordinate 2 is 'nan'"));
    EXPECT_THAT(error("v 0 0 0\nv 0 0\n"), testing::HasSubstr("s.obj: line 2: coordinate 3 is ''"));
    EXPECT_THAT(error("v 0 0 0\nv 0 0 1e999\n"), testing::HasSubstr("s.obj: line 2: coordinate 3 is '1e999'"));
    EXPECT_THAT(error("v 0 0 0\nv 0 0 0"), testing::HasSubstr("s.obj: 1 vertex, the face model needs 2"));
    EXPECT_THAT(database::message_of<InputError>(
                    [&] { (void)decode_ict_skin(bytes_of("v 0 0 0\nv 1 0 0\nf 1 2 9999999\n"), "m.obj", 2); }),
                testing::HasSubstr("m.obj: line 3: vertex index is 9999999, but the file has 2"));
}

TEST(IctFaceModel, a_shape_without_line_ends_is_refused_by_its_head) {
    if (!fs::exists(ict_folder())) GTEST_SKIP() << "no ICT-FaceKit in " << ict_folder();
    const database::TemporaryFolder folder;
    fs::copy_file(ict_folder() / "FaceXModel/generic_neutral_mesh.obj", folder.path() / "generic_neutral_mesh.obj");
    const auto file = folder.path() / "identity000.obj";
    std::ofstream(file) << "v 0 0 0";
    fs::resize_file(file, std::uintmax_t{1} << 40);  // sparse: nobody could hold it
    EXPECT_THAT(database::message_of<InputError>([&] { (void)load_ict_face_model(folder.path().string()); }),
                testing::HasSubstr("identity000.obj: 0 vertices, the face model needs 11248"));
}

}  // namespace
}  // namespace mimik::synthesis
