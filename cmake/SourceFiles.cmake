# Lists the project's source files without asking git, so that checks work in a plain source archive.
# SPDX-License-Identifier: MIT

# source_files(<root> <result> <regex>) lists the paths below ROOT, relative to ROOT, whose name
# matches REGEX. It searches only the fixed folders and the files of the top level, so it never
# meets build folders.
function(source_files root result regex)
    foreach(folder osgRayTrace osgPlugins apps data tests cmake)
        file(GLOB_RECURSE found RELATIVE "${root}" LIST_DIRECTORIES false "${root}/${folder}/*")
        list(APPEND files ${found})
    endforeach()
    file(GLOB found RELATIVE "${root}" LIST_DIRECTORIES false "${root}/*" "${root}/.ci/*")
    list(APPEND files ${found})
    file(GLOB_RECURSE found RELATIVE "${root}" LIST_DIRECTORIES false "${root}/.github/*")
    list(APPEND files ${found})
    list(FILTER files INCLUDE REGEX "${regex}")
    set(${result} "${files}" PARENT_SCOPE)
endfunction()

# C++ files are .cpp, .h and the headers of the API, which have no suffix.
set(CPP_FILES "\\.(cpp|h)$|^osgRayTrace/([a-z]+/)?[A-Z][A-Za-z]+$")
