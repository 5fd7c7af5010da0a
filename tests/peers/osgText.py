# osgText.py - writes small scenes in OSG's text format; for scripts beside other renderers.
# SPDX-License-Identifier: MIT
"""Functions return the texts of nodes, materials and media; write() makes a file of nodes."""
import itertools

NUMBERS = itertools.count(1)


def unique():
    return f"UniqueID {next(NUMBERS)}"


def words(values):
    return " ".join(f"{value:.9g}" for value in values)


def shaded(name, drawables, material):
    """Returns drawables with a material: fields of PhysicalMaterial by name."""
    fields = "\n".join(f"{key} {value}" for key, value in material.items())
    return f"""osg::Geode {{ {unique()}
Name "{name}"
StateSet TRUE {{ osg::StateSet {{ {unique()}
AttributeList 1 {{ osgRayTrace::PhysicalMaterial {{ {unique()}
{fields}
}} Value OFF }} }} }}
Drawables {len(drawables)} {{
{chr(10).join(drawables)}
}} }}"""


def diffuse(color):
    return {"BaseColor": words(color), "Ior": 1}


def glass(ior):
    return {"Roughness": 0, "Transmission": 1, "Ior": ior}


def quads(name, corners, color):
    """corners: of each quad the four."""
    texts = []
    for quad in corners:
        points = "\n".join(words(point) for point in quad)
        texts.append(
            f"""osg::Geometry {{ {unique()}
PrimitiveSetList 1 {{ osg::DrawArrays {{ {unique()}
Mode QUADS
Count 4
}} }}
VertexArray TRUE {{ osg::Vec3Array {{ {unique()}
Binding BIND_PER_VERTEX
vector 4 {{
{points}
}} }} }} }}"""
        )
    return shaded(name, texts, diffuse(color))


def triangles(points, corners):
    """Returns the text of a geometry. corners: of each triangle three indices of points."""
    numbers = " ".join(str(number) for corner in corners for number in corner)
    places = "\n".join(words(point) for point in points)
    return f"""osg::Geometry {{ {unique()}
PrimitiveSetList 1 {{ osg::DrawElementsUInt {{ {unique()}
Mode TRIANGLES
vector {3 * len(corners)} {{ {numbers} }} }} }}
VertexArray TRUE {{ osg::Vec3Array {{ {unique()}
Binding BIND_PER_VERTEX
vector {len(points)} {{
{places}
}} }} }} }}"""


def sphere(name, center, radius, material):
    text = f"""osg::ShapeDrawable {{ {unique()}
Shape TRUE {{ osg::Sphere {{ {unique()}
Center {words(center)}
Radius {radius:.9g}
}} }}
TessellationHints TRUE {{ osg::TessellationHints {{ {unique()}
DetailRatio 8
}} }} }}"""
    return shaded(name, [text], material)


def light(position, diffuse_color):
    """A light of OSG without falloff, or with the inverse square. position: x, y, z and 0 for a
    direction, 1 for a place. Its irradiance, or intensity, is pi times the colour."""
    return f"""osg::LightSource {{ {unique()}
StateSet TRUE {{ osg::StateSet {{ {unique()}
ModeList 1 {{ GL_LIGHT1 ON }} }} }}
Light TRUE {{ osg::Light {{ {unique()}
LightNum 1
Ambient 0 0 0 1
Diffuse {words(diffuse_color)} 1
Specular 0 0 0 1
Position {words(position)}
ConstantAttenuation {1 - position[3]}
QuadraticAttenuation {position[3]}
}} }} }}"""


def areaLight(corner, edge_u, edge_v, radiance):
    """Shines towards the cross product of its edges."""
    return f"""osgRayTrace::AreaLight {{ {unique()}
Corner {words(corner)}
EdgeU {words(edge_u)}
EdgeV {words(edge_v)}
Radiance {words(radiance)}
}}"""


def medium(scattering, absorption, anisotropy):
    return f"""osgRayTrace::Medium {{ {unique()}
Absorption {words([absorption] * 3)}
Scattering {words([scattering] * 3)}
Anisotropy {anisotropy}
}}"""


def fog(center, radius, text):
    """A ball of a medium."""
    return f"""osg::MatrixTransform {{ {unique()}
Children 1 {{ osgRayTrace::MediumVolume {{ {unique()}
Medium TRUE {{ {text} }}
Radius {radius:.9g}
}} }}
Matrix {{
1 0 0 0
0 1 0 0
0 0 1 0
{words(center)} 1
}} }}"""


def write(file, nodes):
    with open(file, "w", encoding="utf-8") as text:
        text.write("#Ascii Scene\n#Version 161\n#Generator OpenSceneGraph 3.6.5\n\n")
        text.write(f"osg::Group {{ {unique()}\n")
        text.write(f"StateSet TRUE {{ osg::StateSet {{ {unique()}\n")
        text.write("ModeList 2 { GL_LIGHT0 OFF\nGL_LIGHT1 ON } } }\n")
        text.write(f"Children {len(nodes)} {{\n" + "\n".join(nodes) + "\n} }\n")
