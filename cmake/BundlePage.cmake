# cmake -DNPM=npm -DSOURCE=report/page -DWORK=folder -DBUILT=folder -P BundlePage.cmake: the page's parts into BUILT. What
# npm cannot fetch is said and is no error: the page is then not there, and the next build tries again.
file(REMOVE ${BUILT}/page.js)
file(MAKE_DIRECTORY ${WORK} ${BUILT})
file(SHA256 ${SOURCE}/package-lock.json lock)
set(stamp ${WORK}/node_modules/.mimik-${lock})
if(NOT EXISTS ${stamp})
  file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json ${SOURCE}/.npmrc DESTINATION ${WORK})
  execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error --fetch-retries=1 --fetch-timeout=30000
    WORKING_DIRECTORY ${WORK} RESULT_VARIABLE code OUTPUT_QUIET ERROR_VARIABLE fault)
  if(NOT code EQUAL 0)
    string(STRIP "${fault}" fault)
    message(NOTICE "The report's page is not built: npm ci failed (${fault})")
    return()
  endif()
  file(TOUCH ${stamp})
endif()
# Sources stand where they are; NODE_PATH says where the packages are.
execute_process(
  COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=${WORK}/node_modules ${WORK}/node_modules/.bin/esbuild ${SOURCE}/src/main.js
    --bundle --minify --format=iife --target=es2022 --charset=ascii --legal-comments=eof --log-level=warning
    --outfile=${WORK}/page.js
  RESULT_VARIABLE code)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "esbuild cannot bundle ${SOURCE}/src/main.js")
endif()
# The licences of what is in it go where it goes, which is into every page.
file(GLOB licences ${WORK}/node_modules/*/LICENSE* ${WORK}/node_modules/@observablehq/*/LICENSE*)
list(FILTER licences EXCLUDE REGEX "/esbuild/")
list(SORT licences)
foreach(licence IN LISTS licences)
  get_filename_component(package ${licence} DIRECTORY)
  file(RELATIVE_PATH package ${WORK}/node_modules ${package})
  file(READ ${licence} text)
  string(REPLACE "*/" "* /" text "${text}")
  string(REPLACE "</" "< /" text "${text}")
  file(APPEND ${WORK}/page.js "/* Licence of ${package}:\n${text}*/\n")
endforeach()
file(COPY ${SOURCE}/page.mustache ${SOURCE}/style.css DESTINATION ${BUILT})
file(COPY ${WORK}/page.js DESTINATION ${BUILT})
# file(COPY) keeps times: the build compares them.
file(TOUCH ${BUILT}/page.js)
