# objParts.py - reads the objects of an OBJ file; for scenes in other renderers.
# SPDX-License-Identifier: MIT


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
