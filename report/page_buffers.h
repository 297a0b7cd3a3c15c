#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace mimik::report {

// Numbers of a face as the report's page carries them (report/page/src/buffers.js reads them): whole steps of 0.01 mm,
// each less its predecessor, low bytes before high bytes, deflated, in base64. Neighbours on a face differ by little,
// so a vertex takes 3 to 5 bytes.

/// A step of coordinates and distances: a tenth of what scanners resolve.
inline constexpr double page_step_mm = 0.01;
/// Stands for "not known" in a buffer of distances.
inline constexpr std::int16_t page_no_value = std::numeric_limits<std::int16_t>::min();

/// In steps, rounded; beyond 327 mm the end of the range; NaN: page_no_value.
[[nodiscard]] std::int16_t in_page_steps(double mm);

/// The same values have the same text on every machine with the same zlib.
[[nodiscard]] std::string packed_steps(std::span<const std::int16_t> steps);
/// Bytes, deflated, in base64.
[[nodiscard]] std::string packed_bytes(std::span<const std::uint8_t> bytes);

/// What packed_steps() and packed_bytes() packed, for tests and other readers. @throws InputError if it is no such
/// text.
[[nodiscard]] std::vector<std::int16_t> unpacked_steps(const std::string& text, std::size_t count);
[[nodiscard]] std::vector<std::uint8_t> unpacked_bytes(const std::string& text, std::size_t count);

}  // namespace mimik::report
