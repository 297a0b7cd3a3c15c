// A window of OpenCV for `mimik live`: a module that is loaded then, since its libraries (Qt) take several times as
// long to load as all else that `mimik-video` needs.

#include "base/window_module.h"

#include <cstdio>
#include <exception>

#include <dlfcn.h>
#include <opencv2/highgui.hpp>
#include <opencv2/imgproc.hpp>

namespace {

/// Qt ends the whole program where there is no display, so it is asked for before.
bool display_opens() {
    void* library = dlopen("libX11.so.6", RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) return false;
    using Open = void*(const char*);
    using Close = int(void*);
    auto* open = reinterpret_cast<Open*>(dlsym(library, "XOpenDisplay"));
    auto* close = reinterpret_cast<Close*>(dlsym(library, "XCloseDisplay"));
    void* display = open != nullptr ? open(nullptr) : nullptr;
    if (display != nullptr && close != nullptr) close(display);
    return display != nullptr;
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) mimik_window_show_function mimik_window_show_1;

int mimik_window_show_1(const char* title, const std::uint8_t* rgb, int width, int height, int wait_ms, int* key,
                        char* message, std::size_t message_size) {
    try {
        static bool opened = false;
        if (!opened && !display_opens()) {
            std::snprintf(message, message_size, "the display does not open");
            return 1;
        }
        if (!opened) cv::namedWindow(title, cv::WINDOW_AUTOSIZE | cv::WINDOW_GUI_NORMAL);
        const cv::Mat picture(height, width, CV_8UC3, const_cast<std::uint8_t*>(rgb));  // NOLINT: only read
        cv::Mat bgr;
        cv::cvtColor(picture, bgr, cv::COLOR_RGB2BGR);
        cv::imshow(title, bgr);
        *key = cv::waitKey(wait_ms < 1 ? 1 : wait_ms);
        if (opened && cv::getWindowProperty(title, cv::WND_PROP_VISIBLE) < 1) *key = -2;
        opened = true;
        return 0;
    } catch (const std::exception& e) {
        std::snprintf(message, message_size, "%s", e.what());
    } catch (...) {
        std::snprintf(message, message_size, "OpenCV threw something unknown");
    }
    return 1;
}
}
