# Installs the library, moves the install elsewhere, and builds and runs the consumer project with it.
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

# Public headers only, and all of them.
file(GLOB headers RELATIVE "${WORK}/moved/include/osgRayTrace" "${WORK}/moved/include/osgRayTrace/*")
list(REMOVE_ITEM headers Export offscreen)
string(REPLACE "," ";" expected "${PUBLIC_HEADERS}")
list(TRANSFORM expected REPLACE "^.*/" "")
list(SORT headers)
list(SORT expected)
if(NOT headers STREQUAL expected)
    message(FATAL_ERROR "Installed headers are '${headers}', public ones '${expected}'")
endif()

# The package names nothing by a path of the machine that built it.
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

# The README's example compiles as it stands there.
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

# The installed program finds the installed library and plugins, to read scene and reference, where they lie.
set(render "${WORK}/moved/bin/osgraytrace" "${WORK}/moved/share/osgRayTrace/cornell_box.osgt" --size 8 8)
run(${render} -o "${WORK}/box.exr")
run(${render} -o "${WORK}/box.png" --reference "${WORK}/box.exr")
if(NOT output MATCHES "RMSE 0\n")
    message(FATAL_ERROR "The same picture twice, but: ${output}")
endif()
