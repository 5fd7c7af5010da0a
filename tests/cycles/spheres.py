# spheres.py - writes glTF files with one sphere each, to compare one lobe of a surface at a time,
# and with a wine glass.
# SPDX-License-Identifier: MIT
import base64
import json
import os

import numpy

COLUMNS, ROWS = 256, 128


def material(color=(1, 1, 1), metal=0, roughness=0.5, **extensions):
    surface = {
        "pbrMetallicRoughness": {
            "baseColorFactor": [*color, 1],
            "metallicFactor": metal,
            "roughnessFactor": roughness,
        }
    }
    if extensions:
        surface["extensions"] = {"KHR_materials_" + name: it for name, it in extensions.items()}
    return surface


BLACK, GREY, GOLD = (0, 0, 0), (0.5, 0.5, 0.5), (1.0, 0.77, 0.34)
CLEAR = {"transmissionFactor": 1}

MATERIALS = {
    "diffuse": material(GREY, specular={"specularFactor": 0, "specularColorFactor": BLACK}),
    "white05": material(roughness=0.5),
    "white10": material(roughness=1),
    "whiteMetal10": material(metal=1, roughness=1),
    "plastic01": material((0.6, 0.1, 0.1), roughness=0.1),
    "plastic05": material((0.6, 0.1, 0.1), roughness=0.5),
    "plastic10": material((0.6, 0.1, 0.1), roughness=1),
    "metal00": material(GOLD, metal=1, roughness=0),
    "metal03": material(GOLD, metal=1, roughness=0.3),
    "metal06": material(GOLD, metal=1, roughness=0.6),
    "metal10": material(GOLD, metal=1, roughness=1),
    "glass00": material(roughness=0, transmission=CLEAR, volume={"thicknessFactor": 1}),
    "glass03": material(roughness=0.3, transmission=CLEAR, volume={"thicknessFactor": 1}),
    "glassIor11": material(
        roughness=0, transmission=CLEAR, ior={"ior": 1.1}, volume={"thicknessFactor": 1}
    ),
    "glassAmber": material(
        roughness=0,
        transmission=CLEAR,
        volume={
            "thicknessFactor": 1,
            "attenuationDistance": 1,
            "attenuationColor": [0.9, 0.6, 0.2],
        },
    ),
    "glassThin": material((0.6, 0.9, 0.7), roughness=0, transmission=CLEAR),
    "goblet": material(roughness=0, transmission=CLEAR, volume={"thicknessFactor": 1}),
    "gobletAmber": material(
        roughness=0,
        transmission=CLEAR,
        volume={
            "thicknessFactor": 1,
            "attenuationDistance": 0.1,
            "attenuationColor": [0.9, 0.6, 0.2],
        },
    ),
    "specularHalf": material(GREY, roughness=0.2, specular={"specularColorFactor": GREY}),
    "clearcoat": material(
        (0.1, 0.2, 0.6),
        metal=0,
        roughness=0.8,
        clearcoat={"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.1},
    ),
    "sheen": material(
        (0.1, 0.1, 0.3),
        roughness=1,
        sheen={"sheenColorFactor": [0.8, 0.8, 0.8], "sheenRoughnessFactor": 0.5},
    ),
    "emission": {
        **material((0, 0, 0), roughness=1),
        "emissiveFactor": [0.2, 0.5, 0.4],
    },
}


# Radius and height, from the middle of the foot up the outside and down the inside of the bowl.
GOBLET = [(0, 0), (0.42, 0), (0.45, 0.03), (0.07, 0.08), (0.05, 0.5), (0.08, 0.66), (0.4, 0.85)]
GOBLET += [(0.52, 1.2), (0.42, 1.6), (0.385, 1.6), (0.48, 1.2), (0.36, 0.89), (0, 0.74)]


def goblet():
    """Returns points, normals and triangles of a wine glass, whose wall is a closed surface."""
    line = numpy.array(GOBLET, float)
    for _ in range(4):  # cuts corners [Chaikin], and keeps both ends
        near, far = 0.75 * line[:-1] + 0.25 * line[1:], 0.25 * line[:-1] + 0.75 * line[1:]
        inner = numpy.stack([near, far], 1).reshape(-1, 2)
        line = numpy.concatenate([line[:1], inner, line[-1:]])
    along = numpy.gradient(line, axis=0)
    along[0] = along[-1] = 0
    along[0, 0], along[-1, 0] = 1, -1
    along /= numpy.linalg.norm(along, axis=1, keepdims=True)
    azimuth = numpy.arange(COLUMNS + 1) / COLUMNS * 2 * numpy.pi
    around = numpy.stack([numpy.sin(azimuth), numpy.cos(azimuth)], -1)

    def turned(radius, height):
        flat = radius[:, None, None] * around
        up = numpy.broadcast_to(height[:, None], flat.shape[:2])
        return numpy.stack([flat[..., 0], up, flat[..., 1]], -1).reshape(-1, 3).astype("<f4")

    points, normals = turned(*line.T), turned(along[:, 1], -along[:, 0])
    row, column = numpy.meshgrid(numpy.arange(len(line) - 1), numpy.arange(COLUMNS), indexing="ij")
    first = row * (COLUMNS + 1) + column
    above = first + COLUMNS + 1
    right = numpy.stack([first, first + 1, above + 1], -1)[1:]
    left = numpy.stack([first, above + 1, above], -1)[:-1]
    triangles = numpy.concatenate([right.reshape(-1, 3), left.reshape(-1, 3)])
    return points, normals, triangles.astype("<u4")


def sphere():
    """Returns points of a unit sphere, its normals, which are the same, and triangles."""
    azimuth = numpy.arange(COLUMNS + 1) / COLUMNS * 2 * numpy.pi
    polar = numpy.arange(ROWS + 1) / ROWS * numpy.pi
    azimuth, polar = numpy.meshgrid(azimuth, polar)
    sine = numpy.sin(polar)
    x, z = sine * numpy.sin(azimuth), sine * numpy.cos(azimuth)
    points = numpy.stack([x, numpy.cos(polar), z], -1)
    row, column = numpy.meshgrid(numpy.arange(ROWS), numpy.arange(COLUMNS), indexing="ij")
    first = row * (COLUMNS + 1) + column
    below = first + COLUMNS + 1
    upper = numpy.stack([first, below + 1, first + 1], -1)[1:]
    lower = numpy.stack([first, below, below + 1], -1)[:-1]
    triangles = numpy.concatenate([upper.reshape(-1, 3), lower.reshape(-1, 3)])
    points = points.reshape(-1, 3).astype("<f4")
    return points, points, triangles.astype("<u4")


def write(name, folder):
    """Writes the body of this name; returns the file."""
    points, normals, triangles = goblet() if name.startswith("goblet") else sphere()
    data = points.tobytes() + normals.tobytes() + triangles.tobytes()
    surface = MATERIALS[name]
    primitive = {"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0}
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}],
        "materials": [surface],
        "extensionsUsed": list(surface.get("extensions", {})),
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5126,
                "type": "VEC3",
                "count": len(points),
                "min": points.min(0).tolist(),
                "max": points.max(0).tolist(),
            },
            {"bufferView": 1, "componentType": 5126, "type": "VEC3", "count": len(normals)},
            {"bufferView": 2, "componentType": 5125, "type": "SCALAR", "count": triangles.size},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": points.nbytes},
            {"buffer": 0, "byteOffset": points.nbytes, "byteLength": normals.nbytes},
            {"buffer": 0, "byteOffset": 2 * points.nbytes, "byteLength": triangles.nbytes},
        ],
        "buffers": [
            {
                "byteLength": len(data),
                "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode(),
            }
        ],
    }
    if not document["extensionsUsed"]:
        del document["extensionsUsed"]
    file = os.path.join(folder, name + ".gltf")
    with open(file, "w", encoding="utf-8") as out:
        json.dump(document, out)
    return file
