#include "figures/offscreen.h"

#include <array>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string_view>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glx.h>
#include <X11/Xlib.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkXOpenGLRenderWindow.h>

#include "base/errors.h"

// Debian's GLEW is built for GLX: without an X server it loads every entry point and then reports "no GLX display",
// which VTK takes for a failure and draws nothing. This definition stands before the library's and forgives that code.
// NOLINTNEXTLINE(readability-identifier-naming): the name is GLEW's
extern "C" __attribute__((visibility("default"), used)) unsigned int glewInit() {
    static const auto real = reinterpret_cast<unsigned int (*)()>(dlsym(RTLD_NEXT, "glewInit"));
    constexpr unsigned int error = 1, no_glx_display = 4;
    const unsigned int code = real != nullptr ? real() : error;
    return code == no_glx_display ? 0U : code;
}

namespace mimik::figures {
namespace {

/// A way to draw. `make_current` and `release` bracket each use, so that any thread may draw.
struct Context {
    std::string route;
    vtkSmartPointer<vtkRenderWindow> window;
    std::function<void()> make_current = [] {};
    std::function<void()> release = [] {};
};

using Opened = std::unique_ptr<Context>;  // null: this way does not work here, `why_not` says why

Opened open_egl(std::string& why_not) {
    const auto platform_display =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    EGLDisplay display = platform_display != nullptr
                             ? platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)
                             : EGL_NO_DISPLAY;
    if (display == EGL_NO_DISPLAY) display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    EGLint major = 0, minor = 0, count = 0;
    EGLConfig config{};
    const auto failed = [&](const char* step) {
        why_not = fmt::format("{} failed (EGL error 0x{:04x})", step, eglGetError());
        return Opened();
    };
    if (eglInitialize(display, &major, &minor) == EGL_FALSE) return failed("eglInitialize");
    constexpr std::array<EGLint, 13> wanted = {
        EGL_SURFACE_TYPE,    EGL_PBUFFER_BIT, EGL_RED_SIZE, 8, EGL_GREEN_SIZE, 8, EGL_BLUE_SIZE, 8, EGL_DEPTH_SIZE, 24,
        EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,  EGL_NONE};
    if (eglChooseConfig(display, wanted.data(), &config, 1, &count) == EGL_FALSE || count == 0)
        return failed("eglChooseConfig");
    constexpr std::array<EGLint, 5> size = {EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
    EGLSurface surface = eglCreatePbufferSurface(display, config, size.data());
    if (surface == EGL_NO_SURFACE) return failed("eglCreatePbufferSurface");
    eglBindAPI(EGL_OPENGL_API);
    constexpr std::array<EGLint, 7> version = {
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 2, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version.data());
    if (context == EGL_NO_CONTEXT) return failed("eglCreateContext (OpenGL 3.2 core)");
    if (eglMakeCurrent(display, surface, surface, context) == EGL_FALSE) return failed("eglMakeCurrent");

    auto opened = std::make_unique<Context>();
    opened->make_current = [=] {
        eglBindAPI(EGL_OPENGL_API);
        if (eglMakeCurrent(display, surface, surface, context) == EGL_FALSE)
            throw NumericalError(fmt::format("drawing: eglMakeCurrent failed (EGL error 0x{:04x})", eglGetError()));
    };
    opened->release = [=] { eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); };
    auto window = vtkSmartPointer<vtkGenericOpenGLRenderWindow>::New();
    vtkNew<vtkCallbackCommand> nothing_to_do, is_current;
    nothing_to_do->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
    is_current->SetCallback([](vtkObject*, unsigned long, void*, void* answer) {
        if (answer != nullptr) *static_cast<bool*>(answer) = true;
    });
    window->AddObserver(vtkCommand::WindowMakeCurrentEvent, nothing_to_do);
    window->AddObserver(vtkCommand::WindowIsCurrentEvent, is_current);
    window->SetReadyForRendering(true);
    window->SetSupportsOpenGL(1);
    window->SetIsDirect(1);
    window->SetOffScreenRendering(1);
    window->OpenGLInit();
    opened->window = window;
    opened->route = "EGL surfaceless";
    return opened;
}

/// VTK aborts the process when an X server refuses it, so everything it will ask for is asked for here first.
Opened open_x(Display* display, const std::string& route, std::string& why_not) {
    int error_base = 0, event_base = 0, count = 0;
    if (glXQueryExtension(display, &error_base, &event_base) == False) {
        why_not = "the X server has no GLX";
        return nullptr;
    }
    constexpr std::array<int, 15> wanted = {GLX_DRAWABLE_TYPE,
                                            GLX_WINDOW_BIT,
                                            GLX_RENDER_TYPE,
                                            GLX_RGBA_BIT,
                                            GLX_RED_SIZE,
                                            8,
                                            GLX_GREEN_SIZE,
                                            8,
                                            GLX_BLUE_SIZE,
                                            8,
                                            GLX_DEPTH_SIZE,
                                            16,
                                            GLX_DOUBLEBUFFER,
                                            True,
                                            None};
    GLXFBConfig* configs = glXChooseFBConfig(display, DefaultScreen(display), wanted.data(), &count);
    if (configs != nullptr) XFree(static_cast<void*>(configs));
    if (count == 0) {
        why_not = "the X server offers no RGB visual with depth";
        return nullptr;
    }
    auto window = vtkSmartPointer<vtkXOpenGLRenderWindow>::New();
    window->SetDisplayId(display);
    window->SetOffScreenRendering(1);
    window->SetShowWindow(false);
    auto opened = std::make_unique<Context>();
    opened->make_current = [raw = window.Get()] { raw->MakeCurrent(); };
    opened->release = [raw = window.Get()] { raw->ReleaseCurrent(); };
    opened->window = window;
    opened->route = route;
    return opened;
}

Opened open_display(std::string& why_not) {
    const char* name = std::getenv("DISPLAY");
    if (name == nullptr || *name == '\0') {
        why_not = "DISPLAY is not set";
        return nullptr;
    }
    Display* display = XOpenDisplay(name);
    if (display == nullptr) {
        why_not = fmt::format("the X server '{}' cannot be reached", name);
        return nullptr;
    }
    return open_x(display, fmt::format("X display {}", name), why_not);
}

/// Starts a server of our own. It ends with its last client (-terminate), so it never outlives this process.
Opened open_xvfb(std::string& why_not) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
        why_not = "no pipe could be made";
        return nullptr;
    }
    const pid_t child = fork();
    if (child == 0) {
        // Its own group: an interrupt typed at the terminal reaches us first. 3 is the number Xvfb writes to.
        setpgid(0, 0);
        if (dup2(ends[1], 3) < 0) _exit(126);
        if (ends[1] == 3) fcntl(3, F_SETFD, 0);
        const int null = open("/dev/null", O_RDWR | O_CLOEXEC);
        for (const int stream : {0, 1, 2}) dup2(null, stream);
        execlp("Xvfb", "Xvfb", "-displayfd", "3", "-screen", "0", "64x64x24", "-nolisten", "tcp", "-terminate",
               static_cast<char*>(nullptr));
        _exit(127);
    }
    close(ends[1]);
    std::string number;
    constexpr int patience_ms = 10'000;  // ready after about 0.1 s on a quiet machine
    pollfd readable{ends[0], POLLIN, 0};
    while (child > 0 && number.find('\n') == std::string::npos && poll(&readable, 1, patience_ms) > 0) {
        std::array<char, 16> text{};
        const ssize_t count = read(ends[0], text.data(), text.size());
        if (count <= 0) break;
        number.append(text.data(), static_cast<std::size_t>(count));
    }
    close(ends[0]);
    const auto end = number.find('\n');
    Display* display =
        end == std::string::npos ? nullptr : XOpenDisplay(fmt::format(":{}", number.substr(0, end)).c_str());
    if (display == nullptr) {
        if (child > 0) {
            kill(child, SIGTERM);
            waitpid(child, nullptr, 0);
        }
        why_not = "Xvfb did not start (is the package xvfb installed?)";
        return nullptr;
    }
    return open_x(display, "Xvfb", why_not);
}

