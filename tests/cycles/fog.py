# fog.py - how much noise fog has beside that of Blender's Cycles: data/cornell_box_fog.osgt.
# SPDX-License-Identifier: MIT
"""See noise.py for the table. Cycles' picture is darker by 1 to 2 %, as its paths end earlier."""
import sys

import noise

OPTIONS = noise.parseArguments(__doc__, "fog")
TASK = {"script": "fogInBlender.py"}
sys.exit(noise.compare(OPTIONS, noise.inData("cornell_box_fog.osgt"), TASK, tolerance=0.03))
