# scenes.py - what the tests of the Python module share: models, C++'s pictures, other interpreters.
# SPDX-License-Identifier: MIT
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

import osgraytrace

SOURCE = Path(os.environ["OSGRAYTRACE_TEST_SOURCE"])
RAW_PICTURES = os.environ["OSGRAYTRACE_TEST_RAW_PICTURES"]
PROGRAM = os.environ["OSGRAYTRACE_TEST_PROGRAM"]
BOX = SOURCE / "data" / "cornell_box.osgt"

# A red triangle over a green square, in OSG's text format; both have names.
TEXT = """#Ascii Scene
#Version 161
#Generator OpenSceneGraph 3.6.5

osg::Group {
  UniqueID 1
  Children 2 {
    osg::MatrixTransform {
      UniqueID 2
      Name "lower"
      Children 1 {
        osg::Geometry {
          UniqueID 3
          Name "square"
          PrimitiveSetList 1 {
            osg::DrawArrays {
              UniqueID 4
              Mode TRIANGLE_FAN
              Count 4
            }
          }
          VertexArray TRUE {
            osg::Vec3Array {
              UniqueID 5
              Binding BIND_PER_VERTEX
              vector 4 {
                -2 -2 0
                2 -2 0
                2 2 0
                -2 2 0
              }
            }
          }
        }
      }
      Matrix {
        1 0 0 0
        0 1 0 0
        0 0 1 0
        0 0 0 1
      }
    }
    osg::Geometry {
      UniqueID 6
      Name "triangle"
      PrimitiveSetList 1 {
        osg::DrawArrays {
          UniqueID 7
          Mode TRIANGLES
          Count 3
        }
      }
      VertexArray TRUE {
        osg::Vec3Array {
          UniqueID 8
          Binding BIND_PER_VERTEX
          vector 3 {
            -1 -1 1
            1 -1 1
            0 1 1
          }
        }
      }
    }
  }
}
"""


def cornell_box(size=(48, 32), **settings):
    """Returns a renderer of a small picture of the Cornell box: two passes on two threads."""
    return osgraytrace.Renderer(BOX, size=size, **{"max_passes": 2, "threads": 2, **settings})


def raw_pictures(model, size, **settings):
    """Returns the images of a C++ program, bottom up, as bytes by their names."""
    with tempfile.TemporaryDirectory() as folder:
        options = [str(part) for setting in settings.items() for part in setting]
        subprocess.run([RAW_PICTURES, str(model), folder, *map(str, size), *options], check=True)
        return {file.name: file.read_bytes() for file in Path(folder).iterdir()}


def run_python(script, timeout=60):
    """Runs a script in an interpreter of its own; returns its exit code and what it printed."""
    done = subprocess.run([sys.executable, "-B", "-c", script], timeout=timeout, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return done.returncode, done.stdout


def read_png(file):
    """Returns the pixels of a PNG of 8 bits a channel without interlace, row 0 at the top."""
    import struct
    import zlib

    data, place, packed = Path(file).read_bytes(), 8, b""
    while place < len(data):
        length, kind = struct.unpack(">I4s", data[place:place + 8])
        content = data[place + 8:place + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", content[:10])
        if kind == b"IDAT":
            packed += content
        place += 12 + length
    assert depth == 8 and color == 2, "not an RGB picture of 8 bits"
    step = 3 * width
    lines = numpy.frombuffer(zlib.decompress(packed), numpy.uint8).reshape(height, step + 1)
    rows = numpy.zeros((height + 1, step + 3), int)  # a row above and a pixel to the left are 0
    for y in range(height):
        above, row = rows[y], rows[y + 1]
        for x in range(3, step + 3):
            a, b, c = row[x - 3], above[x], above[x - 3]
            nearest = min((a, b, c), key=lambda value: abs(a + b - c - value))  # the first of equals
            row[x] = (lines[y, x - 2] + (0, a, b, (a + b) // 2, nearest)[lines[y, 0]]) % 256
    return rows[1:, 3:].reshape(height, width, 3).astype(numpy.uint8)
