#pragma once

#include <functional>
#include <string>

class vtkRenderWindow;

namespace mimik::figures {

/// Calls draw with the process's one off-screen window, its OpenGL context current on this thread, and the way it was
/// opened. Calls from several threads wait for one another. @throws InputError if no way to draw was found.
void with_offscreen_window(const std::function<void(vtkRenderWindow& window, const std::string& route)>& draw);

}  // namespace mimik::figures
