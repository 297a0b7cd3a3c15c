#include "animation/torn_faces.h"

#include <array>

#include <gtest/gtest.h>

namespace mimik::animation {
namespace {

using geometry::Vector;
using preprocessing::LipSide;

/// Two rows of vertices, the lower lip and the upper, and the quads between them.
struct Mouth {
    AnimatedFace face;
    geometry::Faces quads;

    explicit Mouth(const std::vector<double>& parting_mm) {
        const auto cols = static_cast<std::uint32_t>(parting_mm.size());
        face.field = geometry::DisplacementField::still(2 * cols);
        for (std::uint32_t col = 0; col < cols; ++col) {
            face.field.mm[cols + col] = Vector(0, parting_mm[col], 0);
            face.lip_sides.push_back(LipSide::lower);
        }
        face.lip_sides.insert(face.lip_sides.end(), cols, LipSide::upper);
        for (std::uint32_t col = 0; col + 1 < cols; ++col)
            quads.add(std::array{col, col + 1, cols + col + 1, cols + col});
    }
    [[nodiscard]] std::vector<std::uint8_t> torn() const { return torn_faces(face, face.field.mm, quads); }
};

TEST(TornFaces, a_mouth_that_opens_is_one_opening_up_to_where_the_lips_meet) {
    // In the middle the motion falls below 1.5 mm: no skin stays there.
    const Mouth mouth({0, 0.2, 0.7, 1.7, 1.2, 1.3, 1.9, 0.8, 0.3, 0});
    EXPECT_EQ(mouth.torn(), (std::vector<std::uint8_t>{0, 1, 1, 1, 1, 1, 1, 1, 0}));
}

TEST(TornFaces, lips_that_hardly_part_anywhere_stay_closed) {
    const Mouth mouth({0, 0.7, 1.2, 1.4, 1.2, 0.7, 0});
    EXPECT_EQ(mouth.torn(), std::vector<std::uint8_t>(6, 0));
}

TEST(TornFaces, what_parts_a_little_elsewhere_is_not_torn_by_an_opening) {
    const Mouth mouth({0, 2, 0, 0, 0.9, 0.9, 0});
    EXPECT_EQ(mouth.torn(), (std::vector<std::uint8_t>{1, 1, 0, 0, 0, 0}));
}

TEST(TornFaces, within_one_lip_and_without_lips_nothing_is_torn) {
    Mouth mouth({2, 2, 2});
    mouth.face.lip_sides.assign(6, LipSide::upper);
    EXPECT_EQ(mouth.torn(), std::vector<std::uint8_t>(2, 0));
    mouth.face.lip_sides.clear();
    EXPECT_EQ(mouth.torn(), std::vector<std::uint8_t>(2, 0));
}

TEST(TornFaces, for_morph_targets_what_any_shape_tears_is_torn) {
    Mouth mouth({2, 2, 2});
    mouth.face.shapes = {mouth.face.field};
    mouth.face.field = geometry::DisplacementField::still(6);
    EXPECT_EQ(mouth.torn(), std::vector<std::uint8_t>(2, 0));
    EXPECT_EQ(torn_faces_of_any_shape(mouth.face, mouth.quads), std::vector<std::uint8_t>(2, 1));
}

}  // namespace
}  // namespace mimik::animation
