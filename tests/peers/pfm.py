# pfm.py - reads pictures in the format PFM, which other renderers write.
# SPDX-License-Identifier: MIT
import numpy


def read(picture):
    """Returns the pixels of a .pfm file, the lowest row first."""
    with open(picture, "rb") as data:
        kind, size, scale = (data.readline().split() for _ in range(3))
        if kind != [b"PF"]:
            raise ValueError(f"{picture} has no colours")
        order = "<f4" if float(scale[0]) < 0 else ">f4"
        width, height = (int(it) for it in size)
        return numpy.frombuffer(data.read(), order).reshape(height, width, 3).astype(numpy.float32)
