#!/usr/bin/env python3
# turntable.py - a model from all sides, as numbered PNG files. It needs numpy alone.
# SPDX-License-Identifier: MIT
import argparse
import math
import struct
import zlib

import numpy

import osgraytrace


def write_png(file, picture):
    """Writes an array of uint8, (height, width, 3)."""
    def chunk(kind, content):
        check = zlib.crc32(kind + content)
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", check)

    height, width = picture.shape[:2]
    rows = numpy.zeros((height, 1 + 3 * width), numpy.uint8)  # each begins with its filter, none
    rows[:, 1:] = picture.reshape(height, 3 * width)
    with open(file, "wb") as stream:
        stream.write(b"\x89PNG\r\n\x1a\n")
        stream.write(chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)))
        stream.write(chunk(b"IDAT", zlib.compress(rows.tobytes())))
        stream.write(chunk(b"IEND", b""))


def main():
    parser = argparse.ArgumentParser(description="Renders a model from all sides.")
    parser.add_argument("model")
    parser.add_argument("pictures", help="names of the pictures: out.%%03d.png")
    parser.add_argument("--frames", type=int, default=36)
    parser.add_argument("--size", type=int, nargs=2, default=(640, 480))
    parser.add_argument("--error", type=float, default=0.05, help="noise that is left")
    arguments = parser.parse_args()

    scene = osgraytrace.Scene(arguments.model)
    renderer = osgraytrace.Renderer(scene, size=tuple(arguments.size), denoise="filter")
    center, radius = scene.bound
    for frame in range(arguments.frames):
        angle = 2 * math.pi * frame / arguments.frames
        offset = 3.5 * radius * numpy.array((math.sin(angle), -math.cos(angle), 0.35))
        renderer.look_at(eye=center + offset, center=center, fovy=35)
        statistics = renderer.render(seconds=60, error=arguments.error)
        file = arguments.pictures % frame
        write_png(file, renderer.display()[..., :3])
        print(f"{file}: {statistics['passes']} passes, error {statistics['relativeError']:.3f}")


if __name__ == "__main__":
    main()
