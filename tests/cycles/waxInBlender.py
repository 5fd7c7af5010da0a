# waxInBlender.py - renders data/wax.osgt with Blender's Cycles; wax.py starts it in Blender.
# SPDX-License-Identifier: MIT
"""The task has a radius and a method beside what blenderScene.py wants. Values that repeat those of
data/generator/WaxBust.cpp are marked with its name."""
import os
import sys

import bpy
from mathutils import Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import blenderScene  # noqa: E402

# WaxBust.cpp
VIEW = {
    "eye": Vector((-11, -44, 15)),
    "center": Vector((0, 0, 9.2)),
    "up": Vector((0, 0, 1)),
    "fovy": 25.0,
}
WAX = {"color": (0.93, 0.75, 0.52), "radius": (0.5, 0.28, 0.16), "ior": 1.45, "roughness": 0.4}
DIFFUSE = {"table": (0.2, 0.16, 0.13), "wall": (0.16, 0.19, 0.24), "socle": (0.1, 0.1, 0.11)}
LAMPS = [
    ((5, 14, 22), (6, 0, 0), (0, -4, 4.5), (110, 100, 86)),
    ((-40, -30, 20), (0, 0, 20), (16, -16, 0), (2.2, 2.4, 2.8)),
]


def wax(task):
    material = bpy.data.materials.new("wax")
    material.use_nodes = True
    surface = material.node_tree.nodes["Principled BSDF"]
    surface.subsurface_method = task["method"]
    inputs = surface.inputs
    inputs["Base Color"].default_value = (*WAX["color"], 1)
    inputs["Subsurface"].default_value = 1
    inputs["Subsurface Color"].default_value = (*WAX["color"], 1)
    inputs["Subsurface Radius"].default_value = [task["radius"] * r for r in WAX["radius"]]
    inputs["Subsurface IOR"].default_value = WAX["ior"]
    inputs["Subsurface Anisotropy"].default_value = 0
    inputs["Specular"].default_value = ((WAX["ior"] - 1) / (WAX["ior"] + 1)) ** 2 / 0.08
    inputs["IOR"].default_value = WAX["ior"]
    inputs["Roughness"].default_value = WAX["roughness"]
    return material


def addParts(task):
    for name, (points, faces) in blenderScene.readParts(task["obj"]).items():
        known = [it for it in (*DIFFUSE, "bust_Geometry") if "bust_" + it in name]
        if not known:
            continue  # the squares of lamps
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(points, [], faces)
        isWax = known[0] == "bust_Geometry"
        mesh.materials.append(wax(task) if isWax else blenderScene.diffuse(name, DIFFUSE[known[0]]))
        mesh.polygons.foreach_set("use_smooth", [isWax] * len(mesh.polygons))
        bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))


def addScene(task):
    addParts(task)
    for lamp in LAMPS:
        blenderScene.addLamp(VIEW, *lamp)
    return VIEW


blenderScene.run(addScene)
