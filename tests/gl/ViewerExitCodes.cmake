# Runs osgraytraceviewer without a display, and checks its message and its exit code.
# Usage: cmake -D PROGRAM=<osgraytraceviewer> -D MODEL=<file it can load> -P ViewerExitCodes.cmake
# SPDX-License-Identifier: MIT
unset(ENV{DISPLAY})

function(expect code text)
    execute_process(COMMAND "${PROGRAM}" ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT result STREQUAL "${code}" OR NOT output MATCHES "${text}")
        message(SEND_ERROR "osgraytraceviewer ${ARGN}: exit ${result} instead of ${code}, or no '${text}' in:\n${output}")
    endif()
endfunction()

expect(0 "--light-samples.*Next integrator" --help)
expect(1 "no MODEL given")
expect(1 "unrecognized option --no-such-option" --no-such-option "${MODEL}")
expect(1 "--light-samples many: the values are 1 .. 4096" --light-samples many "${MODEL}")
expect(1 "--max-passes none: the values are 1 .. 16777216" --passes none "${MODEL}")
expect(0 "--passes or --max-passes" --help)
expect(2 "cannot load no-such-file.osgt" no-such-file.osgt)
expect(3 "cannot open a window" --exposure -1 "${MODEL}")
