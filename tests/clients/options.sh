# options.sh - reads the command line of run.sh and times.sh, which source this file: --build, an option of the
# script's own, whose name is OPTION and whose value is VALUE, and names of programs.
# SPDX-License-Identifier: MIT
BUILD=$HERE/../../build/release
NAMES=()
while [ $# -gt 0 ]; do
    case $1 in
    --build) BUILD=$2; shift 2 ;;
    "--$OPTION") VALUE=$2; shift 2 ;;
    -*) sed -n '2,/^# SPDX/{/^# SPDX/!s/^# //p}' "$0" >&2; exit 2 ;;
    *) NAMES+=("$1"); shift ;;
    esac
done
BUILD=$(cd "$BUILD" && pwd) || exit 2
