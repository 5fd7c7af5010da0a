# blinds.py - how much noise sunbeams through blinds have beside those of Blender's Cycles.
# SPDX-License-Identifier: MIT
"""See noise.py for the table. A room of 4 x 4 x 3 m is full of haze. One of its walls is a blind,
with a sun without a size behind it."""
import math
import os
import sys

import noise

sys.path.insert(0, os.path.join(noise.HERE, "../peers"))
import osgText  # noqa: E402

ALBEDO, SUN, COLOR = 0.5, (-0.8, 0.1, 0.55), 10.0
FOG = ((0, 0, 1.5), 4.0, 0.12, 0.006, 0.4)  # centre, radius, scattering, absorption, anisotropy
VIEW = {"eye": (1.7, -1.8, 1.5), "center": (-0.9, 0.6, 1.2), "up": (0, 0, 1), "fovy": 70.0}


def slat(height):
    """Returns a slat of the blind, turned by 20 degrees."""
    half, rise = 0.1, 0.1 * math.tan(math.radians(20))
    return [
        (-2 - half, -2, height - rise),
        (-2 - half, 2, height - rise),
        (-2 + half, 2, height + rise),
        (-2 + half, -2, height + rise),
    ]


def room():
    """Returns floor, ceiling, three walls and the slats."""
    low = [(-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0)]
    high = [(x, y, 3) for x, y, _ in low]
    sides = [[low[k], low[k + 1], high[k + 1], high[k]] for k in range(3)]
    return [low, high[::-1], *sides, *[slat(0.1 + 0.28 * k) for k in range(11)]]


OPTIONS = noise.parseArguments(__doc__, "blinds")
noise.needBlender()
SCENE = os.path.abspath(os.path.join(OPTIONS.out, "blinds.osgt"))
MEDIUM = osgText.medium(*FOG[2:])
osgText.write(
    SCENE,
    [
        osgText.quads("room", room(), [ALBEDO] * 3),
        osgText.light((*SUN, 0), [COLOR] * 3),
        osgText.fog(*FOG[:2], MEDIUM),
    ],
)
OURS = ["--fovy", str(VIEW["fovy"])]
for name in ("eye", "center", "up"):
    OURS += ["--" + name, *[str(x) for x in VIEW[name]]]
TASK = {
    "script": "blindsInBlender.py",
    "view": VIEW,
    "quads": room(),
    "albedo": ALBEDO,
    "sun": (SUN, math.pi * COLOR),
    "fog": FOG,
    "ours": OURS,
}
sys.exit(noise.compare(OPTIONS, SCENE, TASK))
