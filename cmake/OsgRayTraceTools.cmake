# Targets for people who work on the project: format, lint and docs. None of them is part of "all".
# SPDX-License-Identifier: MIT

set(OSGRAYTRACE_TOOLS "${PROJECT_SOURCE_DIR}/cmake")
add_custom_target(format
    COMMAND ${CMAKE_COMMAND} -D "ROOT=${PROJECT_SOURCE_DIR}" -D FIX=ON -P "${OSGRAYTRACE_TOOLS}/CheckFormatting.cmake"
    VERBATIM)
add_custom_target(lint
    COMMAND "${OSGRAYTRACE_TOOLS}/lint.sh" "${PROJECT_BINARY_DIR}"
    USES_TERMINAL VERBATIM)

# The target docs makes the pages of the public headers and of osgRayTrace/docs.
set(OSGRAYTRACE_DOCS_DIR "${PROJECT_BINARY_DIR}/docs")
find_package(Doxygen QUIET OPTIONAL_COMPONENTS dot)
if(DOXYGEN_FOUND)
    set(OSGRAYTRACE_HAVE_DOT ${DOXYGEN_HAVE_DOT})
    get_target_property(headers osgRayTrace HEADER_SET_headers)
    get_target_property(offscreenHeaders osgRayTraceOffscreen HEADER_SET_headers)
    file(GLOB pages CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/osgRayTrace/docs/*.md")
    set(OSGRAYTRACE_DOCS_INPUT "")
    foreach(file IN LISTS headers offscreenHeaders pages ITEMS README.md CONTRIBUTING.md CHANGELOG.md data/README.md tests/README.md)
        cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY "${PROJECT_SOURCE_DIR}")
        string(APPEND OSGRAYTRACE_DOCS_INPUT " \"${file}\"")
    endforeach()
    configure_file("${PROJECT_SOURCE_DIR}/cmake/Doxyfile.in" "${PROJECT_BINARY_DIR}/Doxyfile" @ONLY)
    set(OSGRAYTRACE_BUILD_API_PAGES ${CMAKE_COMMAND}
        -D "ROOT=${PROJECT_SOURCE_DIR}" -D "DOXYGEN=$<TARGET_FILE:Doxygen::doxygen>" -D "DOXYFILE=${PROJECT_BINARY_DIR}/Doxyfile"
        -D "DOCS=${OSGRAYTRACE_DOCS_DIR}" -P "${PROJECT_SOURCE_DIR}/cmake/BuildApiPages.cmake")
    add_custom_target(docs COMMAND ${OSGRAYTRACE_BUILD_API_PAGES} VERBATIM)
else()
    message(STATUS "API pages: no target docs, Doxygen is not found (Debian: doxygen, graphviz)")
endif()
