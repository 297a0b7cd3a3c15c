#include "base/markup.h"

#include <gtest/gtest.h>

namespace mimik::base {
namespace {

TEST(MarkupText, holds_no_markup_and_no_control_character) {
    EXPECT_EQ(markup_text("<a href=\"x\">R&D</a>"), "&lt;a href=&quot;x&quot;&gt;R&amp;D&lt;/a&gt;");
    EXPECT_EQ(markup_text("a\nb\x01"
                          "c"),
              "a b c");
}

TEST(MarkupText, leaves_letters_of_every_language_as_they_are) { EXPECT_EQ(markup_text("Ärger, 笑"), "Ärger, 笑"); }

}  // namespace
}  // namespace mimik::base
