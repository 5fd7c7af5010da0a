#!/usr/bin/env bash
# run.sh [--build FOLDER] [--out FOLDER] [NAME ...] runs the programs of clients.txt that are named, or all of
# them, by themselves and with osgraytrace-run. It compares what their windows show without shadows, their
# exit codes, their frames and the drawables that are drawn at all, prints a line for each, and writes
# OUT/index.html with the pictures.
# Exit code: 0 all are right, 1 some are not, 2 usage, 77 nothing could be run.
# Needs a build with the target "clients", Xvfb, and OSG's sample models by OSG_FILE_PATH.
# SPDX-License-Identifier: MIT
set -u
HERE=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
JOBS=2       # programs at a time
SECONDS_EACH=120
LOG_LINES=12 # of ours at most in the log of a program: a kind of bad data has a line or two, and is counted
OPTION=out VALUE=
. "$HERE/options.sh"
OUT=${VALUE:-$BUILD/clients}
mkdir -p "$OUT" && OUT=$(cd "$OUT" && pwd) || exit 2

. "$HERE/table.sh"

# row NAME COLUMN prints a column of the row of clients.txt: 1 kind, 2 command, 3 bound, 4 reason.
row()
{
    awk -F ' *[|] *' -v name="$1" -v column="$2" '
        /^#/ || NF < 2 { next }
        { split($1, first, " "); if (first[2] != name) next
          print column == 1 ? first[1] : $column; exit }' "$HERE/clients.txt"
}

names()
{
    awk '!/^#/ && NF { print $2 }' "$HERE/clients.txt"
}

# start_display opens a display of its own. It must not reset when a program leaves: the next program would
# come in between.
start_display()
{
    mkfifo "$WORK/display"
    Xvfb -displayfd 7 -screen 0 1024x768x24 -nolisten tcp -noreset 7<>"$WORK/display" >/dev/null 2>&1 &
    XVFB=$!
    local number=
    read -r -t 30 number <>"$WORK/display"
    [ -n "$number" ] && export DISPLAY=:$number
}

# run HOW COMMAND... runs the command in a folder of its own; HOW is plain or traced.
run()
{
    local how=$1 start=() preload=$GRABBER
    shift
    if [ "$how" = traced ]; then
        start=("$BUILD/bin/osgraytrace-run" --report "$WORK/report.txt")
        preload=$CHECKER:$GRABBER
    fi
    mkdir -p "$WORK/$how"
    (cd "$WORK/$how" && OSGRAYTRACE_TEST_PICTURES=$WORK/$how LD_PRELOAD=$preload \
        timeout -k 5 $SECONDS_EACH "${start[@]}" "$@" >"$WORK/$how.log" 2>&1 </dev/null)
    echo $? >"$WORK/$how.exit"
}

# value FILE KEY prints what FrameGrabber has counted.
value()
{
    awk -v key="$2" '$1 == key { print $2 }' "$WORK/$1.txt" 2>/dev/null
}

# leaves KEY prints what LeafChecker has counted in the scenes of the program.
leaves()
{
    awk -v key="$1" '$1 == key { sum += $2 } END { print sum + 0 }' "$WORK/traced.leaves" 2>/dev/null
}

# difference prints the largest of the windows' differences, and "blank" if a plain picture is.
difference()
{
    local number
    for ((number = 0; number < $(value plain windows); ++number)); do
        LD_PRELOAD= "$BUILD/bin/comparePictures" "$WORK/plain$number.png" "$WORK/traced$number.png" \
            "$WORK/difference$number.png" 2>>"$WORK/traced.log" || echo 255
    done | sort -g | tail -1
}

