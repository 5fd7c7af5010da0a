# wax.py - how much noise paths below surfaces have beside those of Blender's Cycles: data/wax.osgt.
# SPDX-License-Identifier: MIT
"""See noise.py for the table. The bust is counted alone, too: Cycles' is 5 to 7 % brighter."""
import sys

import noise
import numpy

CYCLES_RADIUS = 12.56637  # RANDOM_WALK_FIXED_RADIUS takes 1 / (4 pi) of a radius as the mean way


def onBust(size):
    """Returns which pixels are well within the head and the chest: two ellipses."""
    y, x = (numpy.mgrid[0:size, 0:size] + 0.5) / size
    head = ((x - 0.5) / 0.11) ** 2 + ((y - 0.7) / 0.13) ** 2 < 1
    return head | (((x - 0.5) / 0.22) ** 2 + ((y - 0.33) / 0.1) ** 2 < 1)


OPTIONS = noise.parseArguments(__doc__, "wax")
TASK = {
    "script": "waxInBlender.py",
    "method": "RANDOM_WALK_FIXED_RADIUS",
    "radius": CYCLES_RADIUS,
}
sys.exit(noise.compare(OPTIONS, noise.inData("wax.osgt"), TASK, {"bust": onBust}, tolerance=0.09))
