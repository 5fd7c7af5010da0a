# mediumFog.py - how much noise fog in the Cornell box has beside that of pbrt-v3's volpath.
# SPDX-License-Identifier: MIT
"""See mediumTable.py for the table. Values that repeat those of data/generator/CornellBox.cpp and
CornellBoxTable.h are marked with their names."""
import os
import sys

import mediumTable
import noise
import numpy
import objParts
import pbrtMedia

# CornellBox.cpp
EYE, CENTER, UP, FOVY = (278, 278, -800), (278, 278, 0), (0, 1, 0), 39.3
DENSITY, SCATTERED, ANISOTROPY = 0.69314718 / 560, 0.95, 0.3
# CornellBoxTable.h
WALLS = {"right wall": (0.12, 0.45, 0.15), "left wall": (0.65, 0.05, 0.05)}
WHITE = (0.73, 0.73, 0.73)
LAMP = ((343, 548.8, 227), (343, 548.8, 332), (213, 548.8, 332), (213, 548.8, 227))
RADIANCE = (17, 12, 4)
BALL = (278, 274.4, 279.6), 480.5  # around the scene: the fog ends there
BOUNCES = 32

RIGHT = numpy.cross(numpy.subtract(CENTER, EYE) / 800.0, UP)
TURN = numpy.array([RIGHT, numpy.subtract(CENTER, EYE) / 800.0, UP])  # the scene's transform


def world(parts):
    sigma = [(1 - SCATTERED) * DENSITY] * 3, [SCATTERED * DENSITY] * 3
    text = (
        'MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" '
        f'{pbrtMedia.words(sigma[0])} "rgb sigma_s" {pbrtMedia.words(sigma[1])} '
        f'"float g" [{ANISOTROPY}]\n'
    )
    center = " ".join(str(x) for x in TURN @ BALL[0])
    ball = f'Translate {center}\nShape "sphere" "float radius" [{BALL[1]}]\n'
    text += pbrtMedia.boundary("fog", ball) + 'MediumInterface "fog" "fog"\n'
    for name, (points, faces) in parts.items():
        if "MatrixTransform" in name:
            continue  # the square of the lamp
        color = next((WALLS[wall] for wall in WALLS if wall in name), WHITE)
        text += f'Material "matte" "rgb Kd" {pbrtMedia.words(color)}\n'
        text += pbrtMedia.mesh(points, faces)
    lamp = pbrtMedia.mesh([TURN @ corner for corner in LAMP], [(0, 1, 2, 3)])
    text += 'AttributeBegin\nMaterial "matte" "rgb Kd" [0 0 0]\n'  # lamps of ours reflect nothing
    text += f'AreaLightSource "diffuse" "rgb L" {pbrtMedia.words(RADIANCE)}\n'
    return text + lamp + "AttributeEnd\n"


OPTIONS = noise.parseArguments(__doc__, "fog", "pbrt")
noise.need(OPTIONS.pbrt, "--pbrt names the program of pbrt-v3")
noise.needBlender()
SCENE = noise.inData("cornell_box_fog.osgt")
OBJ = os.path.abspath(os.path.join(OPTIONS.out, "scene.obj"))
noise.run(["osgconv", SCENE, OBJ], OBJ + ".log", env=noise.libraries(OPTIONS.build))
VIEW = {"eye": TURN @ EYE, "center": TURN @ CENTER, "up": TURN @ UP, "fovy": FOVY}
RENDERERS = {
    "pbrt": pbrtMedia.renderer(world(objParts.readParts(OBJ)), VIEW, OPTIONS, BOUNCES),
    "ours": mediumTable.ours(SCENE, OPTIONS, BOUNCES + 1, "--integrator", "path"),
}
sys.exit(mediumTable.compare(OPTIONS, RENDERERS))
