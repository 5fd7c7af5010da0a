# mediumSmoke.py - how much noise smoke in a sky has beside that of pbrt-v3's volpath.
# SPDX-License-Identifier: MIT
"""See mediumTable.py for the table. Both get the same 256 cubed voxels. Needs Debian's
python3-openvdb, too."""
import sys

import mediumTable
import noise
import numpy
import pbrtMedia

import cloud  # isort: skip
import sky  # isort: skip

DEPTH = 256


def radianceOf(file):
    """Returns what is stored in a picture that sky.write has written, and other renderers read."""
    with open(file, "rb") as data:
        pixels = numpy.frombuffer(data.read()[-4 * sky.WIDTH * sky.HEIGHT :], numpy.uint8)
    pixels = pixels.reshape(sky.HEIGHT, sky.WIDTH, 4).astype(float)
    return (pixels[..., :3] + 0.5) * numpy.exp2(pixels[..., 3:] - 136)


def writeSky(file, picture):
    """Writes a .pfm for pbrt, whose columns go around z from +x anticlockwise; ours have +y in the
    middle and go clockwise."""
    columns = (3 * sky.WIDTH // 4 - 1 - numpy.arange(sky.WIDTH)) % sky.WIDTH
    turned = picture[::-1, columns].astype("<f4")
    with open(file, "wb") as out:
        out.write(f"PF\n{sky.WIDTH} {sky.HEIGHT}\n-1\n".encode())
        out.write(turned.tobytes())


def world(sky_file):
    side = cloud.SIDE
    # A voxel of OpenVDB has its middle at a whole number, one of pbrt at a half.
    low, high = -0.5 / side, 1 - 0.5 / side
    density = cloud.smoke().transpose(2, 1, 0)
    values = " ".join("0" if value == 0 else f"{value:.5g}" for value in density.ravel())
    absorbed, scattered = ((1 - cloud.ALBEDO) * cloud.EXTINCTION, cloud.ALBEDO * cloud.EXTINCTION)
    cube = [(x, y, z) for z in (low, high) for y in (low, high) for x in (low, high)]
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return (
        f'LightSource "infinite" "string mapname" ["{sky_file}"]\n'
        'MakeNamedMedium "smoke" "string type" "heterogeneous" '
        f'"rgb sigma_a" {pbrtMedia.words([absorbed] * 3)} '
        f'"rgb sigma_s" {pbrtMedia.words([scattered] * 3)} "float g" [{cloud.ANISOTROPY}] '
        f'"integer nx" [{side}] "integer ny" [{side}] "integer nz" [{side}] '
        f'"point p0" {pbrtMedia.words([low] * 3)} "point p1" {pbrtMedia.words([high] * 3)} '
        f'"float density" [{values}]\n' + pbrtMedia.boundary("smoke", pbrtMedia.mesh(cube, sides))
    )


OPTIONS = noise.parseArguments(__doc__, "smoke", "pbrt")
noise.need(OPTIONS.pbrt, "--pbrt names the program of pbrt-v3")
noise.needBlender()
_, SCENE, SKY = cloud.write(OPTIONS)
writeSky(SKY + ".pfm", radianceOf(SKY))
VIEW = {"eye": cloud.EYE, "center": (0.5, 0.5, 0.5), "up": (0, 0, 1), "fovy": cloud.FOVY}
OURS = ["--integrator", "path", "--environment", SKY, *cloud.view()]
RENDERERS = {
    "pbrt": pbrtMedia.renderer(world(SKY + ".pfm"), VIEW, OPTIONS, DEPTH),
    "ours": mediumTable.ours(SCENE, OPTIONS, DEPTH, *OURS),
}
sys.exit(mediumTable.compare(OPTIONS, RENDERERS))
