# cmake -DSOURCE=folder -DOUT=file -P WriteCommit.cmake: writes which commit the sources are of, as a C++ string, into a
# file that is touched when the answer changes and not before. "0123456789ab"; "0123456789ab+89abcdef" where tracked
# files were changed since, by the digest of the changes; "unknown" outside git.
set(commit "unknown")
find_program(git_program git)
if(git_program)
  # A copy of the sources within somebody else's repository is none of ours.
  execute_process(COMMAND ${git_program} rev-parse --show-prefix HEAD WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE answer RESULT_VARIABLE failed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT failed AND answer MATCHES "^\n([0-9a-f]+)$")
    string(SUBSTRING ${CMAKE_MATCH_1} 0 12 commit)
    execute_process(COMMAND ${git_program} diff HEAD WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE changes ERROR_QUIET)
    if(NOT changes STREQUAL "")
      string(SHA1 digest "${changes}")
      string(SUBSTRING ${digest} 0 8 digest)
      string(APPEND commit "+${digest}")
    endif()
  endif()
endif()
set(content "\"${commit}\"\n")
if(EXISTS ${OUT})
  file(READ ${OUT} there)
endif()
if(NOT "${there}" STREQUAL "${content}")
  file(WRITE ${OUT} "${content}")
endif()
