# renderInBlender.py - renders a glTF file with Blender's Cycles; compare.py starts it in Blender.
# SPDX-License-Identifier: MIT
"""Arguments after "--": a JSON file with model, sky, view, size, samples, bounces, seed, folder and
repair, which is true if materials get glTF's formulas (repairs.py). view is the direction from the
model to the eye. The result is three files in the folder: camera.json
has the numbers of the camera, cycles.png the picture, mask.png the model's coverage as alpha."""
import json
import math
import os
import sys

import bpy
import numpy
from mathutils import Matrix, Vector

sys.path.append(os.path.dirname(os.path.abspath(__file__)))
import blenderScene
import repairs

FOVY_DEGREES = 40.0


def readModel(file):
    """Leaves nothing but the model in the scene, at the beginning of its first animation."""
    numpy.bool = bool  # Debian's Blender 3.4 asks for this name, which its NumPy 1.24 has no more
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
    bpy.ops.preferences.addon_enable(module="cycles")
    bpy.ops.import_scene.gltf(filepath=file)
    bpy.context.scene.frame_set(0)


def renderedMeshes():
    shown = bpy.context.view_layer.objects
    return [it for it in shown if it.type == "MESH" and it.visible_get() and not it.hide_render]


def giveDefaultMaterial():
    """The importer leaves primitives without a material to Blender's default, which is diffuse.
    glTF's default material is white metal of roughness 1 [glTF20, sect. 5.19, 5.22]."""
    standard = bpy.data.materials.new("glTF default")
    standard.use_nodes = True
    standard.use_backface_culling = True
    inputs = standard.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value = (1, 1, 1, 1)
    inputs["Metallic"].default_value = 1
    inputs["Roughness"].default_value = 1
    for shown in renderedMeshes():
        slots = shown.data.materials
        if not slots:
            slots.append(standard)
        for index, material in enumerate(slots):
            slots[index] = material or standard


def cullBackFaces(material):
    """Cycles shows back faces of all materials. Camera rays pass those of one-sided ones, as they
    do in osgraytrace. Both show the far wall of a thin-walled body through the near one."""
    nodes, links = material.node_tree.nodes, material.node_tree.links
    surface = repairs.nodeOfType(material, "OUTPUT_MATERIAL").inputs["Surface"]
    principled = repairs.nodeOfType(material, "BSDF_PRINCIPLED")
    transmits = principled and principled.inputs["Transmission"].default_value > 0
    if not material.use_backface_culling or transmits or not surface.links:
        return
    geometry, path = nodes.new("ShaderNodeNewGeometry"), nodes.new("ShaderNodeLightPath")
    both, mix = nodes.new("ShaderNodeMath"), nodes.new("ShaderNodeMixShader")
    both.operation = "MULTIPLY"
    links.new(geometry.outputs["Backfacing"], both.inputs[0])
    links.new(path.outputs["Is Camera Ray"], both.inputs[1])
    links.new(both.outputs[0], mix.inputs["Fac"])
    links.new(surface.links[0].from_socket, mix.inputs[1])
    links.new(nodes.new("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], surface)


def cameraFor(view):
    """Returns eye, center, up and fovy for the sphere around all vertices."""
    graph = bpy.context.evaluated_depsgraph_get()
    points = []
    for shown in renderedMeshes():
        evaluated = shown.evaluated_get(graph)
        points += [shown.matrix_world @ vertex.co for vertex in evaluated.to_mesh().vertices]
        evaluated.to_mesh_clear()
    low = Vector([min(point[i] for point in points) for i in range(3)])
    high = Vector([max(point[i] for point in points) for i in range(3)])
    center = (low + high) / 2
    radius = max((point - center).length for point in points)
    distance = 1.02 * radius / math.sin(math.radians(FOVY_DEGREES / 2))
    eye = center + Vector(view).normalized() * distance
    return {"eye": list(eye), "center": list(center), "up": [0, 0, 1], "fovy": FOVY_DEGREES}


def placeCamera(camera):
    data = bpy.data.cameras.new("view")
    data.sensor_fit = "VERTICAL"
    data.angle = math.radians(camera["fovy"])
    eye, center = Vector(camera["eye"]), Vector(camera["center"])
    distance = (center - eye).length
    data.clip_start, data.clip_end = distance / 1000, distance * 1000
    back = (eye - center).normalized()
    right = Vector(camera["up"]).cross(back).normalized()
    turn = Matrix((right, back.cross(right), back)).transposed()
    placed = bpy.data.objects.new("view", data)
    placed.matrix_world = Matrix.Translation(eye) @ turn.to_4x4()
    bpy.context.scene.collection.objects.link(placed)
    bpy.context.scene.camera = placed


def setCycles(task):
    """Path tracing without clamping, filtering or denoising; sRGB without a film look."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples, cycles.seed = task["samples"], task["seed"]
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy = cycles.light_sampling_threshold = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    for kind in ("max", "diffuse", "glossy", "transmission"):
        setattr(cycles, kind + "_bounces", task["bounces"])
    cycles.transparent_max_bounces = 64
    cycles.pixel_filter_type = "BOX"
    render = scene.render
    render.resolution_x = render.resolution_y = task["size"]
    render.resolution_percentage = 100
    render.dither_intensity = 0
    render.image_settings.file_format = "PNG"
    render.image_settings.color_mode = "RGBA"
    scene.display_settings.display_device = "sRGB"
    scene.view_settings.view_transform = "Standard"
    scene.view_settings.look = "None"
    scene.view_settings.exposure, scene.view_settings.gamma = 0, 1


def renderTo(file):
    bpy.context.scene.render.filepath = file
    bpy.ops.render.render(write_still=True)


def main():
    with open(sys.argv[sys.argv.index("--") + 1], encoding="utf-8") as text:
        task = json.load(text)
    folder = task["folder"]
    readModel(task["model"])
    giveDefaultMaterial()
    for shown in renderedMeshes() if task.get("repair") else []:
        repairs.removeCovered(shown.data)
    for material in bpy.data.materials:
        if material.use_nodes:
            if task.get("repair"):
                repairs.repair(material)
            cullBackFaces(material)
    camera = cameraFor(task["view"])
    with open(os.path.join(folder, "camera.json"), "w", encoding="utf-8") as text:
        json.dump(camera, text)
    placeCamera(camera)
    blenderScene.lightBySky(task["sky"])
    setCycles(task)
    renderTo(os.path.join(folder, "cycles.png"))
    bpy.context.scene.render.film_transparent = True
    bpy.context.scene.cycles.samples = 4
    renderTo(os.path.join(folder, "mask.png"))


main()
