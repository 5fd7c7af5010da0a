#!/usr/bin/env bash
# abi.sh [TAG] - compares the interface of both libraries with that of a tag, the last one by default, by abidiff, and
# lists what differs. Ends with 1 if programs that were linked to the tag's libraries may fail with these, although both
# have one version for the loader (0.1): changes of that kind need another one. Types of public headers count alone.
# It builds the libraries of both in build/abi, with what debuggers need: half an hour on two cores.
#
# abi.sh OLD NEW compares two library files. Without debug information only functions that came and went are seen.
# SPDX-License-Identifier: MIT
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

LIBRARIES=(osgRayTrace osgRayTraceOffscreen)
DIFFERENT=12 # bits of abidiff's status: 4, types or functions differ; 8, functions went. 1 and 2: it failed

# compare OLD NEW [ARGUMENTS]: prints the difference, and returns whether NEW can stand for OLD.
compare()
{
    local status=0
    abidiff --no-added-syms "${@:3}" "$1" "$2" || status=$?
    [ $((status & 3)) -eq 0 ] || { say "abidiff failed"; exit 2; }
    [ $((status & DIFFERENT)) -eq 0 ]
}

# buildLibraries SOURCE FOLDER
buildLibraries()
{
    cmake -S "$1" -B "$2" -G Ninja -D CMAKE_BUILD_TYPE=RelWithDebInfo -D OSGRAYTRACE_BUILD_APPS=OFF \
        -D OSGRAYTRACE_BUILD_PLUGINS=OFF -D OSGRAYTRACE_BUILD_TESTS=OFF \
        -D CMAKE_CXX_COMPILER_LAUNCHER="$(command -v ccache || true)" >/dev/null
    cmake --build "$2" --target "${LIBRARIES[@]}" >&2
}

PACKAGES+=(git abigail-tools)
install_packages
if [ $# -eq 2 ]; then
    compare "$1" "$2"
    exit
fi

tag=${1:-$(git -C "$ROOT" describe --tags --abbrev=0 2>/dev/null || true)}
if [ -z "$tag" ]; then
    say "There is no tag to compare with."
    exit 0
fi
folder=$ROOT/build/abi
rm -rf "$folder/old-source"
mkdir -p "$folder/old-source"
git -C "$ROOT" archive "$tag" | tar -x -C "$folder/old-source"
buildLibraries "$folder/old-source" "$folder/old"
buildLibraries "$ROOT" "$folder/new"

soversion() { sed -n 's/^project(osgRayTrace VERSION \([0-9]*\.[0-9]*\).*/\1/p' "$1/CMakeLists.txt"; }
code=0
for library in "${LIBRARIES[@]}"; do
    say "lib$library.so, $tag and this"
    compare "$folder/old/lib/lib$library.so" "$folder/new/lib/lib$library.so" \
        --headers-dir1 "$folder/old-source/osgRayTrace" --headers-dir2 "$ROOT/osgRayTrace" \
        --drop-private-types || code=1
done
if [ "$(soversion "$folder/old-source")" != "$(soversion "$ROOT")" ]; then
    say "Both have their own version for the loader, so programs do not mix them up."
    exit 0
fi
exit $code
