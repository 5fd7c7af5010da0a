# mediumFlights.py - the noise of a lamp in fog with points along rays by angle and by free flights.
# SPDX-License-Identifier: MIT
"""Free flights take another build of osgRayTrace: docs/media.md has the lines that it differs by.
Its folder is the argument --flights; without it the program ends with 77."""
import os
import sys

import mediumTable
import noise
import osgText

parser = noise.argparse.ArgumentParser(description=__doc__)
parser.add_argument("--build", default=os.path.join(noise.HERE, "../../build/release"))
parser.add_argument("--flights", help="a build with free flights")
parser.add_argument("--out", default="out/flights")
parser.add_argument("--size", type=int, default=100)
parser.add_argument("--reference", type=int, default=1024)
OPTIONS = parser.parse_args()
if not OPTIONS.flights:
    print("skipped: there is no build with free flights; --flights names its folder")
    sys.exit(77)
noise.needBlender()
os.makedirs(OPTIONS.out, exist_ok=True)
VIEW = ["--eye", "0", "0", "0", "--center", "1", "0", "0", "--up", "0", "0", "1", "--fovy", "40"]
for extinction, intensity, bounces in ((0.1, 100, 1), (0.1, 100, 9), (1, 1000, 1)):
    scene = os.path.abspath(os.path.join(OPTIONS.out, "lamp.osgt"))
    wall = [(10, -20, -20), (10, 20, -20), (10, 20, 20), (10, -20, 20)]
    fog = osgText.medium(extinction, 0, 0)
    lamp = osgText.light((5, 1, 0.3, 1), [intensity / 3.14159265] * 3)
    osgText.write(
        scene,
        [osgText.quads("wall", [wall], [0.5] * 3), lamp, osgText.fog((0, 0, 0), 40, fog)],
    )
    arguments = ["--integrator", "path", *VIEW]

    def flights(how):
        return mediumTable.ours(
            scene, OPTIONS, bounces, *arguments, build=OPTIONS.flights, environment={"NEAR": how}
        )

    print(f"extinction {extinction}, max-bounces {bounces}")
    RENDERERS = {
        "flights": flights("plain"),
        "flights that collide": flights("f"),
        "ours": mediumTable.ours(scene, OPTIONS, bounces, *arguments),
    }
    mediumTable.compare(OPTIONS, RENDERERS, one_reference=True)