Opened open_any() {
    struct Way {
        std::string_view name;
        Opened (*open)(std::string& why_not);
    };
    static constexpr std::array<Way, 3> ways = {{{"egl", open_egl}, {"display", open_display}, {"xvfb", open_xvfb}}};
    const char* variable = std::getenv("MIMIK_DRAWING");
    const std::string_view only = variable == nullptr ? "" : variable;
    std::string reasons;
    bool known = only.empty();
    for (const auto& way : ways) {
        if (!only.empty() && only != way.name) continue;
        known = true;
        std::string why_not;
        if (auto opened = way.open(why_not)) return opened;
        reasons += fmt::format("{}{}: {}", reasons.empty() ? "" : "; ", way.name, why_not);
    }
    if (!known) throw InputError(fmt::format("MIMIK_DRAWING is '{}'; give egl, display or xvfb, or unset it", only));
    throw InputError("no way to draw a figure on this machine (" + reasons +
                     "); install libegl-mesa0 and libgl1-mesa-dri, or xvfb");
}

}  // namespace

void with_offscreen_window(const std::function<void(vtkRenderWindow&, const std::string&)>& draw) {
    static std::mutex one_at_a_time;
    const std::scoped_lock lock(one_at_a_time);
    // Never destroyed: at exit the driver's own statics may already be gone. The system takes everything back.
    static Context* context = nullptr;
    if (context == nullptr) context = open_any().release();
    context->make_current();
    struct Release {
        ~Release() { context->release(); }
    } const release_at_the_end;
    draw(*context->window, context->route);
}

}  // namespace mimik::figures
