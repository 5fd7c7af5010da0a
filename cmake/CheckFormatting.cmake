# Checks that clang-format 14 would leave each C++ file as it is.
# Usage: cmake -D ROOT=<source folder> [-D FIX=ON] [-D CLANG_FORMAT=<program>] -P CheckFormatting.cmake
# With FIX the files are formatted instead. Other versions than 14 format otherwise: without a
# clang-format 14 the check is skipped, which the last line of the output says. The check fails and
# names the lines to change.
# SPDX-License-Identifier: MIT
cmake_minimum_required(VERSION 3.24)
include("${CMAKE_CURRENT_LIST_DIR}/SourceFiles.cmake")
get_filename_component(ROOT "${ROOT}" ABSOLUTE)

if(NOT DEFINED CLANG_FORMAT)
    set(CLANG_FORMAT clang-format-14 clang-format)
endif()
foreach(name IN LISTS CLANG_FORMAT)
    unset(program CACHE)
    find_program(program "${name}")
    if(program)
        execute_process(COMMAND "${program}" --version OUTPUT_VARIABLE version ERROR_QUIET)
        if(version MATCHES "version 14\\.")
            break()
        endif()
    endif()
    set(program "")
endforeach()
if(NOT program)
    if(FIX)
        message(FATAL_ERROR "clang-format 14 is not found (Debian: clang-format-14)")
    endif()
    message(NOTICE "skipped: clang-format 14 is not found (Debian: clang-format-14)")
    return()
endif()

source_files("${ROOT}" files "${CPP_FILES}")
list(LENGTH files count)
if(count EQUAL 0)
    message(FATAL_ERROR "No C++ files below ROOT='${ROOT}'")
endif()

set(mode --dry-run --Werror --ferror-limit=1)
set(runs 1)
if(FIX)
    set(mode -i)
    set(runs 1 2) # a second run settles what the first one has moved
endif()
foreach(run IN LISTS runs)
    execute_process(COMMAND "${program}" "--style=file:${ROOT}/.clang-format" ${mode} ${files}
        WORKING_DIRECTORY "${ROOT}" RESULT_VARIABLE result ERROR_VARIABLE output)
endforeach()
if(NOT result EQUAL 0)
    message(FATAL_ERROR "${output}Mend with: cmake --build <build folder> --target format")
endif()
message(NOTICE "${count} files are formatted")
