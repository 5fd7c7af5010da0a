# Starts exitProgram 20 times; each time another thread ends it, after another number of frames.
# Usage: cmake -D PROGRAM=<exitProgram> -D MODE=<its mode> -P ExitRuns.cmake
# SPDX-License-Identifier: MIT
set(failed 0)
foreach(run RANGE 1 20)
    math(EXPR frames "${run} % 7 + 1")
    math(EXPR milliseconds "${run} % 4 * 20 + 20")
    execute_process(COMMAND "${PROGRAM}" ${MODE} ${frames} ${milliseconds} TIMEOUT 60
                    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT result STREQUAL "0")
        message("exitProgram ${MODE} ${frames} ${milliseconds}: ${result}\n${output}")
        math(EXPR failed "${failed} + 1")
    endif()
endforeach()
if(failed)
    message(FATAL_ERROR "${failed} of 20 starts did not end with exit code 0")
endif()
