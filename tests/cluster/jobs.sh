#!/bin/sh
# jobs.sh - the job files of apps/examples/jobs, run by mpirun and by the shell, make the picture of one process.
# SPDX-License-Identifier: MIT
# Usage: jobs.sh OSGRAYTRACE MODEL JOBS_FOLDER; without mpirun it says so and ends with 77.
set -eu
command -v mpirun > /dev/null || { echo "mpirun is not there: skipped"; exit 77; }
program=$1 model=$2 jobs=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
PATH=$(dirname "$program"):$PATH
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
view="--size 60 40 --integrator path --light-samples 1"
# shellcheck disable=SC2086
osgraytrace "$model" $view --passes 24 --checkpoint one.exr > /dev/null
LAUNCH="mpirun --oversubscribe -n 3 --bind-to none" "$jobs/picture.sh" "$model" ranks $view --passes 24
for n in 2 0 1; do PART=$n "$jobs/parts.sh" "$model" array 8 $view; done
osgraytrace --merge array.part*.exr --checkpoint array.exr
cmp one.exr ranks.part.exr
cmp one.exr array.exr
