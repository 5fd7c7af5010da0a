# cloud.py - smoke of 256 cubed voxels in the unit cube, for scripts that compare renderers.
# SPDX-License-Identifier: MIT
import os
import sys

import numpy

import noise
import sky

SIDE, EXTINCTION, ALBEDO, ANISOTROPY = 256, 40.0, 0.95, 0.3
EYE = (0.5, -1.9, 0.5)  # looks along +y, with z up
FOVY = 30.0


def smoke():
    """Returns densities from 0 to 1 of a cloud in the unit cube: noise whose spectrum falls with
    the 2.2nd power of the frequency, above a threshold that rises outwards."""
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


def write(options):
    """Writes the smoke, a sky and the scene of both into the folder of the options. Returns the
    files of the smoke, of the scene and of the sky. Ends the script, with 77, if there is no
    pyopenvdb."""
    try:
        import pyopenvdb
    except ImportError:
        print("skipped: there is no pyopenvdb; Debian has it in the package python3-openvdb")
        sys.exit(77)
    volume, scene, sky_file = (
        os.path.join(os.path.abspath(options.out), name)
        for name in ("smoke.vdb", "smoke.osgb", "sky.hdr")
    )
    grid = pyopenvdb.FloatGrid()
    grid.copyFromArray(smoke())
    grid.transform = pyopenvdb.createLinearTransform(1.0 / SIDE)
    grid.gridClass, grid.name = pyopenvdb.GridClass.FOG_VOLUME, "density"
    pyopenvdb.write(volume, grids=[grid])
    sky.write(sky_file, sky.outdoors())
    noise.run(
        ["osgconv", "-O", f"extinction={EXTINCTION}", volume, scene],
        scene + ".log",
        env=noise.libraries(options.build),
    )
    return volume, scene, sky_file


def view():
    """Returns the arguments of osgraytrace."""
    center = [str(x) for x in (EYE[0], 0.5, EYE[2])]
    eye = [str(x) for x in EYE]
    return ["--fovy", str(FOVY), "--up", "0", "0", "1", "--eye", *eye, "--center", *center]
