#!/bin/sh
# simulate.sh - builds the simulated cluster and runs it; without SimGrid it says so and ends with 77.
# SPDX-License-Identifier: MIT
# Usage: simulate.sh BUILD_FOLDER RANKS IDEAL_SECONDS PASS_SECONDS [FILM_MEGABYTES [GBIT_PER_SECOND]]
set -eu
for program in smpicxx smpirun; do
    command -v $program > /dev/null || { echo "$program is not there (Debian: libsimgrid-dev): skipped"; exit 77; }
done
[ $# -ge 4 ] || { sed -n 's/^# Usage: //p' "$0"; exit 1; }
source=$(cd "$(dirname "$0")/../.." && pwd)
build=$1 ranks=$2 ideal=$3 pass=$4 film=${5:-133} rate=${6:-10}
mkdir -p "$build"
cd "$build"

program=simulatedCluster
files="tests/cluster/SimulatedCluster.cpp apps/group/Coordinator.cpp apps/group/GroupMessage.cpp
    apps/group/Launcher.cpp apps/group/MpiGroup.cpp apps/group/PassLeases.cpp
    osgRayTrace/film/PassSet.cpp osgRayTrace/film/PassSums.cpp osgRayTrace/film/Film.cpp osgRayTrace/film/ExactSums.cpp"
newer=$(cd "$source" && for f in $files; do [ ! -e "$build/$program" ] || [ "$f" -nt "$build/$program" ] && echo "$f"; done || true)
if [ -n "$newer" ]; then
    (cd "$source" && smpicxx -std=c++17 -O2 -DNDEBUG -I. $files -o "$build/$program.new")
    mv $program.new $program
fi

# A switch that carries what all machines send at once: each has a full-duplex line to it.
last=$((ranks - 1))
cat > cluster.xml << END
<?xml version='1.0'?>
<!DOCTYPE platform SYSTEM "https://simgrid.org/simgrid.dtd">
<platform version="4.1">
  <cluster id="cluster" prefix="n" suffix="" radical="0-$last" speed="1Gf" bw="${rate}Gbps" lat="25us"/>
</platform>
END
i=0
while [ $i -lt "$ranks" ]; do echo n$i; i=$((i + 1)); done > hosts

# Only stated times count: neither the time of this machine nor of a look for messages.
smpirun -np "$ranks" -hostfile hosts -platform cluster.xml -no-privatize \
    --cfg=smpi/simulate-computation:no --cfg=smpi/iprobe:1e-7 --cfg=smpi/test:1e-7 \
    --cfg=smpi/coll-selector:ompi --cfg=contexts/stack-size:1024 --log=root.thres:warning \
    ./$program "$ideal" "$pass" "$film"
