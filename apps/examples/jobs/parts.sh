#!/bin/sh
# parts.sh - a part of a picture for each task of a Slurm array, without MPI; the tasks may run at any time.
# SPDX-License-Identifier: MIT
#SBATCH --array 0-63
#SBATCH --requeue
#SBATCH --signal USR1@60
# With Slurm:    sbatch parts.sh MODEL NAME PASSES_OF_A_TASK
# Without Slurm: for n in 0 1 2 3; do PART=$n ./parts.sh MODEL NAME PASSES_OF_A_TASK; done
# At the end:    osgraytrace --merge NAME.part*.exr -o NAME.exr
set -eu
model=$1 name=$2 passes=$3
shift 3
n=${SLURM_ARRAY_TASK_ID:-$PART}
exec osgraytrace "$model" --passes $((n * passes)):$(((n + 1) * passes)) --checkpoint "$name.part$n.exr" "$@"
