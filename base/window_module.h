#pragma once

#include <cstddef>
#include <cstdint>

// What companions/window_module.cpp gives, and who loads it looks up by name: plain C, so that neither side knows the
// other's types.

extern "C" {

/// Shows a picture in the window of this title, which it opens at the first call, and waits up to `wait_ms` (at least
/// 1) for a key. @param rgb  3 * width * height bytes, rows from the top
/// @param key  the key that was pressed; -1: none; -2: the window was closed
/// @returns 0 when done, else what went wrong is in `message`, of `message_size` bytes
using mimik_window_show_function = int(const char* title, const std::uint8_t* rgb, int width, int height, int wait_ms,
                                       int* key, char* message, std::size_t message_size);
}

namespace mimik::base {

inline constexpr const char* window_module_name = "mimik-window.so";
inline constexpr const char* window_show_name = "mimik_window_show_1";

}  // namespace mimik::base
