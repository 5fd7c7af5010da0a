# Writes the manual page of a program. Usage: cmake -D PROGRAM=<file> -D NAME=<name> -D BRIEF=<sentence>
# -D VERSION=<version> -D AWK=<awk> -D SCRIPT=ManualPage.awk -D PAGE=<file> -P ManualPage.cmake
# SPDX-License-Identifier: MIT
cmake_minimum_required(VERSION 3.24)

get_filename_component(folder "${PAGE}" DIRECTORY)
file(MAKE_DIRECTORY "${folder}")
execute_process(COMMAND "${PROGRAM}" --help OUTPUT_VARIABLE help RESULT_VARIABLE result)
if(NOT result EQUAL 0)
    message(FATAL_ERROR "${PROGRAM} --help ended with ${result}")
endif()
file(WRITE "${PAGE}.txt" "${help}")
execute_process(COMMAND "${AWK}" -v "name=${NAME}" -v "brief=${BRIEF}" -v "version=${VERSION}" -f "${SCRIPT}"
    "${PAGE}.txt" OUTPUT_FILE "${PAGE}" RESULT_VARIABLE result)
if(NOT result EQUAL 0)
    message(FATAL_ERROR "${SCRIPT} ended with ${result}")
endif()
