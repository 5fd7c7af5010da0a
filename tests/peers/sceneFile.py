# sceneFile.py - reads the surfaces, lamps and view of an .osgt file of ours, for other renderers,
# and writes such a file.
# SPDX-License-Identifier: MIT
"""A scene is a dictionary: "view" has eye, center, up and fovy [degrees]; "parts" is a list of
dictionaries with points (n x 3), triangles (m x 3), normals (n x 3, or None: flat) and material;
"lamps" is a list of corner, u, v and radiance. A material has kind, which is "diffuse", "metal" or
"glass", color, and roughness (metal) or ior (glass). Lengths and coordinates are the file's, with
all transforms applied. What a scene has besides raises ValueError: other renderers would not get
it."""
import numpy

import osgText

NODES = {"osg::Group", "osg::MatrixTransform", "osg::Geode", "osg::ClearNode", "osg::CameraView"}
ATTRIBUTES = {"osg::LightModel", "osg::Material", "osgRayTrace::PhysicalMaterial"}
FIELDS = {"UniqueID", "Name", "BaseColor", "Roughness", "Metallic", "Transmission", "Ior"}
LAMP_FIELDS = {"UniqueID", "Name", "Corner", "EdgeU", "EdgeV", "Radiance"}


def parse(text):
    """Returns the blocks of a file: lists of (words, block or None)."""
    stack = [[]]
    for line in text.splitlines():
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        if words == ["}"]:
            stack.pop()
        elif words[-1] == "{":
            block = []
            stack[-1].append((words[:-1], block))
            stack.append(block)
        else:
            stack[-1].append((words, None))
    return stack[0]


def field(block, name, default=None):
    """Returns the words of a field, as numbers."""
    for words, _ in block:
        if words[0] == name:
            return numpy.array([float(word) for word in words[1:]])
    return None if default is None else numpy.array(default, float)


def inner(block, name):
    """Returns the blocks within the block of a field: (class, block)."""
    found = [it for words, it in block if words[0] == name and it is not None]
    return [(words[0], it) for words, it in found[0] if it is not None] if found else []


def numbers(block, name):
    """Returns all numbers of the block of a field."""
    for words, rows in block:
        if words[0] == name:
            return numpy.array([float(word) for row, _ in rows for word in row])
    raise ValueError(f"no field {name}")


def turned(quaternion, vector):
    axis, real = quaternion[:3], quaternion[3]
    across = 2 * numpy.cross(axis, vector)
    return vector + real * across + numpy.cross(axis, across)


def need(names, known, what):
    """names: of what is there."""
    for name in names:
        if name not in known:
            raise ValueError(f"{name}, {what} that other renderers are not given")


def materialOf(block):
    need((words[0] for words, _ in block), FIELDS, "a field of a material")
    color = field(block, "BaseColor", (1, 1, 1))
    roughness = field(block, "Roughness", (1,))[0]
    clear, metallic = (field(block, it, (0,))[0] for it in ("Transmission", "Metallic"))
    ior = field(block, "Ior", (1.5,))[0]
    if (clear, metallic, roughness) == (1, 0, 0) and (color == 1).all():
        return {"kind": "glass", "color": color, "ior": ior}
    if (clear, metallic) == (0, 1):
        return {"kind": "metal", "color": color, "roughness": roughness}
    if (clear, metallic, ior) == (0, 0, 1):
        return {"kind": "diffuse", "color": color}
    raise ValueError("a material that other renderers are not given")


