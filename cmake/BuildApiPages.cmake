# Runs Doxygen and fails if Doxygen warns about a public header.
# Usage: cmake -D ROOT=<source folder> -D DOXYGEN=<program> -D DOXYFILE=<file> -D DOCS=<output folder>
#              -P BuildApiPages.cmake
# SPDX-License-Identifier: MIT
cmake_minimum_required(VERSION 3.24)

file(REMOVE_RECURSE "${DOCS}")
file(MAKE_DIRECTORY "${DOCS}")
execute_process(COMMAND "${DOXYGEN}" "${DOXYFILE}" RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT result EQUAL 0)
    message(FATAL_ERROR "Doxygen ended with ${result}: ${output}")
endif()
if(NOT EXISTS "${DOCS}/html/classosgRayTrace_1_1RayTracedScene.html")
    message(FATAL_ERROR "Doxygen wrote no page of RayTracedScene into ${DOCS}: ${output}")
endif()

# Pages name their pictures as from the root of the source.
file(COPY "${ROOT}/data" DESTINATION "${DOCS}/html"
    FILES_MATCHING PATTERN "*.png" PATTERN "*.gif" PATTERN "*.svg" PATTERN "generator" EXCLUDE)

# Markdown is written for people and for GitHub, whose rules differ from Doxygen's: warnings about
# it are only shown.
file(READ "${DOCS}/warnings.txt" warnings)
if(warnings)
    message(NOTICE "${warnings}")
endif()
file(STRINGS "${DOCS}/warnings.txt" offences REGEX "/osgRayTrace/([a-z]+/)?[A-Z][A-Za-z]+:[0-9]+:")
if(offences)
    list(LENGTH offences count)
    message(FATAL_ERROR "${count} warnings about public headers")
endif()
message(NOTICE "API pages: ${DOCS}/html/index.html")
