#!/usr/bin/env python3
# dataset.py - pictures with labels for a simulation, without a display: numpy alone.
# SPDX-License-Identifier: MIT
"""Renders a model from random places around it, and writes view.0000.npz and so on, each with:

    rgb       uint8    (height, width, 3)  picture
    distance  float32  (height, width)     from the eye; infinite where nothing is hit
    normal    float32  (height, width, 3)  of the surface, in world space
    label     uint32   (height, width)     row of labels.txt, which has the node's path; 0: nothing
    view, projection   (4, 4)              matrices for columns: projection @ view @ [x, y, z, 1]
"""
import argparse
import os

import numpy

import osgraytrace


class Labels:
    """Numbers node paths in the order in which they are met. Ids belong to one picture: levels of
    detail, for one, are other nodes from elsewhere. Paths are the same in all pictures."""

    def __init__(self):
        self.paths = [""]

    def of(self, renderer):
        paths = renderer.id_paths()
        for path in paths:
            if path not in self.paths:
                self.paths.append(path)
        label_of_id = numpy.array([self.paths.index(path) for path in paths], numpy.uint32)
        return label_of_id[renderer.channel("id").astype(int)]


def main():
    parser = argparse.ArgumentParser(description="Renders labelled pictures of a model.")
    parser.add_argument("model")
    parser.add_argument("folder")
    parser.add_argument("--views", type=int, default=8)
    parser.add_argument("--size", type=int, nargs=2, default=(320, 240))
    parser.add_argument("--passes", type=int, default=16)
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()

    os.makedirs(arguments.folder, exist_ok=True)
    random = numpy.random.default_rng(arguments.seed)
    scene = osgraytrace.Scene(arguments.model)
    renderer = osgraytrace.Renderer(scene, size=tuple(arguments.size), passes=arguments.passes)
    center, radius = scene.bound
    labels = Labels()
    for view in range(arguments.views):
        direction = random.normal(size=3)
        direction[2] = abs(direction[2])  # from above
        direction /= numpy.linalg.norm(direction)
        eye = center + direction * radius * random.uniform(2, 4)
        renderer.look_at(eye=eye, center=center, fovy=40)
        renderer.render()
        numpy.savez_compressed(
            os.path.join(arguments.folder, f"view.{view:04d}.npz"),
            rgb=renderer.display()[..., :3], distance=renderer.channel("distance"),
            normal=renderer.channel("normal"), label=labels.of(renderer),
            view=renderer.view_matrix, projection=renderer.projection_matrix)
    with open(os.path.join(arguments.folder, "labels.txt"), "w", encoding="utf-8") as stream:
        stream.writelines(f"{number}\t{path}\n" for number, path in enumerate(labels.paths))
    print(f"{arguments.views} views, {len(labels.paths) - 1} labels in {arguments.folder}")


if __name__ == "__main__":
    main()
