#include "facs/catalogue_edit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "facs/facs_catalogue.h"

namespace mimik::facs {
namespace {

using testing::HasSubstr;

const CataloguePoint& point_of(const FacsCatalogue& catalogue, int unit, const std::string& name) {
    for (const auto& point : catalogue.find(unit)->points)
        if (point.name == name) return point;
    throw std::runtime_error("no point " + name);
}

TEST(CatalogueEdit, changes_the_offsets_that_were_named_and_not_a_byte_beside_them) {
    const std::string text(builtin_catalogue_text());
    const std::vector<PointOffset> offsets = {{12, "mouth_corner", 0.01, -0.02}, {12, "raised_cheek", 0.031, -0.064}};
    const auto edited = with_offsets(text, offsets);
    const auto catalogue = parse_catalogue(edited, "edited");
    EXPECT_EQ(point_of(catalogue, 12, "mouth_corner").placement.lateral, 0.01);
    EXPECT_EQ(point_of(catalogue, 12, "mouth_corner").placement.up, -0.02);
    EXPECT_EQ(point_of(catalogue, 12, "raised_cheek").placement.lateral, 0.031);
    EXPECT_EQ(point_of(catalogue, 14, "mouth_corner").placement.up, 0.0);  // of the same name, another unit's
    // Put back, it is the text that it was, but for an offset that was written as [0, 0] before.
    EXPECT_THAT(edited, HasSubstr("{ name = \"mouth_corner\", kind = \"muscle\", at = { mouth_corner = 1.0 }, offset = "
                                  "[0.010, -0.020] }"));
    auto back = edited;
    const std::string added = ", offset = [0.010, -0.020]", moved = "[0.031, -0.064]";
    back.erase(back.find(added), added.size());
    back.replace(back.find(moved), moved.size(), "[0.03, -0.06]");
    EXPECT_EQ(back, text);
}

TEST(CatalogueEdit, counts_characters_and_not_bytes_before_a_point) {
    std::string text(builtin_catalogue_text());
    const std::string before = "{ name = \"raised_cheek\"";
    text.replace(text.find(before), before.size(), "{ name = \"r\xC3\xA4ised_ch\xE2\x82\xACk\"");
    const std::vector<PointOffset> offsets = {{12, "r\xC3\xA4ised_ch\xE2\x82\xACk", 0.02, 0.03}};
    EXPECT_EQ(point_of(parse_catalogue(with_offsets(text, offsets), "edited"), 12, offsets[0].point).placement.up,
              0.03);
}

TEST(CatalogueEdit, refuses_points_that_are_not_there) {
    const std::vector<PointOffset> offsets = {{12, "elbow", 0, 0}};
    try {
        (void)with_offsets(std::string(builtin_catalogue_text()), offsets);
        FAIL() << "not refused";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("no point 'elbow' of AU12"));
    }
}

}  // namespace
}  // namespace mimik::facs
