#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/landmarks.h"
#include "synthesis/expression.h"
#include "synthesis/face_model.h"
#include "synthesis/subject.h"

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
    std::ofstream(folder / "generic_neutral_mesh.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    try {
        (void)load_ict_face_model(folder.string());
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::HasSubstr("3 vertices, the face model needs 11248"));
    }
    fs::remove_all(folder);
}

}  // namespace
}  // namespace mimik::synthesis
