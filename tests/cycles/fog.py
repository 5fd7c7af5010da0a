# fog.py - how much noise fog has beside that of Blender's Cycles: data/cornell_box_fog.osgt.
# SPDX-License-Identifier: MIT
"""See noise.py for the table."""
import sys

import noise

sys.exit(noise.compare(__doc__, "cornell_box_fog.osgt", "fogInBlender.py", {}))
