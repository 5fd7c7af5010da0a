# lampScenes.py - a hall and rooms under a thousand lamps, as in osgraytracebench's mode "lamps".
# SPDX-License-Identifier: MIT
"""See sceneFile.py for what a scene is. Places are those of other random numbers than in
apps/osgraytracebench/scenes/LampScenes.cpp; sizes, counts and powers are the same."""
import numpy

GREY = {"kind": "diffuse", "color": numpy.full(3, 0.6)}
TOTAL, SIDE = 25000.0, 0.5  # intensity straight down of all lamps [W/sr], a lamp's side [m]


def quads(corners):
    points = numpy.array(corners, float).reshape(-1, 3)
    first = 4 * numpy.arange(len(points) // 4)[:, None]
    triangles = numpy.concatenate([first + [0, 1, 2], first + [0, 2, 3]])
    return {"points": points, "triangles": triangles, "normals": None, "material": GREY}


def quad(corner, u, v):
    corner, u, v = (numpy.array(it, float) for it in (corner, u, v))
    return [corner, corner + u, corner + u + v, corner + v]


def box(low, high):
    (x, y, z), (dx, dy, dz) = low, numpy.array(high, float) - low
    u, v, w = (dx, 0, 0), (0, dy, 0), (0, 0, dz)
    corners = quad((x, y, z), v, u) + quad((x, y, z + dz), u, v)
    corners += quad((x, y, z), u, w) + quad((x, y + dy, z), w, u)
    corners += quad((x, y, z), w, v) + quad((x + dx, y, z), v, w)
    return quads(corners)


def lamp(place, count):
    radiance = numpy.full(3, TOTAL / count / SIDE**2)
    corner = numpy.array(place) - (SIDE / 2, SIDE / 2, 0)
    return (corner, numpy.array((0, SIDE, 0)), numpy.array((SIDE, 0, 0)), radiance)


def view(eye, center):
    eye, center = numpy.array(eye, float), numpy.array(center, float)
    return {"eye": eye, "center": center, "up": numpy.array((0, 0, 1.0)), "fovy": 60.0}


def hall(lamps=1000):
    """Returns a hall of 100 x 100 x 6 m with 200 boxes on its floor."""
    number = numpy.random.default_rng(7).uniform
    x, y, z, o = (100, 0, 0), (0, 100, 0), (0, 0, 6), (0, 0, 0)
    sides = quad(o, x, y) + quad(z, y, x) + quad(o, z, x) + quad(y, x, z) + quad(o, y, z)
    parts = [quads(sides + quad(x, z, y))]
    for _ in range(200):
        low = numpy.array((number(2, 96), number(8, 96), 0))
        parts.append(box(low, low + number(0.5, 3, 3)))
    places = [(number(1, 99), number(1, 99), number(5, 5.9)) for _ in range(lamps)]
    lit = [lamp(place, lamps) for place in places]
    return {"view": view((50, 10, 4.9), (50, 20, -1.4)), "parts": parts, "lamps": lit}


def rooms(lamps=1000):
    """Returns 10 x 10 rooms of 10 x 10 x 3 m that are joined by doors."""
    number, top = numpy.random.default_rng(11).uniform, 3.0
    x, y = (100, 0, 0), (0, 100, 0)
    parts = [quads(quad((0, 0, 0), x, y) + quad((0, 0, top), y, x))]
    for wall in range(11):
        at, gap = 10.0 * wall, 5.0 if wall in (0, 10) else 4.5
        for start in range(0, 100, 10):
            for begin in (start, start + 10 - gap):
                parts.append(box((at - 0.1, begin, 0), (at + 0.1, begin + gap, top)))
                parts.append(box((begin, at - 0.1, 0), (begin + gap, at + 0.1, top)))
    lit = []
    for index in range(lamps):
        row, column = divmod((index * 37) % 100, 10)
        place = (10 * column + number(1, 9), 10 * row + number(1, 9), number(2.5, 2.95))
        lit.append(lamp(place, lamps))
    return {"view": view((41, 41, 2.4), (43, 44, 0.1)), "parts": parts, "lamps": lit}
