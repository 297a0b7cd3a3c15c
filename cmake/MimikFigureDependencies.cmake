# Only what draws needs these: find_package(mimik COMPONENTS figures) or report asks for them, plain find_package(mimik) does not.
mimik_find(VTK 9.1 CONFIG COMPONENTS
  CommonCore CommonDataModel RenderingCore RenderingOpenGL2 RenderingFreeType)
mimik_find(OpenGL COMPONENTS EGL GLX)
mimik_find(X11)
