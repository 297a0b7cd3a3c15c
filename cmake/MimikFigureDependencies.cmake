# Only what draws needs these: find_package(mimik COMPONENTS figures) asks for them, plain find_package(mimik) does not.
find_package(VTK 9.1 CONFIG REQUIRED COMPONENTS
  CommonCore CommonDataModel RenderingCore RenderingOpenGL2 RenderingFreeType)
find_package(OpenGL REQUIRED COMPONENTS EGL GLX)
find_package(X11 REQUIRED)
