# pbrtScene.py - writes a scene for pbrt-v3.
# SPDX-License-Identifier: MIT
"""See sceneFile.py for what a scene is. Lamps are black parallelograms that shine to one side, as
ours. "disney" of pbrt's with metallic 1 is GGX below Schlick's Fresnel term, as our metal is; its
width is the square of the roughness, too."""
import sceneFile

MATERIALS = {
    "diffuse": 'Material "matte" "rgb Kd" [{color}]',
    "metal": 'Material "disney" "rgb color" [{color}] "float metallic" [1] '
    '"float roughness" [{roughness:.9g}]',
    "glass": 'Material "glass" "rgb Kr" [1 1 1] "rgb Kt" [1 1 1] "float eta" [{ior:.9g}]',
}
HEAD = """Scale -1 1 1
LookAt {eye} {center} {up}
Camera "perspective" "float fov" [{fovy:.9g}]
Film "image" "integer xresolution" [{size}] "integer yresolution" [{size}]
  "string filename" ["{file}"]
PixelFilter "box" "float xwidth" [0.5] "float ywidth" [0.5]
Sampler "halton" "integer pixelsamples" [{samples}]
Integrator {integrator}
WorldBegin
"""


def mesh(points, triangles, normals=None):
    words = f'Shape "trianglemesh" "integer indices" [{sceneFile.text(triangles)}]'
    words += f' "point P" [{sceneFile.text(points)}]'
    return words + (f' "normal N" [{sceneFile.text(normals)}]\n' if normals is not None else "\n")


def write(file, scene, picture, size, samples, integrator):
    """Writes a scene file whose result is a .pfm file of this name."""
    view = {it: sceneFile.text(scene["view"][it]) for it in ("eye", "center", "up")}
    lines = [
        HEAD.format(
            **view,
            fovy=scene["view"]["fovy"],
            size=size,
            file=picture,
            samples=samples,
            integrator=integrator,
        )
    ]
    for part in scene["parts"]:
        material = {**part["material"], "color": sceneFile.text(part["material"]["color"])}
        lines.append(MATERIALS[material["kind"]].format(**material) + "\n")
        lines.append(mesh(part["points"], part["triangles"], part["normals"]))
    lines.append('Material "matte" "rgb Kd" [0 0 0]\n')
    for corner, u, v, radiance in scene["lamps"]:
        lines.append("AttributeBegin\n")
        lines.append(f'AreaLightSource "diffuse" "rgb L" [{sceneFile.text(radiance)}]\n')
        corners = (corner, corner + u, corner + u + v, corner + v)
        lines.append(mesh(corners, (0, 1, 2, 0, 2, 3)) + "AttributeEnd\n")
    with open(file, "w", encoding="utf-8") as out:
        out.write("".join(lines) + "WorldEnd\n")
