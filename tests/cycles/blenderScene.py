# blenderScene.py - a scene of ours in Blender, rendered with Cycles; for scripts that run there.
# SPDX-License-Identifier: MIT
"""Arguments after "--": a JSON file with obj (the scene as OSG's osgconv writes it), size, threads,
bounces, sky (the picture of an environment, if there is one), pictures, a list of [file, samples,
seed], and what the scene's own script wants. The files are arrays of NumPy with linear RGB, the
lowest row first. The result is printed, a line for each picture: processor seconds."""
import json
import math
import os
import resource
import sys

import bpy
import numpy
from mathutils import Matrix, Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from objParts import readParts  # noqa: E402,F401


def turnOf(view):
    """Returns the transform of a scene of ours: its view's right, ahead and up become x, y and
    z."""
    ahead = (view["center"] - view["eye"]).normalized()
    right = ahead.cross(view["up"]).normalized()
    return Matrix((right, ahead, right.cross(ahead)))


def diffuse(name, color):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    surface = nodes.new("ShaderNodeBsdfDiffuse")
    surface.inputs["Color"].default_value = (*color, 1)
    links.new(surface.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def fillWithFog(material, scattered, absorbed, anisotropy):
    """Makes a material a grey medium: coefficients [1/length]."""
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    scatter, absorb = nodes.new("ShaderNodeVolumeScatter"), nodes.new("ShaderNodeVolumeAbsorption")
    scatter.inputs["Color"].default_value = (1, 1, 1, 1)
    scatter.inputs["Density"].default_value = scattered
    scatter.inputs["Anisotropy"].default_value = anisotropy
    absorb.inputs["Color"].default_value = (0, 0, 0, 1)
    absorb.inputs["Density"].default_value = absorbed
    both = nodes.new("ShaderNodeAddShader")
    links.new(scatter.outputs[0], both.inputs[0])
    links.new(absorb.outputs[0], both.inputs[1])
    links.new(both.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Volume"])


def addLamp(view, corner, u, v, radiance, seen=False):
    """Adds a lamp that emits to one side, -z of its own. Its radiance is its power over 4 and its
    area. seen: the camera sees it. Returns its object."""
    corner, u, v = (turnOf(view) @ Vector(it) for it in (corner, u, v))
    x, z = u.normalized(), -u.cross(v).normalized()
    lamp = bpy.data.lights.new("lamp", "AREA")
    lamp.shape, lamp.size, lamp.size_y = "RECTANGLE", u.length, v.length
    lamp.energy = 4 * u.length * v.length
    lamp.color = radiance
    lamp.cycles.use_multiple_importance_sampling = True
    placed = bpy.data.objects.new("lamp", lamp)
    axes = Matrix((x, z.cross(x), z)).transposed().to_4x4()
    placed.matrix_world = Matrix.Translation(corner + (u + v) / 2) @ axes
    placed.visible_camera = seen
    bpy.context.scene.collection.objects.link(placed)
    return placed


def addCamera(view):
    data = bpy.data.cameras.new("view")
    data.sensor_fit, data.angle = "VERTICAL", math.radians(view["fovy"])
    data.clip_end = 10000
    placed = bpy.data.objects.new("view", data)
    axes = Matrix(((1, 0, 0), (0, 0, -1), (0, 1, 0))).to_4x4()  # looks along +y, with z up
    placed.matrix_world = Matrix.Translation(turnOf(view) @ view["eye"]) @ axes
    bpy.context.scene.collection.objects.link(placed)
    bpy.context.scene.camera = placed


def lightBySky(file):
    """The middle of the picture lies towards +y, as in an EnvironmentLight; in Cycles at +x."""
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    world.cycles.sampling_method = "MANUAL"
    world.cycles.sample_map_resolution = 1024
    bpy.context.scene.world = world
    nodes, links = world.node_tree.nodes, world.node_tree.links
    place, turn = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeMapping")
    picture = nodes.new("ShaderNodeTexEnvironment")
    turn.inputs["Rotation"].default_value = (0, 0, -math.pi / 2)
    picture.image = bpy.data.images.load(file)
    links.new(place.outputs["Generated"], turn.inputs["Vector"])
    links.new(turn.outputs["Vector"], picture.inputs["Vector"])
    links.new(picture.outputs["Color"], nodes["Background"].inputs["Color"])


def setCycles(task):
    """Path tracing without clamping, filtering or denoising."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy = cycles.light_sampling_threshold = 0
    for kind in ("max", "diffuse", "glossy", "transmission", "volume"):
        setattr(cycles, kind + "_bounces", task["bounces"])
    cycles.pixel_filter_type = "BOX"
    scene.world = bpy.data.worlds.new("dark")
    scene.world.color = (0, 0, 0)
    if "sky" in task:
        lightBySky(task["sky"])
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


def run(addScene):
    """Does the task of the file named after "--"; addScene(task) adds what is to be seen, and
    returns the view: eye, center, up, fovy [degrees]."""
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
    addCamera(addScene(task))
    setCycles(task)
    for file, samples, seed in task["pictures"]:
        render(file, samples, seed, task["size"])