class Reader:
    """Follows the graph of a file. Objects that are met again have their number alone."""

    def __init__(self, view):
        self.known, self.parts, self.lamps, self.view = {}, [], [], view

    def whole(self, block):
        return self.known.setdefault(int(field(block, "UniqueID")[0]), block)

    def material(self, block, inherited):
        for _, state in inner(block, "StateSet"):
            state = self.whole(state)
            if inner(state, "TextureAttributeList"):
                raise ValueError("textures, which other renderers are not given")
            need((kind for kind, _ in inner(state, "AttributeList")), ATTRIBUTES, "an attribute")
            for kind, attribute in inner(state, "AttributeList"):
                if kind == "osgRayTrace::PhysicalMaterial":
                    inherited = materialOf(self.whole(attribute))
        return inherited

    def geometry(self, block, matrix, material):
        material = self.material(block, material)
        if material is None:
            raise ValueError("a surface without a PhysicalMaterial")
        arrays = {name: inner(block, name) for name in ("VertexArray", "NormalArray")}
        points = numbers(arrays["VertexArray"][0][1], "vector").reshape(-1, 3)
        normals = None
        if arrays["NormalArray"]:
            normals = numbers(arrays["NormalArray"][0][1], "vector").reshape(-1, 3)
            turn = matrix[:3, :3]
            rotated = numpy.allclose(turn @ turn.T, numpy.eye(3), 0, 1e-4)
            if len(normals) != len(points) or not rotated:
                raise ValueError("normals of faces, or below a transform that is no rotation")
            normals = normals @ turn
        for kind, primitive in inner(block, "PrimitiveSetList"):
            mode = [words[1] for words, _ in primitive if words[0] == "Mode"][0]
            if kind == "osg::DrawArrays":
                first, count = field(primitive, "First", (0,))[0], field(primitive, "Count")[0]
                index = numpy.arange(first, first + count).astype(int)
            else:
                index = numbers(primitive, "vector").astype(int)
            if mode == "QUADS":
                quads = index.reshape(-1, 4)
                index = numpy.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
            elif mode != "TRIANGLES":
                raise ValueError(f"primitives of mode {mode}")
            part = {"points": points @ matrix[:3, :3] + matrix[3, :3], "normals": normals}
            self.parts.append({**part, "triangles": index.reshape(-1, 3), "material": material})

    def node(self, kind, block, matrix, material):
        need([kind], NODES | {"osgRayTrace::AreaLight"}, "a node")
        block = self.whole(block)
        material = self.material(block, material)
        if kind == "osg::MatrixTransform":
            own = numbers(block, "Matrix").reshape(4, 4)
            matrix = own @ matrix  # rows are points, as OSG's
        if kind == "osg::CameraView" and self.view is None:
            attitude, eye = field(block, "Attitude"), field(block, "Position")
            turn = matrix[:3, :3]
            eye = eye @ turn + matrix[3, :3]
            self.view = {
                "eye": eye,
                "center": eye + turned(attitude, numpy.array([0, 0, -1.0])) @ turn,
                "up": turned(attitude, numpy.array([0, 1.0, 0])) @ turn,
                "fovy": field(block, "FieldOfView")[0],
            }
        if kind == "osgRayTrace::AreaLight":
            need((words[0] for words, _ in block), LAMP_FIELDS, "a field of a lamp")
            corner, u, v = (field(block, it) for it in ("Corner", "EdgeU", "EdgeV"))
            turn = matrix[:3, :3]
            lamp = (corner @ turn + matrix[3, :3], u @ turn, v @ turn, field(block, "Radiance"))
            self.lamps.append(lamp)
        for drawable, geometry in inner(block, "Drawables"):
            need([drawable], {"osg::Geometry"}, "a drawable")
            self.geometry(self.whole(geometry), matrix, material)
        for child, inside in inner(block, "Children"):
            self.node(child, inside, matrix, material)


def read(file):
    """Returns the scene of a file."""
    with open(file, encoding="utf-8") as text:
        blocks = parse(text.read())
    reader = Reader(None)
    for words, block in blocks:
        reader.node(words[0], block, numpy.eye(4), None)
    return {"view": reader.view, "parts": reader.parts, "lamps": reader.lamps}


def text(values):
    return " ".join(f"{value:.9g}" for value in numpy.ravel(values))


def write(file, scene):
    """Writes a scene whose materials are diffuse; the view is left out."""
    nodes = []
    for index, part in enumerate(scene["parts"]):
        look = osgText.diffuse(part["material"]["color"])
        mesh = osgText.triangles(part["points"], part["triangles"])
        nodes.append(osgText.shaded(f"part {index}", [mesh], look))
    nodes += [osgText.areaLight(*lamp) for lamp in scene["lamps"]]
    osgText.write(file, nodes)
