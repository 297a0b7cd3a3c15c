#include <gtest/gtest.h>

// [sample]
#include "synthesis/face_model.h"

using namespace mimik;

/// The face of a woman, and the same with one corner of the mouth pulled up.
std::pair<geometry::Mesh, geometry::Mesh> half_a_smile(const synthesis::FaceModel& model, std::uint64_t seed) {
    const auto person = model.draw_identity(seed, synthesis::Sex::female, 1.0);
    geometry::Mesh neutral;
    neutral.vertices_mm = model.neutral_mm(person);
    neutral.faces = model.faces();
    auto smiling = neutral;
    const auto pull_mm = model.shape_displacement_mm(person, "mouthSmile_L");
    for (std::size_t v = 0; v < pull_mm.size(); ++v) smiling.vertices_mm[v] += 0.7 * pull_mm[v];
    return {neutral, smiling};
}
// [end]

TEST(Samples, a_smile_lifts_the_left_corner_of_the_mouth_alone) {
    const auto model = synthesis::make_builtin_face_model();
    const auto faces = half_a_smile(*model, 1);
    const auto moved_mm = [&](const char* landmark) {
        const auto v = model->landmark_vertices().at(landmark);
        return geometry::Vector(faces.second.vertices_mm[v] - faces.first.vertices_mm[v]);
    };
    EXPECT_GT(moved_mm("mouth_corner_left").y(), 4);
    EXPECT_GT(moved_mm("mouth_corner_left").x(), 2);  // to the subject's left
    EXPECT_LT(moved_mm("mouth_corner_right").norm(), 1);
    EXPECT_LT(moved_mm("nose_tip").norm(), 1);
}
