# blindsInBlender.py - renders the blinds of blinds.py with Cycles; blinds.py starts it in Blender.
# SPDX-License-Identifier: MIT
"""The task has view, quads (lists of four corners), albedo, sun (towards it, irradiance), fog
(centre, radius, scattering, absorption, anisotropy) beside what blenderScene.py wants. z is up."""
import os
import sys

import bpy
from mathutils import Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import blenderScene  # noqa: E402


def addQuads(task, turn):
    points = [turn @ Vector(point) for quad in task["quads"] for point in quad]
    mesh = bpy.data.meshes.new("room")
    faces = [tuple(range(first, first + 4)) for first in range(0, len(points), 4)]
    mesh.from_pydata(points, [], faces)
    mesh.materials.append(blenderScene.diffuse("room", (task["albedo"],) * 3))
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("room", mesh))


def addSun(task, turn):
    towards, irradiance = task["sun"]
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy, sun.angle = irradiance, 0
    placed = bpy.data.objects.new("sun", sun)
    placed.rotation_mode = "QUATERNION"
    placed.rotation_quaternion = (turn @ Vector(towards)).to_track_quat("Z", "Y")
    bpy.context.scene.collection.objects.link(placed)


def addFog(task, turn):
    center, radius, scattering, absorption, anisotropy = task["fog"]
    bpy.ops.mesh.primitive_ico_sphere_add(
        radius=radius, location=turn @ Vector(center), subdivisions=5
    )
    material = bpy.data.materials.new("fog")
    blenderScene.fillWithFog(material, scattering, absorption, anisotropy)
    bpy.context.object.data.materials.append(material)


def addScene(task):
    view = {name: Vector(task["view"][name]) for name in ("eye", "center", "up")}
    view["fovy"] = task["view"]["fovy"]
    turn = blenderScene.turnOf(view)
    addQuads(task, turn)
    addSun(task, turn)
    addFog(task, turn)
    return view


blenderScene.run(addScene)
