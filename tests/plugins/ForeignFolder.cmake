# Installs a module below the prefix, deeper below it and outside of it, with a prefix that is given
# at the installation. The build and libraries elsewhere are gone then, and a program must load the
# module.
# Usage: cmake -D SOURCE= -D WORK= -D GENERATOR= -D ROOT= -P ForeignFolder.cmake
# SPDX-License-Identifier: MIT
cmake_minimum_required(VERSION 3.24)

function(run)
    execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT result EQUAL 0)
        list(JOIN ARGV " " command)
        message(FATAL_ERROR "${command}: ${result}\n${output}")
    endif()
endfunction()

file(REMOVE_RECURSE "${WORK}")
set(number 0)
foreach(folder lib/calvr-plugins share/a/b/plugins "${WORK}/calvr home/lib/calvr-plugins")
    math(EXPR number "${number} + 1")
    set(build "${WORK}/build${number}")
    set(prefix "${WORK}/prefix${number}")
    run(${CMAKE_COMMAND} -G "${GENERATOR}" -S "${SOURCE}" -B "${build}" -D "FOLDER=${folder}" -D "ROOT=${ROOT}")
    run(${CMAKE_COMMAND} --build "${build}")
    run(${CMAKE_COMMAND} --install "${build}" --prefix "${prefix}")
    file(RENAME "${build}/loader" "${WORK}/loader${number}")
    file(REMOVE_RECURSE "${build}")
    get_filename_component(where "${folder}" ABSOLUTE BASE_DIR "${prefix}")
    run("${WORK}/loader${number}" "${where}/libmodule.so")
    run(${CMAKE_COMMAND} -E echo "loaded from ${where}")
endforeach()
