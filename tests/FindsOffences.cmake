# Runs a check of the source tree on a tree that breaks one of its rules, or none.
# SPDX-License-Identifier: MIT

# expect_outcome(<check> <case> <expected message or empty>) runs the check on the tree in WORK. If no message is
# expected, the check must pass. Where clang-format 14 is missing, nothing is expected, and the global property
# skipped_check is the check's own line about this.
function(expect_outcome script case expected)
    execute_process(COMMAND "${CMAKE_COMMAND}" -D "ROOT=${WORK}" -P "${script}"
        RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(output MATCHES "(skipped: clang-format 14[^\n]*)")
        set_property(GLOBAL PROPERTY skipped_check "${CMAKE_MATCH_1}")
    elseif(expected STREQUAL "")
        if(NOT result EQUAL 0)
            message(SEND_ERROR "${case} is allowed, but: ${output}")
        endif()
    elseif(result EQUAL 0 OR NOT output MATCHES "${expected}")
        message(SEND_ERROR "${case} was not found to be wrong: ${output}")
    endif()
endfunction()
