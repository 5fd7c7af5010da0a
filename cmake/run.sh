#!/usr/bin/env bash
# run.sh [MODEL ...] - builds osgRayTrace, renders each model (default: our Cornell box) to
# out/<name>.png and out/<name>.exr, and opens the viewer if there is a display.
# SPDX-License-Identifier: MIT
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

install_packages
build release osgraytrace osgraytraceviewer osgdb_exr osgdb_glb osgdb_hdr osgdb_raytrace osgdb_serializers_osgraytrace osgdb_vdb

bin=$ROOT/build/release/bin
out=$ROOT/out
mkdir -p "$out"
[ $# -gt 0 ] || set -- "$ROOT/data/cornell_box.osgt"

for model in "$@"; do
    name=$(basename "${model%.*}")
    "$bin/osgraytrace" "$model" -o "$out/$name.png" -o "$out/$name.exr"
    say "Rendered $model:"
    say "  $out/$name.png"
    say "  $out/$name.exr"
done

if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
    say "Opening the viewer; h shows its keys, Escape ends it."
    "$bin/osgraytraceviewer" "$@"
fi
