# smoke.py - how much noise smoke has beside that of Blender's Cycles: 256 cubed voxels in a sky.
# SPDX-License-Identifier: MIT
"""See noise.py for the table. Needs Debian's python3-openvdb, which writes the file of smoke."""
import sys

import cloud
import noise

OPTIONS = noise.parseArguments(__doc__, "smoke")
noise.needBlender()
VOLUME, SCENE, SKY = cloud.write(OPTIONS)
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
