# repairs.py - gives Cycles what glTF means where Blender's importer does not.
# SPDX-License-Identifier: MIT
"""compare.py --repair has renderInBlender.py call repair() and removeCovered(). Otherwise materials
and meshes stay as imported. Materials with textures of metal or transmission always do."""
import math

import bmesh
import numpy

LARGEST_MESH = 1000  # triangles; all pairs are compared


def nodeOfType(material, kind):
    return next((node for node in material.node_tree.nodes if node.type == kind), None)


def replaceSurface(material, old, new):
    """Puts an output in the place of another one that leads to the surface."""
    for link in list(old.links):
        material.node_tree.links.new(new, link.to_socket)


def copyInput(material, source, target):
    """Gives an input what another one has: its link or its value."""
    if source.links:
        material.node_tree.links.new(source.links[0].from_socket, target)
    elif source.type != "VECTOR":
        value = source.default_value
        color = source.type == "RGBA"
        target.default_value = value[: len(target.default_value)] if color else value


def repairDiffuse(material, principled):
    """Cycles' Principled BSDF adds what the interface reflects to Disney's diffuse light. glTF's
    diffuse light is Lambert's and gets what the interface leaves, some 95 % of index 1.5."""
    nodes, links = material.node_tree.nodes, material.node_tree.links
    scale, diffuse = nodes.new("ShaderNodeVectorMath"), nodes.new("ShaderNodeBsdfDiffuse")
    scale.operation = "SCALE"
    scale.inputs["Scale"].default_value = 0.95
    color = principled.inputs["Base Color"]
    copyInput(material, color, scale.inputs[0])
    if color.links:
        links.remove(color.links[0])
    color.default_value = (0, 0, 0, 1)
    links.new(scale.outputs[0], diffuse.inputs["Color"])
    copyInput(material, principled.inputs["Normal"], diffuse.inputs["Normal"])
    both = nodes.new("ShaderNodeAddShader")
    replaceSurface(material, principled.outputs[0], both.outputs[0])
    links.new(principled.outputs[0], both.inputs[0])
    links.new(diffuse.outputs[0], both.inputs[1])


def repairAttenuation(absorption):
    """A length d leaves exp(-d density (1 - color)) in Cycles, color^(d density) in glTF."""
    color, density = absorption.inputs["Color"], absorption.inputs["Density"]
    lengths = density.default_value
    absorbed = [-math.log(max(value, 1e-6)) * lengths for value in color.default_value[:3]]
    density.default_value = max(absorbed)
    if density.default_value > 0:
        color.default_value = [1 - value / density.default_value for value in absorbed] + [1]


def repairThinWall(material, principled):
    """Transmission without a volume is a thin wall in glTF and a solid body in Cycles. The wall
    reflects 2 F / (1 + F), and light passes it straight."""
    nodes, links = material.node_tree.nodes, material.node_tree.links

    def math2(operation, first, second):
        node = nodes.new("ShaderNodeMath")
        node.operation = operation
        for value, target in zip((first, second), node.inputs):
            if isinstance(value, (int, float)):
                target.default_value = value
            else:
                links.new(value, target)
        return node.outputs[0]

    # The node takes the reciprocal index on the back, where a wall has the same one as in front.
    back = nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"]
    fresnel = nodes.new("ShaderNodeFresnel")
    sign = math2("SUBTRACT", 1, math2("MULTIPLY", 2, back))
    links.new(math2("POWER", principled.inputs["IOR"].default_value, sign), fresnel.inputs["IOR"])
    face = fresnel.outputs[0]
    reflected = math2("DIVIDE", math2("MULTIPLY", 2, face), math2("ADD", 1, face))
    mirror, straight = nodes.new("ShaderNodeBsdfGlossy"), nodes.new("ShaderNodeBsdfTransparent")
    mirror.inputs["Color"].default_value = (1, 1, 1, 1)
    copyInput(material, principled.inputs["Roughness"], mirror.inputs["Roughness"])
    copyInput(material, principled.inputs["Base Color"], straight.inputs["Color"])
    mix = nodes.new("ShaderNodeMixShader")
    links.new(reflected, mix.inputs["Fac"])
    links.new(straight.outputs[0], mix.inputs[1])
    links.new(mirror.outputs[0], mix.inputs[2])
    replaceSurface(material, principled.outputs[0], mix.outputs[0])


