# One folder = one static library `mimik_<name>`, alias and exported name `mimik::<name>`.
#
#   mimik_add_module(animation
#     SOURCES warp.cpp ...
#     PRIVATE_HEADERS sums.h formats
#     PUBLIC  mimik::modeling
#     PRIVATE some::library)
#
# Headers of the folder are installed as <name>/*.h; include them as "animation/warp.h". Not installed are those that end in
# -inl.h and PRIVATE_HEADERS: headers, or folders of headers, that other rooms of this tree may use and nobody else. They
# alone may include other libraries than Eigen (scripts/check.sh rules), whose paths an installed target does not hand on.
add_library(mimik_warnings INTERFACE)
# -Wrestrict: GCC 12 cries wolf on std::string + (GCC bug 105651).
target_compile_options(mimik_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> $<$<BOOL:${MIMIK_WERROR}>:-Werror>)
if(MIMIK_SANITIZE)
  add_compile_options(-fsanitize=${MIMIK_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
    $<$<CXX_COMPILER_ID:Clang>:-fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/cmake/sanitizers.ignore>)
  add_link_options(-fsanitize=${MIMIK_SANITIZE})
endif()

# base/executor_tbb.cpp or base/executor_threads.cpp.
set_property(CACHE MIMIK_EXECUTOR PROPERTY STRINGS tbb threads)
if(MIMIK_EXECUTOR STREQUAL "tbb")
  set(MIMIK_EXECUTOR_LIBRARIES TBB::tbb)
elseif(MIMIK_EXECUTOR STREQUAL "threads")
  set(MIMIK_EXECUTOR_LIBRARIES Threads::Threads)
  add_compile_definitions(MIMIK_EXECUTOR_THREADS)
else()
  message(FATAL_ERROR "MIMIK_EXECUTOR is '${MIMIK_EXECUTOR}'; give tbb or threads")
endif()

# For what only calls the rooms, programs and tests: half the time to compile without most of the optimisation, nothing of
# the work is done there.
add_library(mimik_caller INTERFACE)
target_link_libraries(mimik_caller INTERFACE mimik_warnings)
if(MIMIK_SANITIZE)
  target_compile_options(mimik_caller INTERFACE -O0)
else()
  target_compile_options(mimik_caller INTERFACE $<$<CONFIG:Release>:-O1>)
endif()
# mimik_take_optimised(test_modeling geometry modeling): of a template that both a caller and these layers
# instantiate, the linker takes the first that it meets; let that be the optimised one.
function(mimik_take_optimised target)
  if(MIMIK_SANITIZE)
    list(REMOVE_DUPLICATES ARGN)
    list(REMOVE_ITEM ARGN adapters)  # headers alone
    list(TRANSFORM ARGN REPLACE "(.+)" "$<TARGET_FILE:mimik_\\1>" OUTPUT_VARIABLE archives)
    list(JOIN archives " " archives)
    target_link_options(${target} BEFORE PRIVATE "SHELL:-Wl,--whole-archive ${archives} -Wl,--no-whole-archive")
  endif()
endfunction()

# mimik_rooms_below(evaluation rooms): all rooms that cmake/rooms.txt lets a room use, its own not among them.
file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/rooms.txt mimik_room_lines REGEX "^[a-z]+:")
foreach(line IN LISTS mimik_room_lines)
  string(REGEX MATCH "^([a-z]+):(.*)$" line "${line}")
  set(room ${CMAKE_MATCH_1})
  string(REGEX MATCHALL "[a-z]+" mimik_direct_${room} "${CMAKE_MATCH_2}")
  list(APPEND MIMIK_ROOMS ${room})
endforeach()
function(mimik_rooms_below room result)
  set(below)
  foreach(direct IN LISTS mimik_direct_${room})
    mimik_rooms_below(${direct} theirs)
    list(APPEND below ${direct} ${theirs})
  endforeach()
  list(REMOVE_DUPLICATES below)
  set(${result} ${below} PARENT_SCOPE)
endfunction()

function(mimik_add_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PRIVATE_HEADERS;PUBLIC;PRIVATE" ${ARGN})
  mimik_rooms_below(${name} allowed)
  foreach(dependency IN LISTS ARG_PUBLIC ARG_PRIVATE)
    if(dependency MATCHES "^mimik::(.+)$" AND NOT CMAKE_MATCH_1 IN_LIST allowed)
      message(FATAL_ERROR "room '${name}' must not use '${CMAKE_MATCH_1}'; it may use: ${allowed} (cmake/rooms.txt)")
    endif()
  endforeach()

  add_library(mimik_${name} STATIC ${ARG_SOURCES})
  add_library(mimik::${name} ALIAS mimik_${name})
  set_target_properties(mimik_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(mimik_${name} PUBLIC cxx_std_20)
  target_include_directories(mimik_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/mimik>)
  target_link_libraries(mimik_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:mimik_warnings>)
  install(TARGETS mimik_${name} EXPORT mimikTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.h)
  list(FILTER headers EXCLUDE REGEX "-inl\\.h$")
  foreach(private IN LISTS ARG_PRIVATE_HEADERS)
    if(NOT EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${private})
      message(FATAL_ERROR "room '${name}': PRIVATE_HEADERS names '${private}', which is not there")
    endif()
    list(FILTER headers EXCLUDE REGEX "^${private}(/|$)")
  endforeach()
  foreach(header IN LISTS headers)
    get_filename_component(place ${header} DIRECTORY)
    install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/mimik/${name}/${place})
  endforeach()
endfunction()

# mimik_add_program(mimik SOURCES main.cpp LINK mimik::evaluation ...)
function(mimik_add_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${ARG_LINK} mimik_caller)
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endfunction()
