# fogInBlender.py - renders data/cornell_box_fog.osgt with Blender's Cycles; fog.py starts it there.
# SPDX-License-Identifier: MIT
"""See blenderScene.py. Values that repeat those of data/generator/CornellBox.cpp and
CornellBoxTable.h are marked with their names."""
import os
import sys

import bpy
from mathutils import Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import blenderScene  # noqa: E402

# CornellBox.cpp
VIEW = {
    "eye": Vector((278, 278, -800)),
    "center": Vector((278, 278, 0)),
    "up": Vector((0, 1, 0)),
    "fovy": 39.3,
}
DENSITY, SCATTERED, ANISOTROPY = 0.69314718 / 560, 0.95, 0.3
# CornellBoxTable.h
WALLS = {"right wall": (0.12, 0.45, 0.15), "left wall": (0.65, 0.05, 0.05)}
WHITE = (0.73, 0.73, 0.73)
LAMP = ((343, 548.8, 227), (0, 0, 105), (-130, 0, 0), (17, 12, 4))


def addBox(task):
    for name, (points, faces) in blenderScene.readParts(task["obj"]).items():
        if "MatrixTransform" in name:
            continue  # the square of the lamp
        color = next((WALLS[wall] for wall in WALLS if wall in name), WHITE)
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(points, [], faces)
        mesh.materials.append(blenderScene.diffuse(name, color))
        bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))


def addFog():
    """Adds a ball of fog around the box, as ours ends at a sphere around the scene."""
    center = blenderScene.turnOf(VIEW) @ Vector((278, 274.4, 279.6))
    bpy.ops.mesh.primitive_ico_sphere_add(radius=490, location=center, subdivisions=5)
    material = bpy.data.materials.new("fog")
    blenderScene.fillWithFog(
        material, SCATTERED * DENSITY, (1 - SCATTERED) * DENSITY, ANISOTROPY
    )
    bpy.context.object.data.materials.append(material)


def addScene(task):
    addBox(task)
    addFog()
    blenderScene.addLamp(VIEW, *LAMP, seen=True)
    return VIEW


blenderScene.run(addScene)
