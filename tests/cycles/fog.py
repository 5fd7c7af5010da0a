# fog.py - how much noise fog has beside that of Blender's Cycles: data/cornell_box_fog.osgt.
# SPDX-License-Identifier: MIT
"""See noise.py for the table."""
import sys

import noise

OPTIONS = noise.parseArguments(__doc__, "fog")
TASK = {"script": "fogInBlender.py"}
sys.exit(noise.compare(OPTIONS, noise.inData("cornell_box_fog.osgt"), TASK))
