# Checks that osgRayTrace/docs/references.md lists each work that the code cites by a key such as [Kajiya86].
# Usage: cmake -D ROOT=<source folder> -P CheckReferences.cmake. The script fails and names the keys that are missing.
# SPDX-License-Identifier: MIT
cmake_minimum_required(VERSION 3.24)

file(READ "${ROOT}/osgRayTrace/docs/references.md" references)
file(GLOB_RECURSE files LIST_DIRECTORIES false
     "${ROOT}/osgRayTrace/*" "${ROOT}/osgPlugins/*" "${ROOT}/apps/*" "${ROOT}/data/generator/*")
list(FILTER files EXCLUDE REGEX "\\.(txt|md)$")

set(count 0)
set(missing "")
foreach(file IN LISTS files)
    file(STRINGS "${file}" lines REGEX "//.*\\[[A-Z][A-Za-z]+[0-9][0-9]")
    # Brackets would join the elements of a list.
    string(REPLACE "[" "<" lines "${lines}")
    string(REPLACE "]" ">" lines "${lines}")
    string(REGEX MATCHALL "<[A-Z][A-Za-z]+[0-9][0-9]+[,;> ]" citations "${lines}")
    foreach(citation IN LISTS citations)
        string(REGEX REPLACE "[^A-Za-z0-9]" "" key "${citation}")
        math(EXPR count "${count} + 1")
        if(NOT references MATCHES "\n\\| ${key} \\|")
            list(APPEND missing "${key}")
        endif()
    endforeach()
endforeach()

if(missing)
    list(REMOVE_DUPLICATES missing)
    message(FATAL_ERROR "Cited, but not in references.md: ${missing}")
endif()
message(NOTICE "${count} citations found in references.md")
