#include "evaluation/per_vertex.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/database/temporary_folder.h"
#include "tests/support/flat_face.h"

namespace mimik::evaluation {
namespace {

using database::message_of;
using geometry::Vector;
using test::FlatFace;

TEST(CaseChoice, is_read_as_it_is_written_and_fits_its_own_cases_alone) {
    const auto any = parse_case_choice("bs000:12L:default@0.8");
    EXPECT_EQ(any.text(), "bs000:12L:default@0.8");
    CaseKey key{"bs001", "bs000", "12L", "default", 0.8};
    EXPECT_TRUE(any.fits(key));
    EXPECT_TRUE(parse_case_choice("bs000:12L:default@0.8:bs001").fits(key));
    EXPECT_FALSE(parse_case_choice("bs000:12L:default@0.8:bs002").fits(key));
    key.magnitude = 1;
    EXPECT_FALSE(any.fits(key));
    EXPECT_EQ(file_stem(key), "bs000_12L_default_bs001");
    key.source = "a/b c";
    const auto replaced = file_stem(key);
    EXPECT_THAT(replaced, testing::MatchesRegex("bs000_12L_default_a-b-c-[0-9a-f]+"));
    key.source = "a-b c";
    EXPECT_NE(file_stem(key), replaced);
    key.source = "a-b-c";
    EXPECT_EQ(file_stem(key), "bs000_12L_default_a-b-c");
    for (const auto* bad : {"", "bs000", "bs000:12", "bs000::mean", "bs000:12:mean:", "a:b:c:d:e"})
        EXPECT_THAT(message_of<InputError>([&] { (void)parse_case_choice(bad); }),
                    testing::HasSubstr("TARGET:EXPRESSION:METHOD"))
            << bad;
}

TEST(VertexErrors, are_the_distances_whose_mean_is_the_score_and_unknown_where_none_is_scored) {
    const auto neutral = geometry::face_surface(FlatFace::grid(), FlatFace::landmarks());
    const auto target = FlatFace::target(neutral, FlatFace::grid());
    // Before the flat scan by 2 mm on one side and 1 mm behind it on the other; one vertex has no answer.
    auto field = FlatFace::field([](double x, double) { return Vector(0, 0, x > 0 ? 2 : -1); });
    const auto silent = target.vertices[5];
    field.answered[silent] = 0;
    const JudgedFace face{target, neutral, field};
    const auto error_mm = vertex_errors_mm(face);
    ASSERT_EQ(error_mm.size(), neutral.size());
    double sum_mm = 0;
    for (const auto v : target.vertices) {
        EXPECT_NEAR(error_mm[v], v == silent ? 0 : neutral.vertices_mm[v].x() > 0 ? 2 : 1, 1e-12);  // rounding
        sum_mm += error_mm[v];
    }
    EXPECT_EQ(sum_mm / static_cast<double>(target.vertices.size()), *distances_to_real_scan(face).face_mm);
    for (std::uint32_t v = 0; v < neutral.size(); ++v)
        EXPECT_EQ(std::isnan(error_mm[v]),
                  std::find(target.vertices.begin(), target.vertices.end(), v) == target.vertices.end());

    const auto mesh = judged_mesh(face, error_mm);
    const auto present = static_cast<std::size_t>(std::count(neutral.present.begin(), neutral.present.end(), 1));
    ASSERT_EQ(mesh.vertices_mm.size(), present);
    ASSERT_EQ(mesh.attributes.size(), 4U);
    EXPECT_EQ(mesh.attributes[0].name, "error_mm");
    const auto& place = mesh.attributes[3].values;
    for (std::size_t k = 0; k < present; ++k) {
        const auto v = static_cast<std::uint32_t>(place[k]);
        EXPECT_EQ(mesh.vertices_mm[k], neutral.vertices_mm[v] + face.way_mm(v));
        EXPECT_EQ(mesh.attributes[2].values[3 * k + 2], face.way_mm(v).z());
        if (!std::isnan(error_mm[v])) {
            EXPECT_EQ(mesh.attributes[0].values[k], error_mm[v]);
        }
    }
}

}  // namespace
}  // namespace mimik::evaluation
