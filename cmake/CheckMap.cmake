# Checks that osgRayTrace/docs/architecture.md, the map of the code, names each header of the library.
# Usage: cmake -D ROOT=<source folder> -P CheckMap.cmake. The script fails and names the headers that are missing.
# SPDX-License-Identifier: MIT
cmake_minimum_required(VERSION 3.24)

file(READ "${ROOT}/osgRayTrace/docs/architecture.md" map)
file(GLOB_RECURSE files LIST_DIRECTORIES false "${ROOT}/osgRayTrace/*")
list(FILTER files INCLUDE REGEX "/[A-Za-z]+(\\.h)?$")
set(missing "")
foreach(file IN LISTS files)
    get_filename_component(name "${file}" NAME)
    string(FIND "${map}" "`${name}`" found)
    if(found LESS 0)
        list(APPEND missing "${name}")
    endif()
endforeach()
if(missing)
    message(FATAL_ERROR "Not in osgRayTrace/docs/architecture.md: ${missing}")
endif()
