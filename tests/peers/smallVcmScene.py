# smallVcmScene.py - writes a scene for a SmallVCM that was taught to read scenes.
# SPDX-License-Identifier: MIT
"""SmallVCM has its scenes in its code. A patched one takes FILE ALGORITHM ITERATIONS SEED LENGTH
PICTURE.pfm RADIUS as arguments, LENGTH the longest path in edges. The file has numbers alone: the
size; position, direction and up of the camera, and its angle; a number of triangles, each with
three points and its diffuse colour; a number of triangles that shine to their front, each with
three points and radiance. See sceneFile.py for what a scene is."""
import numpy

import sceneFile


def triangles(points, indices, color):
    return [numpy.concatenate([*numpy.array(points)[row], color]) for row in indices]


def write(file, scene, size):
    """Writes a scene whose materials are diffuse."""
    view = scene["view"]
    camera = [size, *view["eye"], *(view["center"] - view["eye"]), *view["up"], view["fovy"]]
    surfaces, lamps = [], []
    for part in scene["parts"]:
        surfaces += triangles(part["points"], part["triangles"], part["material"]["color"])
    for corner, u, v, radiance in scene["lamps"]:
        corners = (corner, corner + u, corner + u + v, corner + v)
        lamps += triangles(corners, ([0, 1, 2], [0, 2, 3]), radiance)
    with open(file, "w", encoding="utf-8") as out:
        out.write(sceneFile.text(camera) + "\n")
        for rows in (surfaces, lamps):
            out.write("\n".join([str(len(rows)), *map(sceneFile.text, rows)]) + "\n")
