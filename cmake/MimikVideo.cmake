# OpenCV's modules that the room `video` links, if they are there (scripts/setup.sh installs them).
set(MIMIK_VIDEO_FOUND FALSE)
if(NOT MIMIK_SANITIZE)
  find_package(OpenCV 4.6 CONFIG QUIET
    COMPONENTS core imgproc imgcodecs video videoio objdetect ml calib3d)
  if(OpenCV_FOUND AND TARGET opencv_videoio AND TARGET opencv_objdetect AND TARGET opencv_ml)
    set(MIMIK_VIDEO_FOUND TRUE)
  else()
    message(STATUS "OpenCV's video modules are not there: mimik-video is not built (scripts/setup.sh installs them)")
  endif()
endif()
