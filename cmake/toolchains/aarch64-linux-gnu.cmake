# Toolchain: Debian's cross compiler for aarch64; programs run under qemu-user. CMAKE_FIND_ROOT_PATH is the folder with
# Embree and TBB for arm64 (cmake/aarch64.sh makes one).
# SPDX-License-Identifier: MIT
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L /usr/aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE BOTH) # GLM and Catch2 are headers, the same for all processors
