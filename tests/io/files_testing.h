#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/thrown.h"

namespace mimik::io {

using test::message_of;
using test::TemporaryFolder;

inline std::span<const std::uint8_t> bytes_of(std::string_view text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace mimik::io