def repairClearcoat(material, principled):
    """Cycles 3.4's clear coat reflects a quarter of glTF's, beside all that the base reflects. The
    base gets what the coat, whose index is 1.5, does not reflect."""
    nodes, links = material.node_tree.nodes, material.node_tree.links
    coat, fresnel = nodes.new("ShaderNodeBsdfGlossy"), nodes.new("ShaderNodeFresnel")
    coat.inputs["Color"].default_value = (1, 1, 1, 1)
    copyInput(material, principled.inputs["Clearcoat Roughness"], coat.inputs["Roughness"])
    fresnel.inputs["IOR"].default_value = 1.5
    share = nodes.new("ShaderNodeMath")
    share.operation = "MULTIPLY"
    copyInput(material, principled.inputs["Clearcoat"], share.inputs[0])
    links.new(fresnel.outputs[0], share.inputs[1])
    principled.inputs["Clearcoat"].default_value = 0
    mix = nodes.new("ShaderNodeMixShader")
    links.new(share.outputs[0], mix.inputs["Fac"])
    replaceSurface(material, principled.outputs[0], mix.outputs[0])
    links.new(principled.outputs[0], mix.inputs[1])
    links.new(coat.outputs[0], mix.inputs[2])


def isCovered(points, corners, normal):
    """Returns which points lie within triangles of their plane. corners: of each triangle."""
    first, edges = corners, numpy.roll(corners, -1, axis=1) - corners
    off = points[:, None, None] - first[None]
    sides = numpy.cross(edges[None], off) @ normal
    size = numpy.abs(corners).max()
    return ((sides > -1e-6 * size**2).all(2) & (abs(off @ normal) < 1e-5 * size).all(2)).any(1)


def removeCovered(mesh):
    """Takes away triangles that others of their plane cover: Cycles shows them black."""
    if len(mesh.polygons) > LARGEST_MESH or any(len(it.vertices) != 3 for it in mesh.polygons):
        return
    places = numpy.array([vertex.co for vertex in mesh.vertices])
    corners = places[numpy.array([it.vertices for it in mesh.polygons]).reshape(-1, 3)]
    normals = numpy.array([it.normal for it in mesh.polygons])
    shares = [(i + 1, k + 1, 7 - i - k) for i in range(6) for k in range(6 - i)]
    weights = numpy.array(shares) / 9.0
    left = numpy.ones(len(corners), bool)
    for i, normal in enumerate(normals):
        left[i] = False
        others = left & (normals @ normal > 0.999)
        covered = others.any() and isCovered(weights @ corners[i], corners[others], normal).all()
        left[i] = not covered
    editable = bmesh.new()
    editable.from_mesh(mesh)
    editable.faces.ensure_lookup_table()
    gone = [editable.faces[i] for i in numpy.flatnonzero(~left)]
    bmesh.ops.delete(editable, geom=gone, context="FACES_ONLY")
    editable.to_mesh(mesh)
    editable.free()


def repair(material):
    principled = nodeOfType(material, "BSDF_PRINCIPLED")
    if not principled:
        return
    metallic, transmission = principled.inputs["Metallic"], principled.inputs["Transmission"]
    if metallic.links or transmission.links or metallic.default_value != 0:
        return
    absorption = nodeOfType(material, "VOLUME_ABSORPTION")
    clearcoat = principled.inputs["Clearcoat"]
    if not clearcoat.links and clearcoat.default_value > 0:
        repairClearcoat(material, principled)
    if transmission.default_value == 0:
        repairDiffuse(material, principled)
    elif absorption:
        repairAttenuation(absorption)
    elif transmission.default_value == 1:
        repairThinWall(material, principled)
