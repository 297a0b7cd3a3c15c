#include "base/fields.h"

#include <cstdint>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/content_hash.h"
#include "base/text.h"

namespace mimik::base {
namespace {

enum class Kernel { plain, squared };
constexpr const char* to_string(Kernel kernel) { return kernel == Kernel::plain ? "plain" : "squared"; }

struct Inner {
    double width_mm = 0.5;
    bool on = true;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("width_mm", self.width_mm);
        visit("on", self.on);
    }
};
struct Outer {
    int count = -3;
    std::size_t most = 2000;
    Kernel kernel = Kernel::plain;
    std::optional<double> limit_mm;
    std::string name = "thesis";
    Inner inner;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("count", self.count);
        visit("most", self.most);
        visit("kernel", self.kernel);
        visit("limit_mm", self.limit_mm);
        visit("name", self.name);
        visit("inner", self.inner);
    }
};
struct Forgetful {
    int listed = 1;
    double forgotten = 2;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("listed", self.listed);
    }
};
struct Deliberate {
    int listed = 1;
    double not_listed = 2;
    static constexpr std::size_t unlisted = 1;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("listed", self.listed);
    }
};
static_assert(lists_every_field<Inner>());
static_assert(!lists_every_field<Forgetful>());
static_assert(lists_every_field<Deliberate>());

TEST(Fields, one_that_is_left_out_is_found) {
    EXPECT_TRUE(lists_every_field<Outer>());  // clang 14 has no strings in constant expressions
    EXPECT_FALSE(lists_every_field<Forgetful>());
}

TEST(Fields, their_text_has_every_value_as_people_read_it) {
    EXPECT_EQ(field_text(Outer{}),
              " count -3 most 2000 kernel plain limit_mm none name thesis inner.width_mm 0.5 inner.on on");
    EXPECT_EQ(field_text(Outer{.kernel = Kernel::squared, .limit_mm = 1e-6, .inner = {.width_mm = 1e6, .on = false}}),
              " count -3 most 2000 kernel squared limit_mm 1e-06 name thesis inner.width_mm 1000000 inner.on off");
    EXPECT_EQ(number_text(0.1), "0.1");
    EXPECT_EQ(number_text(30.0), "30");
    EXPECT_EQ(number_text(1e16), "1e+16");
}

TEST(Fields, that_differ_are_named_with_both_values_also_those_of_a_struct_within) {
    EXPECT_TRUE(field_differences(Outer{}, Outer{}).empty());
    const auto differences = field_differences(Outer{}, Outer{.limit_mm = 2, .inner = {.on = false}});
    ASSERT_EQ(differences.size(), 2U);
    EXPECT_EQ(differences[0].name, "limit_mm");
    EXPECT_EQ(differences[0].first, "none");
    EXPECT_EQ(differences[0].second, "2");
    EXPECT_FALSE(differences[0].is_switch);
    EXPECT_EQ(differences[1].name, "inner.on");
    EXPECT_EQ(differences[1].second, "off");
    EXPECT_TRUE(differences[1].is_switch);
}

TEST(Fields, that_are_lists_are_shown_with_all_their_values) {
    EXPECT_EQ(value_text(std::vector<std::string>{"bs000", "bs001"}), "bs000, bs001");
    EXPECT_EQ(value_text(std::vector<Kernel>{Kernel::squared}), "squared");
    EXPECT_EQ(value_text(std::vector<double>{}), "none");
}

TEST(Counted, one_thing_is_singular_and_every_other_number_is_not) {
    EXPECT_EQ(counted(1, "face"), "1 face");
    EXPECT_EQ(counted(0, "face"), "0 faces");
    EXPECT_EQ(counted(2, "face"), "2 faces");
    EXPECT_EQ(counted(1, "vertex has", "vertices have"), "1 vertex has");
    EXPECT_EQ(counted(12, "vertex has", "vertices have"), "12 vertices have");
}

TEST(ContentHash, of_nothing_is_the_offset_of_fnv_1a_in_16_digits) {
    EXPECT_EQ(ContentHash().text(), "cbf29ce484222325");
    ContentHash a;
    a.add("a");
    EXPECT_EQ(a.text(), "af63dc4c8601ec8c");  // published test vector
}

}  // namespace
}  // namespace mimik::base
