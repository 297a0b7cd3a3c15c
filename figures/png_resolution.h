#pragma once

#include <cstdint>
#include <vector>

namespace mimik::figures {

/// A PNG that says how large its pixels are in print: chunk pHYs (PNG specification, section 11.3.4.3) behind the
/// header, pixels per metre. 0 dots an inch: the PNG as it is.
/// @param png  that has no such chunk yet, as io::encode_png gives it
[[nodiscard]] std::vector<std::uint8_t> with_resolution(std::vector<std::uint8_t> png, int dots_per_inch);

}  // namespace mimik::figures
