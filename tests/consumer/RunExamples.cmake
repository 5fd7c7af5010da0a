# Builds apps/examples in the folder to which BuildConsumer.cmake has installed them, runs each
# program without a display as its user would, and checks the output.
# SPDX-License-Identifier: MIT
cmake_minimum_required(VERSION 3.24)

function(run)
    execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output
        TIMEOUT 300)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "${ARGV}: ${result}\n${output}")
    endif()
    set(output "${output}" PARENT_SCOPE)
endfunction()

set(share "${WORK}/moved/share/osgRayTrace")
file(GLOB programs RELATIVE "${share}/apps/examples" "${share}/apps/examples/*.cpp")
if(NOT programs STREQUAL "headless.cpp;liveEdits.cpp;materials.cpp;picking.cpp;stereo.cpp;viewer.cpp")
    message(FATAL_ERROR "Not the examples that are run below: ${programs}")
endif()

file(READ "${share}/apps/examples/README.md" page)
foreach(program IN LISTS programs)
    file(READ "${share}/apps/examples/${program}" text)
    string(REGEX MATCHALL "\n" lines "${text}")
    list(LENGTH lines count)
    if(count GREATER 60)
        message(FATAL_ERROR "${program} has ${count} lines, 60 are the most that the README promises")
    endif()
    string(REPLACE ".cpp" "" name "${program}")
    if(NOT page MATCHES "\n\\| `${name}[` ]")
        message(FATAL_ERROR "The README of the examples has no row for ${program}")
    endif()
endforeach()

set(bin "${WORK}/examples")
set(pictures "${WORK}/pictures")
file(REMOVE_RECURSE "${bin}" "${pictures}")
file(MAKE_DIRECTORY "${pictures}")
run(${CMAKE_COMMAND} -S "${share}/apps/examples" -B "${bin}" -G "${GENERATOR}"
    -D "CMAKE_CXX_COMPILER=${COMPILER}" -D "CMAKE_PREFIX_PATH=${WORK}/moved"
    -D "CMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
run(${CMAKE_COMMAND} --build "${bin}")

# Each frame is one pass of the whole picture, however long the pass takes.
set(ENV{OSG_LIBRARY_PATH} "${WORK}/moved/${LIBDIR}")
set(ENV{OSG_THREADING} SingleThreaded)
set(ENV{OSG_WINDOW} "0 0 320 240")
set(ENV{OSGRAYTRACE_FRAME_BUDGET} 0)
unset(ENV{DISPLAY})

# run_in_window(<script> <program> <arguments>) runs a program in windows in memory;
# windowsInMemory.cpp lists the script's words.
function(run_in_window script program)
    run(${CMAKE_COMMAND} -E env "LD_PRELOAD=${OSMESA} ${WORK}/build/libwindowsInMemory.so"
        "OSGRAYTRACE_TEST_SCRIPT=${script}" "${bin}/${program}" ${ARGN})
    set(output "${output}" PARENT_SCOPE)
endfunction()

function(check)
    run("${WORK}/build/pictureCheck" ${ARGV})
    message(STATUS "${output}")
endfunction()

# The headless example has the radiance of osgraytrace, except for the rounding of the view matrix.
set(model "${pictures}/model.osgt")
check(model "${model}")
run("${bin}/headless" "${model}" "${pictures}/headless")
check(lit "${pictures}/headless.png")
run("${WORK}/moved/bin/osgraytrace" "${model}" -o "${pictures}/reference.png" --size 640 480
    --integrator path --error 0.02 --reference "${pictures}/headless.exr")
if(NOT output MATCHES "RMSE (0|[0-9.]+e-0[5-9])\n")
    message(FATAL_ERROR "headless and osgraytrace differ: ${output}")
endif()

# The viewer shows what has been rendered without it, except for noise.
run_in_window("11 picture ${pictures}/viewer.png 13 close" viewer "${model}")
check(lit "${pictures}/viewer.png")
check(differ "${pictures}/headless.png" "${pictures}/viewer.png" 0 10)

# Each edit changes the picture, which is complete after four passes and otherwise stays the same.
set(ENV{OSGRAYTRACE_MAX_PASSES} 4)
run_in_window("4 picture ${pictures}/edit0.png 5 key m 9 picture ${pictures}/edit1.png \
10 key c 14 picture ${pictures}/edit2.png 15 key d 19 picture ${pictures}/edit3.png \
20 key a 24 picture ${pictures}/edit4.png 26 close" liveEdits)
check(lit "${pictures}/edit0.png")
foreach(after RANGE 1 4)
    math(EXPR before "${after} - 1")
    check(differ "${pictures}/edit${before}.png" "${pictures}/edit${after}.png" 2 100)
endforeach()
unset(ENV{OSGRAYTRACE_MAX_PASSES})

run_in_window("2 picture ${pictures}/picking.png 3 click 100 110 4 click 220 110 5 click 160 180 \
6 click 160 10 9 close" picking)
check(lit "${pictures}/picking.png")
if(NOT output MATCHES "ball at -2\\.0[0-9 .-]+\nbox at 2\\.0[0-9]* -1 [0-9.]+\nfloor at 0\\.0[0-9 .-]+\nnothing\n")
    message(FATAL_ERROR "picking found something else: ${output}")
endif()

run_in_window("7 picture ${pictures}/materials.png 9 close" materials "${share}/data/sky.exr")
check(lit "${pictures}/materials.png")
check(materials "${pictures}/materials.png")

run_in_window("2 picture ${pictures}/stereo.png 4 close" stereo)
check(lit "${pictures}/stereo.png")
check(parallax "${pictures}/stereo.png" 10)
