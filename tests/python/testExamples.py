# testExamples.py - the example scripts run as their users run them.
# SPDX-License-Identifier: MIT
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy

from scenes import SOURCE, TEXT, read_png

EXAMPLES = SOURCE / "apps" / "python" / "examples"


def run(folder, script, *arguments):
    subprocess.run([sys.executable, "-B", EXAMPLES / script, *map(str, arguments)], cwd=folder,
                   check=True, stdout=subprocess.DEVNULL)


class Examples(unittest.TestCase):
    def test_turntable_shows_other_sides(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "model.osgt").write_text(TEXT)
            run(folder, "turntable.py", "model.osgt", "out.%02d.png", "--frames", 4,
                "--size", 32, 24, "--error", 0.5)
            pictures = [read_png(Path(folder) / f"out.{i:02d}.png") for i in range(4)]
        for picture in pictures:
            self.assertEqual(picture.shape, (24, 32, 3))
            self.assertGreater(picture.std(), 5)
        self.assertGreater(numpy.abs(pictures[0].astype(int) - pictures[2]).max(), 20)

    def test_labels_depths_and_normals_agree(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "model.osgt").write_text(TEXT)
            run(folder, "dataset.py", "model.osgt", "set", "--views", 3, "--size", 40, 30,
                "--passes", 1)
            rows = (Path(folder) / "set" / "labels.txt").read_text().splitlines()
            views = [numpy.load(file) for file in sorted((Path(folder) / "set").glob("*.npz"))]
        labels = {path: int(number) for number, path in (row.split("\t") for row in rows)}
        self.assertEqual(set(labels), {"", "Group/lower/square", "Group/triangle"})
        self.assertEqual(len(views), 3)
        for view in views:
            self.assertEqual(view["rgb"].shape, (30, 40, 3))
            inverse = numpy.linalg.inv(view["projection"] @ view["view"])
            eye = numpy.linalg.inv(view["view"])[:3, 3]
            for path, height in (("Group/lower/square", 0), ("Group/triangle", 1)):
                rows, columns = numpy.nonzero(view["label"] == labels[path])
                self.assertGreater(len(rows), 10)
                for y, x in list(zip(rows, columns))[::7]:
                    far = inverse @ [(x + 0.5) / 20 - 1, 1 - (y + 0.5) / 15, 1, 1]
                    ray = far[:3] / far[3] - eye
                    point = eye + ray / numpy.linalg.norm(ray) * view["distance"][y, x]
                    self.assertAlmostEqual(point[2], height, places=3)
                    self.assertAlmostEqual(abs(view["normal"][y, x, 2]), 1, places=5)


if __name__ == "__main__":
    unittest.main()