# judge BOUND REASON prints "right", or what is wrong.
judge()
{
    local plain traced
    plain=$(cat "$WORK/plain.exit") traced=$(cat "$WORK/traced.exit")
    local plainFrames tracedFrames difference
    plainFrames=$(value plain frames) tracedFrames=$(value traced frames)
    difference=$(difference)
    echo "$difference" >"$WORK/difference"
    if [ "$plain" != "$traced" ]; then
        echo "exit code $traced instead of $plain"
    elif [ "${plainFrames:-0}" -lt 1 ] || [ "${plainFrames:-0}" != "${tracedFrames:-0}" ]; then
        echo "${tracedFrames:-0} frames instead of ${plainFrames:-0}"
    elif [ ! -e "$WORK/traced.leaves" ]; then
        echo "its leaves were not compared"
    elif [ "$(leaves lost)" != 0 ]; then
        echo "$(leaves lost) of $(leaves leaves) leaves lost"
    elif [ "$(leaves stale)" != 0 ]; then
        echo "$(leaves stale) counts of its report are stale"
    elif [ $(($(leaves traced) + $(leaves drawn) + $(leaves empty) + $(leaves other-passes))) != \
        "$(leaves leaves)" ]; then
        echo "its leaves do not add up"
    elif [ "$(grep -c '^osgRayTrace:' "$WORK/traced.log")" -gt $LOG_LINES ]; then
        echo "$(grep -c '^osgRayTrace:' "$WORK/traced.log") lines of ours in its log"
    elif [ -z "$difference" ]; then
        echo "no picture"
    elif [ "${difference%blank}" != "$difference" ] && [ "${2#nothing is seen}" = "$2" ]; then
        echo "a blank picture"
    elif awk -v d="${difference% blank}" -v bound="$1" 'BEGIN { exit !(d > bound) }'; then
        echo "differs by more than $1"
    else
        echo right
    fi
}

# client NAME runs a program both ways; its line goes to OUT/NAME/line, its verdict to OUT/NAME/verdict.
client()
{
    WORK=$OUT/$1
    rm -rf "$WORK" && mkdir -p "$WORK"
    local command
    command=$(row "$1" 2)
    command=${command//MODELS/$OUT/models}
    command=${command//CLIENTS/$HERE}
    command=${command//PROGRAMS/$BUILD/bin}
    if [ "$(row "$1" 1)" = skip ]; then
        echo skipped >"$WORK/verdict"
    elif ! command -v ${command%% *} >/dev/null; then
        echo "not installed" >"$WORK/verdict"
    elif ! start_display; then
        echo "no display" >"$WORK/verdict"
    else
        run plain $command
        if [ "$(cat "$WORK/plain.exit")" = 77 ]; then
            rm "$WORK/plain.exit"
            echo "not installed" >"$WORK/verdict"
        else
            run traced $command
            judge "$(row "$1" 3)" "$(row "$1" 4)" >"$WORK/verdict"
        fi
        kill $XVFB
        wait $XVFB 2>/dev/null
    fi
    printf '%-28s %s%s\n' "$1" "$(cat "$WORK/verdict")" "$([ -s "$WORK/difference" ] &&
        echo ", $(cat "$WORK/difference")/255$([ -e "$WORK/traced.leaves" ] &&
            echo ", lost $(leaves lost) of $(leaves leaves) leaves")")"
}

[ ${#NAMES[@]} -gt 0 ] || mapfile -t NAMES < <(names)
for name in "${NAMES[@]}"; do
    [ -n "$(row "$name" 1)" ] || { echo "clients.txt has no '$name'" >&2; exit 2; }
done
GRABBER=$BUILD/lib/libframeGrabber.so
CHECKER=$BUILD/lib/libleafChecker.so
[ -e "$GRABBER" ] && [ -e "$CHECKER" ] || { echo "no frameGrabber or leafChecker in $BUILD" >&2; exit 2; }
for need in Xvfb "$BUILD/bin/clientModels" "$BUILD/bin/osgraytrace-run"; do
    command -v "$need" >/dev/null || { echo "no $need" >&2; exit 77; }
done
[ -n "${OSG_FILE_PATH:-}" ] || { echo "OSG_FILE_PATH names no sample models" >&2; exit 77; }

# Each frame of a small window is a whole pass, without shadows, so that pictures can be compared. Programs
# that choose their threads have them all the same.
export OSG_WINDOW="0 0 320 240" OSG_THREADING=SingleThreaded OSG_NOTIFY_LEVEL=NOTICE
export OSGRAYTRACE_SHADOWS=false OSGRAYTRACE_FRAME_BUDGET=0
export OSGRAYTRACE_TEST_FRAMES=${OSGRAYTRACE_TEST_FRAMES:-30}
mkdir -p "$OUT/models"
OSG_NOTIFY_LEVEL=FATAL "$BUILD/bin/clientModels" "$OUT/models" || { echo "no models" >&2; exit 2; }

running=0
for name in "${NAMES[@]}"; do
    client "$name" &
    running=$((running + 1))
    [ $running -lt $JOBS ] || { wait -n; running=$((running - 1)); }
done
wait
write_table >"$OUT/index.html"
echo "$OUT/index.html"

ran=0
for name in "${NAMES[@]}"; do
    case $(cat "$OUT/$name/verdict") in
    right) ran=1 ;;
    skipped | "not installed") ;;
    *) exit 1 ;;
    esac
done
[ $ran = 1 ] || exit 77
