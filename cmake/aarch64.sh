#!/usr/bin/env bash
# aarch64.sh [TEST ...] builds the engine for aarch64 with Debian's cross compiler, and runs these of its test programs
# under qemu-user: the quick ones if none is named. Embree and TBB are Debian's for arm64, unpacked below the build folder.
# Needs the packages g++-aarch64-linux-gnu and qemu-user.
# SPDX-License-Identifier: MIT
set -euo pipefail
ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[ $# -gt 0 ] || set -- baseTest samplingTest filmTest sceneTest

build=$ROOT/build/aarch64
apt=$build/apt
libraries=$build/arm64
if [ ! -d "$libraries" ]; then
    mkdir -p "$apt/lists/partial" "$apt/archives/partial"
    : >"$apt/status"
    options=(-o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Dir::State::lists="$apt/lists"
             -o Dir::State::status="$apt/status" -o Dir::Cache="$apt" -o Debug::NoLocking=true)
    apt-get -qq "${options[@]}" update
    (cd "$apt" && apt-get -qq "${options[@]}" download \
        libembree-dev libembree3-3 libtbb-dev libtbb12 libtbbmalloc2 libtbbbind-2-5 libhwloc15 libudev1)
    mkdir -p "$libraries.new"
    for package in "$apt"/*.deb; do dpkg-deb -x "$package" "$libraries.new"; done
    mv "$libraries.new" "$libraries"
fi
folder=$libraries/usr/lib/aarch64-linux-gnu
cmake -S "$ROOT" -B "$build" -G Ninja -D CMAKE_BUILD_TYPE=Release -D OSGRAYTRACE_OSG=OFF \
    -D CMAKE_TOOLCHAIN_FILE="$ROOT/cmake/toolchains/aarch64-linux-gnu.cmake" -D CMAKE_FIND_ROOT_PATH="$libraries" \
    -D embree_DIR="$folder/cmake/embree-3.13.5" -D TBB_DIR="$folder/cmake/TBB"
cmake --build "$build" --target "$@"
for test in "$@"; do
    qemu-aarch64 -L /usr/aarch64-linux-gnu -E LD_LIBRARY_PATH="$folder" "$build/bin/$test"
done
