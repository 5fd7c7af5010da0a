#!/usr/bin/env bash
# times.sh [--build FOLDER] [--pairs N] [NAME ...] runs programs of clients.txt in which OSG draws everything, in
# turns by themselves and with osgraytrace-run, and prints the medians of their frame times in milliseconds: on the
# clock, and of the processor in all threads, which tells more on a busy machine.
# SPDX-License-Identifier: MIT
set -u
HERE=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
OPTION=pairs VALUE=5
. "$HERE/options.sh"
PAIRS=$VALUE
[ ${#NAMES[@]} -gt 0 ] || NAMES=(osgshaders osgtext osglightpoint osgsimplegl3 rasterized)
WORK=$(mktemp -d) || exit 2
trap 'rm -rf "$WORK"' EXIT
[ -n "${DISPLAY:-}" ] || { echo "times.sh wants a display: xvfb-run" >&2; exit 77; }
export OSG_WINDOW="0 0 640 480" OSG_THREADING=SingleThreaded OSG_NOTIFY_LEVEL=FATAL vblank_mode=0
export OSGRAYTRACE_TEST_FRAMES=120
"$BUILD/bin/clientModels" "$WORK" || exit 2

# median prints the median of the numbers that are read.
median()
{
    sort -g | awk '{ value[NR] = $1 } END { print value[int((NR + 1) / 2)] }'
}

# time_of HOW COMMAND... runs the command and adds its median to WORK/HOW. A program without frame times ends all.
time_of()
{
    local how=$1 start=()
    shift
    [ "$how" = plain ] || start=("$BUILD/bin/osgraytrace-run")
    rm -f "$WORK/run.txt"
    OSGRAYTRACE_TEST_PICTURES=$WORK/run LD_PRELOAD=$BUILD/lib/libframeGrabber.so timeout 300 \
        "${start[@]}" "$@" >/dev/null 2>&1 </dev/null
    local wall processor
    wall=$(awk '$1 == "milliseconds" && $2 > 0 { print $2 }' "$WORK/run.txt" 2>/dev/null)
    processor=$(awk '$1 == "processor" && $2 > 0 { print $2 }' "$WORK/run.txt" 2>/dev/null)
    [ -n "$wall" ] && [ -n "$processor" ] || { echo "no frame times, $how: $*" >&2; exit 2; }
    echo "$wall" >>"$WORK/$how"
    echo "$processor" >>"$WORK/$how.processor"
}

for name in "${NAMES[@]}"; do
    command=$(awk -F ' *[|] *' -v name="$name" '{ split($1, first, " ") } first[2] == name { print $2; exit }' \
        "$HERE/clients.txt")
    command=${command//MODELS/$WORK}
    rm -f "$WORK/plain" "$WORK/traced" "$WORK/plain.processor" "$WORK/traced.processor"
    for ((pair = 0; pair < PAIRS; ++pair)); do
        time_of plain $command
        time_of traced $command
    done
    for what in "" .processor; do
        plain=$(median <"$WORK/plain$what") traced=$(median <"$WORK/traced$what")
        awk -v name="$name${what/./, }" -v a="$plain" -v b="$traced" \
            'BEGIN { printf "%-28s plain %.2f ms, traced %.2f ms: %.3f\n", name, a, b, b / a }'
    done
done
