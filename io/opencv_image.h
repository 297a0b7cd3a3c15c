#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "io/image.h"

namespace mimik::io {

/// Decodes an image that Mimik itself does not read by the companion mimik-opencv (base/companion.h). Nothing: it is
/// not installed. @throws InputError with `name` and what OpenCV says.
[[nodiscard]] std::optional<Image> decode_with_opencv(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace mimik::io
