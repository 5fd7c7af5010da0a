# waxInBlender.py - renders data/wax.osgt with Blender's Cycles; wax.py starts it in Blender.
# SPDX-License-Identifier: MIT
"""Arguments after "--": a JSON file with obj (the scene as OSG's osgconv writes it), size, threads,
radius, method and pictures, a list of [file, samples, seed]. The files are arrays of NumPy with
linear RGB, the lowest row first. The result is printed, a line for each picture: processor seconds.
Values that repeat those of data/generator/WaxBust.cpp are marked with its name."""
import json
import math
import os
import resource
import sys

import bpy
import numpy
from mathutils import Matrix, Vector

# WaxBust.cpp
EYE, CENTER, FOVY_DEGREES = Vector((-11, -44, 15)), Vector((0, 0, 9.2)), 25.0
WAX = {"color": (0.93, 0.75, 0.52), "radius": (0.5, 0.28, 0.16), "ior": 1.45, "roughness": 0.4}
DIFFUSE = {"table": (0.2, 0.16, 0.13), "wall": (0.16, 0.19, 0.24), "socle": (0.1, 0.1, 0.11)}
LAMPS = [
    ((5, 14, 22), (6, 0, 0), (0, -4, 4.5), (110, 100, 86)),
    ((-40, -30, 20), (0, 0, 20), (16, -16, 0), (2.2, 2.4, 2.8)),
]


def turn():
    """Returns the scene's transform: the view's right, ahead and up become x, y and z."""
    ahead = (CENTER - EYE).normalized()
    right = ahead.cross(Vector((0, 0, 1))).normalized()
    return Matrix((right, ahead, right.cross(ahead)))


def readParts(file):
    """Returns the vertices and faces of each object of an OBJ file, by name."""
    parts, first, count = {}, 1, 0
    with open(file, encoding="utf-8") as lines:
        for line in lines:
            words = line.split()
            if line.startswith("o "):
                first = count + 1
                points, faces = parts.setdefault(line[2:].strip(), ([], []))
            elif line.startswith("v "):
                points.append([float(word) for word in words[1:]])
                count += 1
            elif line.startswith("f "):
                faces.append([int(word.split("/")[0]) - first for word in words[1:]])
    return parts


def diffuse(name, color):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    surface = nodes.new("ShaderNodeBsdfDiffuse")
    surface.inputs["Color"].default_value = (*color, 1)
    links.new(surface.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


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
    for name, (points, faces) in readParts(task["obj"]).items():
        known = [it for it in (*DIFFUSE, "bust_Geometry") if "bust_" + it in name]
        if not known:
            continue  # the squares of lamps
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(points, [], faces)
        isWax = known[0] == "bust_Geometry"
        mesh.materials.append(wax(task) if isWax else diffuse(name, DIFFUSE[known[0]]))
        mesh.polygons.foreach_set("use_smooth", [isWax] * len(mesh.polygons))
        bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))


def addLamps():
    """Lamps emit to one side, -z of theirs. The radiance of a lamp is its power over 4 and area."""
    matrix = turn()
    for corner, u, v, radiance in LAMPS:
        corner, u, v = (matrix @ Vector(it) for it in (corner, u, v))
        x, z = u.normalized(), -u.cross(v).normalized()
        lamp = bpy.data.lights.new("lamp", "AREA")
        lamp.shape, lamp.size, lamp.size_y = "RECTANGLE", u.length, v.length
        lamp.energy = 4 * u.length * v.length
        lamp.color = radiance
        lamp.cycles.use_multiple_importance_sampling = True
        placed = bpy.data.objects.new("lamp", lamp)
        axes = Matrix((x, z.cross(x), z)).transposed().to_4x4()
        placed.matrix_world = Matrix.Translation(corner + (u + v) / 2) @ axes
        placed.visible_camera = False  # none is in the view
        bpy.context.scene.collection.objects.link(placed)


def addCamera():
    data = bpy.data.cameras.new("view")
    data.sensor_fit, data.angle = "VERTICAL", math.radians(FOVY_DEGREES)
    data.clip_end = 1000
    placed = bpy.data.objects.new("view", data)
    axes = Matrix(((1, 0, 0), (0, 0, -1), (0, 1, 0))).to_4x4()  # looks along +y, with z up
    placed.matrix_world = Matrix.Translation(turn() @ EYE) @ axes
    bpy.context.scene.collection.objects.link(placed)
    bpy.context.scene.camera = placed


def setCycles(task):
    """Path tracing without clamping, filtering or denoising."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy = cycles.light_sampling_threshold = 0
    for kind in ("max", "diffuse", "glossy", "transmission"):
        setattr(cycles, kind + "_bounces", task["bounces"])
    cycles.pixel_filter_type = "BOX"
    scene.world = bpy.data.worlds.new("dark")
    scene.world.color = (0, 0, 0)
    scene.render.threads_mode, scene.render.threads = "FIXED", task["threads"]
    scene.render.resolution_x = scene.render.resolution_y = task["size"]
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.view_settings.view_transform = "Raw"


def processorSeconds():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def render(file, samples, seed, size):
    cycles = bpy.context.scene.cycles
    cycles.samples, cycles.seed = samples, seed
    bpy.context.scene.render.filepath = file + ".exr"
    begin = processorSeconds()
    bpy.ops.render.render(write_still=True)
    seconds = processorSeconds() - begin
    image = bpy.data.images.load(file + ".exr")
    image.colorspace_settings.name = "Raw"
    values = numpy.array(image.pixels[:], dtype=numpy.float32).reshape(size, size, 4)
    numpy.save(file, values[..., :3])
    bpy.data.images.remove(image)
    os.remove(file + ".exr")
    print("PICTURE", file, samples, f"{seconds:.3f}", flush=True)


def main():
    with open(sys.argv[sys.argv.index("--") + 1], encoding="utf-8") as text:
        task = json.load(text)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="cycles")
    if task.get("convert"):  # pictures of ours, as arrays
        for file in task["convert"]:
            image = bpy.data.images.load(file)
            image.colorspace_settings.name = "Raw"
            values = numpy.array(image.pixels[:], dtype=numpy.float32)
            numpy.save(file[:-4], values.reshape(task["size"], task["size"], -1)[..., :3])
        return
    addParts(task)
    addLamps()
    addCamera()
    setCycles(task)
    for file, samples, seed in task["pictures"]:
        render(file, samples, seed, task["size"])


main()
