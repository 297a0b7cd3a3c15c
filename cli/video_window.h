#pragma once

#include "base/window_module.h"
#include "io/image.h"

namespace mimik::cli {

/// A window on the display, by the module mimik-window.so.
class VideoWindow {
public:
    /// @throws InputError if there is no display, or no such module; both say that -o writes a file instead
    VideoWindow();
    /// Shows a picture and lets the window answer for `wait_ms`. @returns false once the user wants no more: the window
    /// was closed, or q or Escape pressed. @throws InputError if the display does not open
    [[nodiscard]] bool show(const io::Image& picture, int wait_ms);

private:
    mimik_window_show_function* show_ = nullptr;
};

}  // namespace mimik::cli
