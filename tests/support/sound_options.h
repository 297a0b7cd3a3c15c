#pragma once

#include <gtest/gtest.h>

#include "base/fields.h"

namespace mimik::test {

/// cmake/OptionsTest.cmake calls it for every struct of options of a room.
template <class Options>
void expect_sound(const char* name) {
    EXPECT_TRUE(base::lists_every_field<Options>()) << name << ": each_field() does not list every member";
    if constexpr (requires(const Options& options) { options.check(); }) {
        EXPECT_NO_THROW(Options{}.check()) << name;
    }
}

}  // namespace mimik::test
