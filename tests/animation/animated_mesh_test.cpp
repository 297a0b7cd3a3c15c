#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "animation/face_export.h"
#include "base/file.h"
#include "base/temporary.h"

namespace mimik::animation {
namespace {

using geometry::Vector;
using testing::ElementsAre;
using testing::HasSubstr;

/// Two triangles of four vertices whose texture is cut between them: two vertices have two positions in the picture.
geometry::Mesh two_charts() {
    geometry::Mesh mesh;
    mesh.vertices_mm = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
    mesh.faces.add(std::vector<std::uint32_t>{0, 1, 2});
    mesh.faces.add(std::vector<std::uint32_t>{0, 2, 3});
    mesh.texture_coordinates = {{0, 0}, {0.4, 0}, {0.4, 0.4}, {0.6, 0.6}, {1, 1}, {0.6, 1}};
    mesh.faces.texture_corners = {0, 1, 2, 3, 4, 5};
    return mesh;
}

/// Each vertex moved its own way by two expressions, one of them at rest.
AnimatedFace two_expressions(std::size_t vertices) {
    AnimatedFace animated;
    for (const double sign : {1.0, -1.0}) {
        auto& shape = animated.shapes.emplace_back(geometry::DisplacementField::still(vertices));
        for (std::size_t v = 0; v < vertices; ++v) shape.mm[v] = sign * Vector(1.0 + static_cast<double>(v), 2, 3);
    }
    animated.field = animated.shapes.front();
    return animated;
}

struct ReadGlb {
    nlohmann::json document;
    std::string binary;

    explicit ReadGlb(const std::filesystem::path& file) {
        const auto bytes = base::read_text(file);
        std::uint32_t length = 0;
        std::memcpy(&length, bytes.data() + 12, 4);
        document = nlohmann::json::parse(bytes.substr(20, length));
        binary = bytes.substr(20 + length + 8);
    }
    /// Metres, as written.
    [[nodiscard]] std::vector<Vector> vectors(const nlohmann::json& number) const {
        const auto& accessor = document.at("accessors").at(number.get<std::size_t>());
        const auto& view = document.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
        const auto begin = view.value("byteOffset", std::size_t{0}) + accessor.value("byteOffset", std::size_t{0});
        std::vector<Vector> all;
        for (std::size_t k = 0; k < accessor.at("count").get<std::size_t>(); ++k) {
            float xyz[3];
            std::memcpy(xyz, binary.data() + begin + 12 * k, 12);
            all.emplace_back(xyz[0], xyz[1], xyz[2]);
        }
        return all;
    }
};

TEST(AnimatedMesh, a_glb_has_every_vertex_where_it_was_and_moves_it_as_each_expression_does) {
    const base::TemporaryFolder folder(std::filesystem::temp_directory_path());
    const auto mesh = two_charts();
    const auto animated = two_expressions(mesh.vertices_mm.size());
    const NamedMagnitude names[] = {{"AU12", 1.0, {}}, {"AU43_L", 0.0, "eyeBlinkLeft"}};
    const auto file = folder.path() / "head.glb";
    EXPECT_TRUE(write_animated_mesh(file, animated, mesh, names, {}, {{"made_by", "a test"}}).empty());

    const ReadGlb read(file);
    const auto& made = read.document.at("meshes").at(0);
    const auto& primitive = made.at("primitives").at(0);
    EXPECT_EQ(made.at("extras").at("targetNames"), nlohmann::json({"AU12", "AU43_L"}));
    EXPECT_EQ(made.at("weights"), nlohmann::json({1.0, 0.0}));
    EXPECT_EQ(read.document.at("asset").at("extras").at("made_by"), "a test");
    const auto positions = read.vectors(primitive.at("attributes").at("POSITION"));
    ASSERT_EQ(positions.size(), 6U);  // two of the four are split
    for (std::size_t t = 0; t < 2; ++t) {
        const auto moved = read.vectors(primitive.at("targets").at(t).at("POSITION"));
        ASSERT_EQ(moved.size(), positions.size());
        for (std::size_t k = 0; k < positions.size(); ++k) {
            // By where it is, the vertex of the mesh that this one came from.
            std::size_t v = 0;
            while ((1e-3 * mesh.vertices_mm[v] - positions[k]).norm() > 1e-6) ASSERT_LT(++v, mesh.vertices_mm.size());
            EXPECT_LT((moved[k] - 1e-3 * animated.shapes[t].mm[v]).norm(), 1e-6) << t << ' ' << k;
        }
    }
}

TEST(AnimatedMesh, what_a_glb_cannot_hold_is_left_out_with_a_word) {
    const base::TemporaryFolder folder(std::filesystem::temp_directory_path());
    auto mesh = two_charts();
    mesh.attributes.push_back({"gap_mm", 1, {0, 1, std::nan(""), 3}});
    mesh.attributes.push_back({"depth_mm", 1, {0, 1, 2, 3}});
    const auto animated = two_expressions(mesh.vertices_mm.size());
    const NamedMagnitude names[] = {{"a", 1.0, {}}, {"b", 1.0, {}}};
    const auto file = folder.path() / "head.glb";
    EXPECT_THAT(write_animated_mesh(file, animated, mesh, names, {}), ElementsAre(HasSubstr("'gap_mm' is left out")));
    const ReadGlb read(file);
    const auto& attributes = read.document.at("meshes").at(0).at("primitives").at(0).at("attributes");
    EXPECT_TRUE(attributes.contains("_DEPTH_MM"));
    EXPECT_FALSE(attributes.contains("_GAP_MM"));
}

}  // namespace
}  // namespace mimik::animation
