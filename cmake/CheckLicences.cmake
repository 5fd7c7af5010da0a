# Checks that each source, CMake and shell file states its licence on a line of its own.
# Usage: cmake -D ROOT=<source folder> -P CheckLicences.cmake; fails and names the files that do not.
# SPDX-License-Identifier: MIT
cmake_minimum_required(VERSION 3.24)
include("${CMAKE_CURRENT_LIST_DIR}/SourceFiles.cmake")
get_filename_component(ROOT "${ROOT}" ABSOLUTE)

source_files("${ROOT}" files
    "${CPP_FILES}|\\.(cmake|sh|in|ya?ml|cff|pyi?|css|js)$|(^|/)(CMakeLists\\.txt|Dockerfile|\\.ci/run)$")
list(LENGTH files count)
if(count EQUAL 0)
    message(FATAL_ERROR "No source files below ROOT='${ROOT}'")
endif()
set(missing "")
foreach(file IN LISTS files)
    file(STRINGS "${ROOT}/${file}" lines REGEX "^(//|#|/\\*) SPDX-License-Identifier: MIT( \\*/)?$")
    if(NOT lines)
        string(APPEND missing "\n  ${file}")
    endif()
endforeach()
if(missing)
    message(FATAL_ERROR "No line '// SPDX-License-Identifier: MIT' (or '#') of its own:${missing}")
endif()
message(NOTICE "${count} files state their licence")
