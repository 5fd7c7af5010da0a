#!/usr/bin/env bash
# embree4.sh SOURCE PREFIX builds Embree 4 from a folder with its source (github.com/RenderKit/embree) and installs it
# below PREFIX, with what osgRayTrace needs alone: triangles, user geometry, instances, packets, masks and filters.
# Then: cmake --preset release -D embree_ROOT=PREFIX
# SPDX-License-Identifier: MIT
set -euo pipefail
[ $# -eq 2 ] || { echo "Usage: embree4.sh SOURCE PREFIX" >&2; exit 1; }

off=()
for part in TUTORIALS ISPC_SUPPORT ZIP_MODE GEOMETRY_QUAD GEOMETRY_CURVE GEOMETRY_SUBDIVISION GEOMETRY_GRID \
            GEOMETRY_POINT GEOMETRY_INSTANCE_ARRAY; do
    off+=(-D "EMBREE_$part=OFF")
done
cmake -S "$1" -B "$2/build" -G Ninja -D CMAKE_BUILD_TYPE=Release -D CMAKE_INSTALL_PREFIX="$2" "${off[@]}"
cmake --build "$2/build" --target install
