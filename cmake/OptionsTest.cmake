# cmake -DROOM=io "-DHEADERS=a.h b.h" -DOUT=options_test.cpp -P OptionsTest.cmake: a test of every struct of options that
# the headers of a room have (tests/support/sound_options.h), so that none can be forgotten.
separate_arguments(HEADERS)
set(includes)
set(checks)
foreach(header IN LISTS HEADERS)
  file(STRINGS ${header} structs REGEX "^struct [A-Za-z]*(Options|Steps) {")
  if(structs)
    string(APPEND includes "#include \"${header}\"\n")
  endif()
  foreach(struct IN LISTS structs)
    string(REGEX REPLACE "^struct ([A-Za-z]+) .*" "\\1" name "${struct}")
    string(APPEND checks "    test::expect_sound<${name}>(\"${name}\");\n")
  endforeach()
endforeach()
file(CONFIGURE OUTPUT ${OUT} CONTENT [[
#include <gtest/gtest.h>

@includes@#include "tests/support/sound_options.h"

namespace mimik::@ROOM@ {
namespace {

TEST(Options, every_options_default_passes_its_own_check_and_every_field_is_listed) {
@checks@}

}  // namespace
}  // namespace mimik::@ROOM@
]] @ONLY)
