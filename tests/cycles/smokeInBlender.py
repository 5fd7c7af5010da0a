# smokeInBlender.py - renders a file of smoke with Blender's Cycles; smoke.py starts it in Blender.
# SPDX-License-Identifier: MIT
"""The task has volume, the OpenVDB file, extinction, albedo, anisotropy and eye beside what
blenderScene.py wants. The view is along +y."""
import os
import sys

import bpy
from mathutils import Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import blenderScene  # noqa: E402


def addScene(task):
    material = bpy.data.materials.new("smoke")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    smoke = nodes.new("ShaderNodeVolumePrincipled")
    smoke.inputs["Color"].default_value = (task["albedo"],) * 3 + (1,)
    smoke.inputs["Density"].default_value = task["extinction"]
    smoke.inputs["Anisotropy"].default_value = task["anisotropy"]
    links.new(smoke.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Volume"])
    bpy.ops.object.volume_import(filepath=task["volume"], align="WORLD", location=(0, 0, 0))
    bpy.context.object.data.materials.append(material)
    eye = Vector(task["eye"])
    return {"eye": eye, "center": eye + Vector((0, 1, 0)), "up": Vector((0, 0, 1)), "fovy": 30.0}


blenderScene.run(addScene)
