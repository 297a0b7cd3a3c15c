#include "cli/video_window.h"

#include <array>
#include <cstdlib>

#include <dlfcn.h>
#include <fmt/format.h>

#include "base/companion.h"
#include "base/errors.h"

namespace mimik::cli {
namespace {

constexpr const char* instead = "-o FILE.mp4 writes a video instead";

}  // namespace

VideoWindow::VideoWindow() {
    const char* display = std::getenv("DISPLAY");  // NOLINT(concurrency-mt-unsafe): nothing here sets variables
    if (display == nullptr || *display == 0)
        throw InputError(fmt::format("there is no display for a window (DISPLAY is not set); {}", instead));
    const auto file = base::find_companion(base::window_module_name);
    if (file.empty())
        throw InputError(
            fmt::format("there is no {}, which shows windows; install libopencv-dev and build again, or {}",
                        (base::companion_folder() / base::window_module_name).string(), instead));
    void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);  // stays loaded: Qt does not let go of what it holds
    if (handle == nullptr) throw InputError(fmt::format("no window: {} ({}); {}", file.string(), dlerror(), instead));
    show_ = reinterpret_cast<mimik_window_show_function*>(dlsym(handle, base::window_show_name));
    if (show_ == nullptr)
        throw InputError(fmt::format("no window: {} is of another version; {}", file.string(), instead));
}

bool VideoWindow::show(const io::Image& picture, int wait_ms) {
    constexpr int escape = 27, closed = -2;
    std::array<char, 256> message{};
    int key = -1;
    if (show_("Mimik", picture.rgb.data(), picture.width, picture.height, wait_ms, &key, message.data(),
              message.size()) != 0)
        throw InputError(fmt::format("no window: {}; {}", message.data(), instead));
    const int letter = key < 0 ? 0 : key & 0xff;  // the upper bits say what else is held down
    return key != closed && letter != 'q' && letter != escape;
}

}  // namespace mimik::cli
