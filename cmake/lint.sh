#!/usr/bin/env bash
# lint.sh BUILD_FOLDER [REGEX] - runs clang-tidy 14 with .clang-tidy over the product's sources whose path
# matches REGEX (default: all of osgRayTrace, osgPlugins and apps). Ends with 1 if it finds anything. The
# build folder must be configured; it takes some twenty minutes on two cores.
# SPDX-License-Identifier: MIT
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
database=${1:?"Usage: lint.sh BUILD_FOLDER [REGEX]"}/compile_commands.json
regex=${2:-.}

tidy=$(command -v clang-tidy-14 || command -v clang-tidy || true)
if [ -z "$tidy" ] || ! "$tidy" --version | grep -q 'version 14\.'; then
    echo "clang-tidy 14 is not found (Debian: clang-tidy-14)" >&2
    exit 2
fi
if [ ! -f "$database" ]; then
    echo "$database is not there; configure first: cmake --preset release" >&2
    exit 2
fi

# GCC takes C++17 for granted and does not pass it. Warnings are the compilers' business.
grep -o '"file": *"[^"]*"' "$database" | cut -d'"' -f4 | sort -u |
    grep -E "^$root/(osgRayTrace|osgPlugins|apps)/" | grep -E "$regex" |
    xargs -r -P "$(nproc)" -n 1 nice "$tidy" -p "$(dirname "$database")" --quiet \
        --warnings-as-errors='*' --extra-arg=-std=gnu++17 --extra-arg=-w
