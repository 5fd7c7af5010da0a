# Installs each component, as packages have them, and all together: each file must be in one component, and in one
# only. A file of none would be in no package.
# Usage: cmake -D BUILD=<build folder> -D WORK=<folder> -D COMPONENTS=<a,b,c> -P CheckComponents.cmake
# SPDX-License-Identifier: MIT
cmake_minimum_required(VERSION 3.24)

function(installed folder result)
    execute_process(COMMAND ${CMAKE_COMMAND} --install "${BUILD}" --prefix "${WORK}/${folder}" ${ARGN}
        RESULT_VARIABLE code OUTPUT_QUIET ERROR_VARIABLE error)
    if(NOT code EQUAL 0)
        message(FATAL_ERROR "${error}")
    endif()
    file(GLOB_RECURSE files RELATIVE "${WORK}/${folder}" "${WORK}/${folder}/*")
    list(FILTER files EXCLUDE REGEX "^share/doc/") # licences and changes of each package
    set(${result} "${files}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE "${WORK}")
installed(all all)
string(REPLACE "," ";" components "${COMPONENTS}")
set(packaged "")
foreach(component IN LISTS components)
    installed("${component}" files --component "${component}")
    if(NOT files)
        message(FATAL_ERROR "the component ${component} is empty")
    endif()
    list(APPEND packaged ${files})
    if(NOT EXISTS "${WORK}/${component}/share/doc")
        message(FATAL_ERROR "the component ${component} does not say its licence")
    endif()
endforeach()

list(LENGTH packaged count)
list(SORT packaged)
list(SORT all)
if(NOT packaged STREQUAL all)
    set(missing ${all})
    list(REMOVE_ITEM missing ${packaged})
    message(FATAL_ERROR "Files in no component: '${missing}', or in several: ${count} in components")
endif()
message(NOTICE "${count} files, each in one of ${COMPONENTS}")
