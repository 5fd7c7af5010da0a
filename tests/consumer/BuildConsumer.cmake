# Installs the library, moves the install elsewhere, and builds and runs the consumer project with
# it.
# SPDX-License-Identifier: MIT
cmake_minimum_required(VERSION 3.24)

function(run)
    execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "${ARGV}\n${output}")
    endif()
    set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE "${WORK}")
run(${CMAKE_COMMAND} --install "${LIBRARY_BUILD}" --prefix "${WORK}/installed")
file(RENAME "${WORK}/installed" "${WORK}/moved")

# The install must have all public headers, and no others.
file(GLOB headers RELATIVE "${WORK}/moved/include/osgRayTrace" "${WORK}/moved/include/osgRayTrace/*")
list(REMOVE_ITEM headers Export offscreen)
string(REPLACE "," ";" expected "${PUBLIC_HEADERS}")
list(TRANSFORM expected REPLACE "^.*/" "")
list(SORT headers)
list(SORT expected)
if(NOT headers STREQUAL expected)
    message(FATAL_ERROR "Installed headers are '${headers}', public ones '${expected}'")
endif()

# The package must name nothing by a path of the machine that built it.
file(GLOB packageFiles "${WORK}/moved/${LIBDIR}/cmake/osgRayTrace/*.cmake")
foreach(file IN LISTS packageFiles)
    file(STRINGS "${file}" paths REGEX "(/usr/|\\.a[\"; ]|embree|tbb|glm)")
    file(STRINGS "${file}" lines)
    foreach(line IN LISTS lines)
        string(FIND "${line}" "${LIBRARY_SOURCE}" inSource)
        string(FIND "${line}" "${LIBRARY_BUILD}" inBuild)
        if(inSource GREATER_EQUAL 0 OR inBuild GREATER_EQUAL 0)
            list(APPEND paths "${line}")
        endif()
    endforeach()
    if(paths)
        message(FATAL_ERROR "${file} holds what only the building machine knows: ${paths}")
    endif()
endforeach()

# The README's example must compile as it stands there.
file(READ "${LIBRARY_SOURCE}/README.md" example)
string(FIND "${example}" "```cpp\n" begin)
math(EXPR begin "${begin} + 7")
string(SUBSTRING "${example}" ${begin} -1 example)
string(FIND "${example}" "```" end)
string(SUBSTRING "${example}" 0 ${end} example)
file(WRITE "${WORK}/readme.cpp" "${example}")

run(${CMAKE_COMMAND} -S "${SOURCE}" -B "${WORK}/build" -G "${GENERATOR}" -D CMAKE_BUILD_TYPE=Release
    -D "CMAKE_CXX_COMPILER=${COMPILER}" -D "CMAKE_PREFIX_PATH=${WORK}/moved"
    -D "README_EXAMPLE=${WORK}/readme.cpp")
run(${CMAKE_COMMAND} --build "${WORK}/build")
run("${WORK}/build/consumer")
run("${WORK}/build/offscreenConsumer")

# pkg-config finds the moved install, too.
find_program(PKG_CONFIG pkg-config)
if(PKG_CONFIG)
    set(ENV{PKG_CONFIG_PATH} "${WORK}/moved/${LIBDIR}/pkgconfig")
    run("${PKG_CONFIG}" --cflags --libs osgRayTrace)
    separate_arguments(flags UNIX_COMMAND "${output}")
    run("${COMPILER}" -std=c++17 "-DVERSION_OF_PACKAGE=\"${VERSION}\"" "${SOURCE}/main.cpp" ${flags}
        "-Wl,-rpath,${WORK}/moved/${LIBDIR}" -o "${WORK}/viaPkgConfig")
    run("${WORK}/viaPkgConfig")
endif()

# The installed program finds the installed library and plugins, and so reads the scene and the
# reference.
set(share "${WORK}/moved/share/osgRayTrace")
set(render "${WORK}/moved/bin/osgraytrace" "${share}/data/cornell_box.osgt" --size 8 8)
run(${render} -o "${WORK}/box.exr")
run(${render} -o "${WORK}/box.png" --reference "${WORK}/box.exr")
if(NOT output MATCHES "RMSE 0\n")
    message(FATAL_ERROR "The same picture twice, but: ${output}")
endif()

# So does the installed Python module, wherever the install is moved to.
if(PYTHON)
    run(${CMAKE_COMMAND} -E env "PYTHONPATH=${WORK}/moved/${PYTHON_DIR}" "${PYTHON}" -B -c
        "import osgraytrace as o\nr = o.Renderer('${share}/data/terrace.osgt', size=(8, 8), passes=1)
print(r.render()['passes'], o.__file__)")
    if(NOT output MATCHES "1 ${WORK}/moved" OR output MATCHES "cannot|Unsupported")
        message(FATAL_ERROR "Python: ${output}")
    endif()
endif()

# Beside the installed README there must be everything that the pages name: links, and files of
# data.
file(GLOB docs RELATIVE "${LIBRARY_SOURCE}" "${LIBRARY_SOURCE}/osgRayTrace/docs/*.md")
foreach(page README.md data/README.md tests/README.md osgRayTrace/README.md ${docs})
    if(NOT EXISTS "${share}/${page}")
        message(FATAL_ERROR "${page} is not installed")
    endif()
    file(READ "${share}/${page}" text)
    get_filename_component(folder "${share}/${page}" DIRECTORY)
    string(REPLACE "](" "@link@" text "${text}")
    string(REGEX REPLACE "[][;]" " " text "${text}") # both have a meaning in lists
    string(REGEX MATCHALL "@link@[^):]+\\)" links "${text}")
    foreach(link IN LISTS links)
        string(REGEX REPLACE "^@link@(.+).$" "\\1" link "${link}")
        string(REGEX REPLACE "#.*$" "" link "${link}")
        if(NOT EXISTS "${folder}/${link}")
            list(APPEND missing "${page}: ${link}")
        endif()
    endforeach()
    string(REGEX MATCHALL "data/[A-Za-z0-9_]+\\.[a-z]+" files "${text}")
    foreach(file IN LISTS files)
        if(NOT EXISTS "${share}/${file}")
            list(APPEND missing "${page}: ${file}")
        endif()
    endforeach()
endforeach()
file(STRINGS "${share}/data/README.md" rows REGEX "^\\| `")
foreach(row IN LISTS rows)
    string(REGEX REPLACE "^\\| `([^`]+)`.*$" "\\1" file "${row}")
    if(NOT EXISTS "${share}/data/${file}")
        list(APPEND missing "data/README.md: ${file}")
    endif()
endforeach()
if(missing)
    list(REMOVE_DUPLICATES missing)
    list(JOIN missing "\n  " missing)
    message(FATAL_ERROR "Named, but not installed:\n  ${missing}")
endif()

# A scene finds its environment if both are installed: its picture must be that of the source
# folder.
set(render "${WORK}/moved/bin/osgraytrace" --size 16 12 --passes 2)
run(${render} "${LIBRARY_SOURCE}/data/terrace.osgt" -o "${WORK}/terrace.exr")
run(${render} "${share}/data/terrace.osgt" -o "${WORK}/terrace.png" --report
    --reference "${WORK}/terrace.exr")
if(NOT output MATCHES "RMSE 0\n" OR NOT output MATCHES " 1  environment light\n" OR
   output MATCHES "cannot be read")
    message(FATAL_ERROR "terrace.osgt as it is installed: ${output}")
endif()
