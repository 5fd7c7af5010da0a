#!/bin/sh
# picture.sh - one picture by all nodes of a Slurm job, which goes on from its checkpoint if it is requeued.
# SPDX-License-Identifier: MIT
#SBATCH --nodes 16
#SBATCH --ntasks-per-node 1
#SBATCH --exclusive
#SBATCH --requeue
#SBATCH --signal USR1@60
# With Slurm:    sbatch picture.sh MODEL NAME --passes 4096
# Without Slurm: LAUNCH="mpirun -n 2 --bind-to none" ./picture.sh MODEL NAME --passes 4096
# With Open MPI's mpirun a job with a dead rank is over at once, and SIGUSR1 to mpirun ends it with a checkpoint.
set -eu
export OMPI_MCA_odls_base_sigkill_timeout=0
model=$1 name=$2
shift 2
exec ${LAUNCH:-srun --mpi=pmix} osgraytrace "$model" --mpi --checkpoint "$name.part.exr" -o "$name.exr" "$@"
