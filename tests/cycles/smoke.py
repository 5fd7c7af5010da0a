# smoke.py - how much noise smoke has beside that of Blender's Cycles: 256 cubed voxels in a sky.
# SPDX-License-Identifier: MIT
"""See noise.py for the table. Needs Debian's python3-openvdb, which writes the file of smoke."""
import os
import sys

import noise
import numpy
import sky

SIDE, EXTINCTION = 256, 40.0
EYE = (0.5, -1.9, 0.5)


def smoke():
    """Returns densities from 0 to 1 of a cloud in the unit cube: noise whose spectrum falls with the
    2.2nd power of the frequency, above a threshold that rises outwards."""
    numbers = numpy.random.default_rng(7)
    frequency = numpy.fft.fftfreq(SIDE)
    x, y, z = numpy.meshgrid(frequency, frequency, numpy.fft.rfftfreq(SIDE), indexing="ij")
    squared = x * x + y * y + z * z
    power = numpy.where(squared < (2.5 / SIDE) ** 2, 0, numpy.maximum(squared, 1e-9) ** -1.1)
    white = numpy.fft.rfftn(numbers.standard_normal((SIDE,) * 3))
    field = numpy.fft.irfftn(white * power, (SIDE,) * 3)
    field /= field.std()
    at = (numpy.arange(SIDE) + 0.5) / SIDE * 2 - 1
    x, y, z = numpy.meshgrid(at, at, at, indexing="ij")
    density = 1.2 + 0.6 * field - 2 * numpy.sqrt(x * x + y * y + z * z)
    density[numpy.maximum(abs(x), numpy.maximum(abs(y), abs(z))) > 0.97] = 0
    return numpy.clip(density, 0, 1).astype(numpy.float32)


def write(file):
    grid = pyopenvdb.FloatGrid()
    grid.copyFromArray(smoke())
    grid.transform = pyopenvdb.createLinearTransform(1.0 / SIDE)
    grid.gridClass, grid.name = pyopenvdb.GridClass.FOG_VOLUME, "density"
    pyopenvdb.write(file, grids=[grid])


OPTIONS = noise.parseArguments(__doc__, "smoke")
noise.needBlender()
try:
    import pyopenvdb
except ImportError:
    print("skipped: there is no pyopenvdb; Debian has it in the package python3-openvdb")
    sys.exit(77)
FOLDER = os.path.abspath(OPTIONS.out)
VOLUME, SCENE, SKY = (os.path.join(FOLDER, name) for name in ("smoke.vdb", "smoke.osgb", "sky.hdr"))
write(VOLUME)
sky.write(SKY, sky.outdoors())
noise.run(
    ["osgconv", "-O", f"extinction={EXTINCTION}", VOLUME, SCENE],
    SCENE + ".log",
    env=noise.libraries(OPTIONS),
)
TASK = {
    "script": "smokeInBlender.py",
    "bounces": 64,
    "volume": VOLUME,
    "sky": SKY,
    "extinction": EXTINCTION,
    "albedo": 0.95,
    "anisotropy": 0.3,
    "eye": EYE,
    "ours": ["--environment", SKY, "--fovy", "30", "--up", "0", "0", "1", "--eye"]
    + [str(x) for x in EYE]
    + ["--center"]
    + [str(x) for x in (EYE[0], 0.5, EYE[2])],
}
sys.exit(noise.compare(OPTIONS, SCENE, TASK))
