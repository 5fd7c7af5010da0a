# Removes the comments from one public header: cmake/BuildApiPages.cmake must name the members that
# lack one.
# Usage: cmake -D ROOT=<source folder> -D DOXYGEN=<program> -D DOXYFILE=<file> -D WORK=<folder> -P this
# SPDX-License-Identifier: MIT
cmake_minimum_required(VERSION 3.24)

file(REMOVE_RECURSE "${WORK}")
file(READ "${ROOT}/osgRayTrace/AreaLight" header)
string(REPLACE "    ///" "    //" header "${header}")
file(WRITE "${WORK}/osgRayTrace/AreaLight" "${header}")
file(READ "${DOXYFILE}" settings)
string(REPLACE "\"${ROOT}/osgRayTrace/AreaLight\"" "\"${WORK}/osgRayTrace/AreaLight\"" settings "${settings}")
string(REGEX REPLACE "\"[^\"]*\\.md\"" "" settings "${settings}") # only the pages of headers are made
file(WRITE "${WORK}/Doxyfile"
    "${settings}\nOUTPUT_DIRECTORY = \"${WORK}/docs\"\nWARN_LOGFILE = \"${WORK}/docs/warnings.txt\"\nHAVE_DOT = NO\n")

execute_process(COMMAND "${CMAKE_COMMAND}" -D "ROOT=${ROOT}" -D "DOXYGEN=${DOXYGEN}" -D "DOXYFILE=${WORK}/Doxyfile"
        -D "DOCS=${WORK}/docs" -P "${ROOT}/cmake/BuildApiPages.cmake"
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(result EQUAL 0 OR NOT output MATCHES "osgRayTrace/AreaLight:[0-9]+: [^\n]*setRadiance[^\n]*not documented")
    message(FATAL_ERROR "A member without a comment was not found: ${output}")
endif()
