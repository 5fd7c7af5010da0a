# Gives cmake/CheckLicences.cmake and cmake/CheckFormatting.cmake small source trees that break one rule each,
# and one tree that breaks none.
# SPDX-License-Identifier: MIT
cmake_minimum_required(VERSION 3.24)
include("${CMAKE_CURRENT_LIST_DIR}/../FindsOffences.cmake")

set(licence "// SPDX-License-Identifier: MIT\n")

# check(<check> <file> <text> <expected message>) checks a tree of one good file and this one. If no
# message is expected the check must pass.
function(check script file text expected)
    file(REMOVE_RECURSE "${WORK}")
    file(COPY "${SOURCE}/.clang-format" DESTINATION "${WORK}")
    file(WRITE "${WORK}/osgRayTrace/base/Good.h" "// Good.h - is good.\n${licence}#pragma once\n")
    file(WRITE "${WORK}/build/Bad.cpp" "int   generated ;")
    file(WRITE "${WORK}/${file}" "${text}")
    expect_outcome("${SOURCE}/cmake/${script}.cmake" "${script}: '${text}' in ${file}" "${expected}")
endfunction()

check(CheckLicences apps/a/A.cpp "${licence}" "")
check(CheckLicences tests/CMakeLists.txt "# Tests.\n# SPDX-License-Identifier: MIT\n" "")
check(CheckLicences README.md "no source" "")
check(CheckLicences apps/a/A.cpp "int a;\n" "apps/a/A\\.cpp")
check(CheckLicences apps/a/A.cpp "// A.cpp - a. SPDX-License-Identifier: MIT\n" "apps/a/A\\.cpp")
check(CheckLicences osgRayTrace/AreaLight "// AreaLight\n" "osgRayTrace/AreaLight")
check(CheckLicences osgRayTrace/offscreen/FrameCapture "// SPDX-License-Identifier:\n// MIT\n" "FrameCapture")
check(CheckLicences tests/CMakeLists.txt "# Tests.\n" "tests/CMakeLists\\.txt")
check(CheckLicences cmake/a.sh "#!/bin/sh\n" "cmake/a\\.sh")
check(CheckLicences .ci/run "#!/bin/sh\n" "\\.ci/run")
check(CheckLicences CMakeLists.txt "project(a)\n" "CMakeLists\\.txt")

check(CheckFormatting apps/a/A.cpp "int a;\n" "")
check(CheckFormatting osgRayTrace/README.md "int   a ;" "")
check(CheckFormatting apps/a/A.cpp "int   a;\n" "A\\.cpp:1:")
check(CheckFormatting data/generator/A.h "int *a;\n" "A\\.h:1:")
check(CheckFormatting osgRayTrace/AreaLight "class A {\n};\n" "AreaLight:1:")
check(CheckFormatting osgRayTrace/offscreen/FrameCapture "int a ;\n" "FrameCapture:1:")
check(CheckFormatting tests/base/A.cpp "void f()\n{\n  g();\n}\n" "A\\.cpp:2:")

file(REMOVE_RECURSE "${WORK}")
get_property(skipped GLOBAL PROPERTY skipped_check)
if(skipped)
    message(NOTICE "${skipped}")
endif()
