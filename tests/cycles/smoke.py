# smoke.py - how much noise smoke has beside that of Blender's Cycles: 256 cubed voxels in a sky.
# SPDX-License-Identifier: MIT
"""See noise.py for the table. Needs Debian's python3-openvdb, which writes the file of smoke."""
import os
import sys

import cloud
import noise
import sky

OPTIONS = noise.parseArguments(__doc__, "smoke")
noise.needBlender()
try:
    import pyopenvdb
except ImportError:
    print("skipped: there is no pyopenvdb; Debian has it in the package python3-openvdb")
    sys.exit(77)
FOLDER = os.path.abspath(OPTIONS.out)
VOLUME, SCENE, SKY = (os.path.join(FOLDER, name) for name in ("smoke.vdb", "smoke.osgb", "sky.hdr"))
cloud.write(VOLUME, pyopenvdb)
sky.write(SKY, sky.outdoors())
noise.run(
    ["osgconv", "-O", f"extinction={cloud.EXTINCTION}", VOLUME, SCENE],
    SCENE + ".log",
    env=noise.libraries(OPTIONS.build),
)
TASK = {
    "script": "smokeInBlender.py",
    "bounces": 64,
    "volume": VOLUME,
    "sky": SKY,
    "extinction": cloud.EXTINCTION,
    "albedo": cloud.ALBEDO,
    "anisotropy": cloud.ANISOTROPY,
    "eye": cloud.EYE,
    "ours": ["--environment", SKY, *cloud.view()],
}
sys.exit(noise.compare(OPTIONS, SCENE, TASK))
