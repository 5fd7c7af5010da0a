# Manual pages of the programs, made of what they print for --help, so that both say the same. Nothing is made if the
# programs cannot be started here, as those for another processor, or are not built, or if there is no awk.
# SPDX-License-Identifier: MIT
include_guard()

find_program(OSGRAYTRACE_AWK NAMES mawk gawk awk)
find_program(OSGRAYTRACE_GZIP gzip)
mark_as_advanced(OSGRAYTRACE_AWK OSGRAYTRACE_GZIP)

# Makes and installs the manual page of a program: osgraytrace_manual(<program> <component> <brief>).
function(osgraytrace_manual program component brief)
    if(CMAKE_CROSSCOMPILING OR NOT OSGRAYTRACE_AWK OR NOT TARGET ${program})
        return()
    endif()
    set(page "${PROJECT_BINARY_DIR}/man/${program}.1")
    set(script "${PROJECT_SOURCE_DIR}/cmake/ManualPage.awk")
    set(compress "")
    set(installed "${page}")
    if(OSGRAYTRACE_GZIP)
        set(compress COMMAND "${OSGRAYTRACE_GZIP}" -9nkf "${page}")
        set(installed "${page}.gz")
    endif()
    add_custom_command(OUTPUT "${page}" COMMAND "${CMAKE_COMMAND}"
            -D "PROGRAM=$<TARGET_FILE:${program}>" -D "NAME=${program}" -D "BRIEF=${brief}"
            -D "VERSION=${PROJECT_VERSION}" -D "AWK=${OSGRAYTRACE_AWK}" -D "SCRIPT=${script}" -D "PAGE=${page}"
            -P "${PROJECT_SOURCE_DIR}/cmake/ManualPage.cmake"
        ${compress}
        DEPENDS ${program} "${script}" "${PROJECT_SOURCE_DIR}/cmake/ManualPage.cmake" VERBATIM)
    add_custom_target(${program}Manual ALL DEPENDS "${page}")
    install(FILES "${installed}" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT ${component})
endfunction()
