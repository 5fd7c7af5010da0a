# testRefusals.py - wrong input raises, by name, and never ends the interpreter.
# SPDX-License-Identifier: MIT
import tempfile
import unittest
from pathlib import Path

import numpy

import osgraytrace
from scenes import BOX, TEXT, cornell_box


class WrongInputRaises(unittest.TestCase):
    def test_models_that_cannot_be_read(self):
        with self.assertRaisesRegex(osgraytrace.LoadError, "missing.osgt"):
            osgraytrace.Scene("missing.osgt")
        with self.assertRaises(osgraytrace.LoadError):
            osgraytrace.Scene()
        with tempfile.TemporaryDirectory() as folder:
            cut = Path(folder) / "cut.osgt"
            cut.write_text(TEXT[:300])
            with self.assertRaisesRegex(osgraytrace.LoadError, "cut short"):
                osgraytrace.Scene(cut)
        for text, reason in (("", "#Ascii"), ("osg::Group {", "#Ascii"), (TEXT[:300], "cut short")):
            with self.assertRaisesRegex(osgraytrace.LoadError, reason):
                osgraytrace.Scene.from_text(text)
        for other in (3, None, object()):
            with self.assertRaises(TypeError):
                osgraytrace.Scene(other)
            with self.assertRaises(TypeError):
                osgraytrace.Renderer(other)

    def test_options_by_name(self):
        settings = cornell_box().settings
        with self.assertRaisesRegex(ValueError, "'ligth-samples'.*'light-samples'"):
            settings["ligth-samples"] = 4
        with self.assertRaisesRegex(ValueError, "no option 'xyzzy'"):
            settings["xyzzy"]
        with self.assertRaisesRegex(ValueError, r"light-samples: '0'.*1 \.\. 4096"):
            settings["light-samples"] = 0
        with self.assertRaisesRegex(ValueError, "integrator: 'fast'.*whitted"):
            settings["integrator"] = "fast"
        with self.assertRaisesRegex(ValueError, "materials: 'missing.json'"):
            settings["materials"] = "missing.json"
        with self.assertRaises(TypeError):
            settings["seed"] = [1]
        with self.assertRaisesRegex(ValueError, "no option 'colour'"):
            osgraytrace.Renderer(BOX, colour=1)
        self.assertEqual((settings["light-samples"], settings["materials"]), (4, "none"))
        self.assertNotIn("xyzzy", settings)
        self.assertIn("lightSamples", settings)

    def test_views(self):
        renderer = cornell_box()
        for wrong in (dict(eye=(0, 0, 0), center=(0, 0, 0)), dict(eye=(0, 0, 1), center=(0, 0, 0)),
                      dict(eye=(0, 0, float("nan")), center=(0, 0, 0)),
                      dict(eye=(0, 1, 0), center=(0, 0, 0), fovy=180)):
            with self.assertRaises(ValueError, msg=str(wrong)):
                renderer.look_at(**wrong)
        unit = numpy.eye(4)
        for wrong in (numpy.eye(3), numpy.zeros(16), numpy.full((4, 4), float("inf"))):
            with self.assertRaisesRegex(ValueError, "view is not"):
                renderer.set_matrices(wrong, unit)
        with self.assertRaisesRegex(ValueError, "no camera 'roof'"):
            renderer.use_camera("roof")
        renderer.set_matrices(numpy.zeros((4, 4)), unit)
        with self.assertRaisesRegex(osgraytrace.RenderError, "inverted"):
            renderer.render()

    def test_sizes(self):
        for size in ((0, 5), (-4, 4), (1 << 15, 1 << 15)):
            renderer = cornell_box(size=size)
            with self.assertRaisesRegex(osgraytrace.RenderError, "pixels"):
                renderer.render()
            with self.assertRaises(osgraytrace.RenderError):
                renderer.color()
        with self.assertRaises(TypeError):
            cornell_box(size=(1 << 40, 1))

    def test_images(self):
        renderer = cornell_box()
        for ask in (renderer.color, renderer.display, lambda: renderer.channel("depth")):
            with self.assertRaisesRegex(osgraytrace.RenderError, "no picture yet"):
                ask()
        with self.assertRaisesRegex(ValueError, "no channel 'Z'.*depth"):
            renderer.channel("Z")
        with self.assertRaises(ValueError):
            renderer.pass_sums().color()

    def test_renders(self):
        renderer = cornell_box()
        for wrong in (dict(seconds=-1), dict(error=float("nan"))):
            with self.assertRaises(ValueError):
                renderer.render(**wrong)
        with self.assertRaisesRegex(TypeError, "progress"):
            renderer.render(progress=3)
        with self.assertRaisesRegex(TypeError, "shutter"):
            renderer.render(shutter=0.5)

    def test_sums_of_another_picture(self):
        renderer, other = cornell_box(), cornell_box(seed=3)
        renderer.render()
        other.render()
        sums = renderer.pass_sums()
        with self.assertRaises(ValueError):
            sums.add(other.pass_sums())
        other.set_pass_sums(sums)
        with self.assertRaisesRegex(osgraytrace.RenderError, "seed"):
            other.render()

    def test_damaged_sums(self):
        renderer = cornell_box()
        renderer.render()
        sums = renderer.pass_sums()
        state = list(sums.__getstate__())
        for place, wrong in ((0, 1 << 20), (2, "0-99999999999"), (4, b"abc")):
            damaged = osgraytrace.PassSums.__new__(osgraytrace.PassSums)
            damaged.__setstate__(tuple(state[:place] + [wrong] + state[place + 1:]))
            renderer.set_pass_sums(damaged)
            with self.assertRaises(osgraytrace.RenderError):
                renderer.render()

    def test_subclasses_that_forget_the_constructor(self):
        class Forgetful(osgraytrace.Renderer):
            def __init__(self):
                pass

        with self.assertRaises(TypeError):
            Forgetful()


if __name__ == "__main__":
    unittest.main()
