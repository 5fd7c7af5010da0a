#!/usr/bin/env python3
# efficiency.py - passes of osgraytrace a second of processor time: with a launcher of ranks over one process.
# SPDX-License-Identifier: MIT
# Processor time counts what ranks lose to each other, and next to nothing of what else a busy machine does.
# Usage: efficiency.py OSGRAYTRACE MODEL SECONDS ROUNDS RANKS LAUNCHER..., as mpirun -n 2 --bind-to none
import json
import os
import statistics
import subprocess
import sys
import tempfile

program, model, seconds, rounds, ranks = sys.argv[1:6]
launcher = sys.argv[6:]


# Each process adds the time that it has used: daemons of a launcher are no children of this one.
WRAPPER = """#!/bin/bash
TIMEFORMAT="%U %S"
exec 3>&2
{ time "$@" 2>&3; } 2>> "$(dirname "$0")/used"
"""


def passes_a_second(launch, more):
    """Runs osgraytrace for a time; returns passes over the processor time of all its processes."""
    with tempfile.TemporaryDirectory() as folder:
        stats = os.path.join(folder, "stats.json")
        wrapper = os.path.join(folder, "timed")
        with open(wrapper, "w") as file:
            file.write(WRAPPER)
        os.chmod(wrapper, 0o755)
        subprocess.run(launch + [wrapper, program, model, "--size", "1280", "720", "--integrator", "path", "--passes",
                                 "1000000", "--time", seconds, "--checkpoint", os.path.join(folder, "sums.exr"),
                                 "--interval", "30", "--stats", stats] + more, check=True, stdout=subprocess.DEVNULL)
        with open(os.path.join(folder, "used")) as file:
            used = sum(float(word) for word in file.read().split())
        with open(stats) as file:
            return json.load(file)["passes"] / used


ratios = []
for _ in range(int(rounds)):
    alone = passes_a_second([], ["--threads", ranks])
    together = passes_a_second(launcher, ["--threads", "1", "--mpi"])
    ratios.append(together / alone)
    print(f"one process {alone:.4f}, {ranks} ranks {together:.4f} passes a second: {ratios[-1]:.3f}", flush=True)
print(f"median {statistics.median(ratios):.3f}")
