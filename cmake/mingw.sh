#!/usr/bin/env bash
# mingw.sh compiles the engine for Windows with Debian's x86_64-w64-mingw32: the nearest thing to Windows on Linux.
# Nothing is linked or run: there are headers of Embree and TBB here, but no libraries for Windows.
# Needs the package g++-mingw-w64-x86-64.
# SPDX-License-Identifier: MIT
set -euo pipefail
ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

build=$ROOT/build/mingw
libraries=$build/libraries
# package TARGET NAME [LINE ...] writes a package of CMake's that has headers alone.
package()
{
    mkdir -p "$libraries/lib/cmake/$2"
    printf '%s\n' "add_library($1 INTERFACE IMPORTED)" \
        "target_include_directories($1 INTERFACE \"$libraries/include\")" >"$libraries/lib/cmake/$2/$2Config.cmake"
    printf '%s\n' "${@:3}" >"$libraries/lib/cmake/$2/$2ConfigVersion.cmake"
}
mkdir -p "$libraries/include"
for folder in embree3 tbb oneapi glm; do ln -sfn "/usr/include/$folder" "$libraries/include/$folder"; done
package embree embree 'set(PACKAGE_VERSION 3.13.5)' 'string(COMPARE EQUAL "${PACKAGE_FIND_VERSION_MAJOR}" 3 PACKAGE_VERSION_COMPATIBLE)'
package TBB::tbb TBB 'set(PACKAGE_VERSION_COMPATIBLE TRUE)'
package glm::glm glm 'set(PACKAGE_VERSION_COMPATIBLE TRUE)'

cmake -S "$ROOT" -B "$build" -G Ninja -D CMAKE_BUILD_TYPE=Release -D OSGRAYTRACE_OSG=OFF -D OSGRAYTRACE_BUILD_TESTS=OFF \
    -D CMAKE_TOOLCHAIN_FILE="$ROOT/cmake/toolchains/x86_64-w64-mingw32.cmake" -D CMAKE_FIND_ROOT_PATH="$libraries"
cmake --build "$build" --target osgRayTraceEngine
