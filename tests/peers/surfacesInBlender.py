# surfacesInBlender.py - renders a scene with Blender's Cycles; surfaces.py starts it in Blender.
# SPDX-License-Identifier: MIT
"""The task has scene, a file of NumPy's with what sceneFile.py calls a scene, beside what
../cycles/blenderScene.py wants."""
import os
import sys

import bpy
import numpy
from mathutils import Vector

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "../cycles"))
import blenderScene  # noqa: E402


def nodesOf(name):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    return material, nodes


def metal(values):
    """GGX below a Fresnel term between the colour and white, as our metal's."""
    material, nodes = nodesOf("metal")
    surface = nodes.new("ShaderNodeBsdfPrincipled")
    surface.distribution = "GGX"
    surface.inputs["Base Color"].default_value = (*values["color"], 1)
    surface.inputs["Metallic"].default_value = 1
    surface.inputs["Roughness"].default_value = values["roughness"]
    output = nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(surface.outputs[0], output.inputs["Surface"])
    return material


def glass(values):
    material, nodes = nodesOf("glass")
    surface = nodes.new("ShaderNodeBsdfGlass")
    surface.distribution = "SHARP"
    surface.inputs["Color"].default_value = (1, 1, 1, 1)
    surface.inputs["IOR"].default_value = values["ior"]
    output = nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(surface.outputs[0], output.inputs["Surface"])
    return material


def materialOf(values):
    if values["kind"] == "diffuse":
        return blenderScene.diffuse("diffuse", values["color"])
    return metal(values) if values["kind"] == "metal" else glass(values)


def addPart(view, part, caustics):
    turn = numpy.array(blenderScene.turnOf(view)).T
    mesh = bpy.data.meshes.new("part")
    mesh.from_pydata((part["points"] @ turn).tolist(), [], part["triangles"].tolist())
    mesh.materials.append(materialOf(part["material"]))
    if part["normals"] is not None:
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
        mesh.use_auto_smooth = True
        mesh.normals_split_custom_set_from_vertices((part["normals"] @ turn).tolist())
    added = bpy.data.objects.new("part", mesh)
    bpy.context.scene.collection.objects.link(added)
    if caustics:  # Cycles' manifold walks to lamps through smooth glass
        isGlass = part["material"]["kind"] == "glass"
        added.cycles.is_caustics_caster, added.cycles.is_caustics_receiver = isGlass, not isGlass


def addLamp(view, lamp, caustics):
    """Adds a lamp, and a black parallelogram right behind it, as lamps of Cycles' hide nothing."""
    corner, u, v, radiance = lamp
    shining = blenderScene.addLamp(view, corner, u, v, radiance.tolist(), seen=True)
    shining.data.cycles.is_caustics_light = caustics
    front = numpy.cross(u, v)
    front *= 1e-4 * numpy.sqrt(numpy.linalg.norm(front)) / numpy.linalg.norm(front)
    points = numpy.array([corner, corner + u, corner + u + v, corner + v]) - front
    black = {"kind": "diffuse", "color": (0, 0, 0)}
    part = {"points": points, "triangles": numpy.array([[0, 1, 2], [0, 2, 3]]), "normals": None}
    addPart(view, {**part, "material": black}, False)


def addScene(task):
    scene = numpy.load(task["scene"], allow_pickle=True).item()
    view = {it: Vector(scene["view"][it]) for it in ("eye", "center", "up")}
    view["fovy"] = scene["view"]["fovy"]
    caustics = any(part["material"]["kind"] == "glass" for part in scene["parts"])
    for part in scene["parts"]:
        addPart(view, part, caustics)
    for lamp in scene["lamps"]:
        addLamp(view, lamp, caustics)
    return view


blenderScene.run(addScene)
