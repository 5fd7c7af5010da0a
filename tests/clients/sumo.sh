#!/usr/bin/env bash
# sumo.sh - SUMO's 3D view (Debian's package sumo) of a small town with three parked cars.
# SPDX-License-Identifier: MIT
command -v sumo-gui netgenerate >/dev/null || exit 77
export HOME=$PWD # SUMO keeps its windows' places there
(unset LD_PRELOAD
 netgenerate --grid --grid.number 2 --grid.length 60 --seed 1 --output-file town.net.xml >/dev/null 2>&1) || exit 77
car() { echo "<trip id='$1' type='car' depart='0' departPos='stop' from='$2' to='$3'><stop edge='$2' endPos='30' duration='900'/></trip>"; }
{
    echo '<routes><vType id="car"/>'
    car one A0A1 B1B0
    car two A1B1 B0A0
    car three B0A0 A1B1
    echo '</routes>'
} >cars.rou.xml
# The simulation ends by itself, and its window with it.
exec sumo-gui --osg-view -n town.net.xml -r cars.rou.xml --start --quit-on-end --end 40 --delay 200 \
    --window-size 400,600 --window-pos 0,0
