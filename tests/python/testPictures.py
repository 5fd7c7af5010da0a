# testPictures.py - pictures are those of C++, bit by bit; arrays share memory and keep it alive.
# SPDX-License-Identifier: MIT
import gc
import pickle
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy

import osgraytrace
from scenes import BOX, PROGRAM, SOURCE, TEXT, cornell_box, raw_pictures, read_png


class PicturesAreThoseOfCpp(unittest.TestCase):
    def test_every_image_has_the_bits_of_a_cpp_program(self):
        size, settings = (40, 24), {"seed": 7, "integrator": "path", "max-passes": 3, "threads": 2}
        model = SOURCE / "data" / "rings.osgt"
        expected = raw_pictures(model, size, **settings)

        renderer = osgraytrace.Renderer(model, size=size)
        for name, value in settings.items():
            renderer.settings[name] = value
        view, projection = (numpy.frombuffer(expected.pop(name)).reshape(4, 4).T
                            for name in ("view", "projection"))
        renderer.set_matrices(view, projection)
        renderer.set_clear_color((0.2, 0.2, 0.4, 1))  # not the model's, which C++ does not ask for
        renderer.render()
        images = {"color": renderer.color(), "display": renderer.display()}
        images.update((name, renderer.channel(name)) for name in renderer.channels)
        self.assertEqual(set(images), set(expected))
        for name, image in images.items():
            self.assertEqual(image[::-1].tobytes(), expected[name], name)
        self.assertGreater(images["color"].std(), 0)

    def test_a_picture_has_the_bits_of_osgraytrace(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "box.png"
            subprocess.run([PROGRAM, BOX, "-o", file, "--size", "48", "32", "--passes", "2",
                            "--seed", "5"], check=True, stdout=subprocess.DEVNULL)
            expected = read_png(file)
        renderer = cornell_box(seed=5)
        renderer.render()
        self.assertTrue(numpy.array_equal(renderer.display()[..., :3], expected))

        other = cornell_box(seed=6)
        other.render()
        self.assertFalse(numpy.array_equal(other.display()[..., :3], expected))

    def test_row_0_is_at_the_top(self):
        renderer = osgraytrace.Renderer(osgraytrace.Scene.from_text(TEXT), size=(8, 8), passes=1)
        renderer.look_at(eye=(0, -9, 0.5), center=(0, 0, 0.5), fovy=60)
        renderer.render()
        position = renderer.channel("position")
        seen = renderer.channel("id") > 0
        heights = [position[y, seen[y], 2].mean() for y in range(8) if seen[y].any()]
        self.assertEqual(heights, sorted(heights, reverse=True))

    def test_ids_have_the_paths_of_their_nodes(self):
        renderer = osgraytrace.Renderer(osgraytrace.Scene.from_text(TEXT), size=(20, 20), passes=1)
        renderer.look_at(eye=(0, -9, 20), center=(0, 0, 0), fovy=20)
        renderer.render()
        paths, ids = renderer.id_paths(), renderer.channel("id")
        height = renderer.channel("position")[..., 2]
        seen = {paths[int(number)]: set(height[ids == number].round(3).tolist())
                for number in numpy.unique(ids)}
        self.assertEqual(seen, {"": {0.0}, "Group/lower/square": {0.0}, "Group/triangle": {1.0}})
        self.assertEqual(cornell_box().id_paths(), [])

    def test_a_shutter_shows_each_pass_at_its_moment(self):
        eyes = {False: (0, -9, 20), True: (4, -9, 20)}

        def placed(passes, moment=0.0):
            renderer = osgraytrace.Renderer(osgraytrace.Scene.from_text(TEXT), size=(20, 20),
                                            passes=passes, seed=3)
            renderer.look_at(eye=eyes[moment >= 0.5], center=(0, 0, 0), fovy=20)
            return renderer

        def still(moment):
            renderer = placed(64, moment)
            renderer.render()
            return renderer.color()

        moments = []

        def pose(moment):
            moments.append(moment)
            renderer.look_at(eye=eyes[moment >= 0.5], center=(0, 0, 0), fovy=20)

        renderer = placed(64)
        view = renderer.view_matrix
        statistics = renderer.render(shutter=pose)
        self.assertEqual(statistics["passes"], 64)
        self.assertTrue(numpy.array_equal(renderer.view_matrix, view))
        self.assertEqual(moments.count(1.0), 1)
        inside = sorted(moment for moment in set(moments) if moment < 1.0)
        self.assertTrue(0.4 < numpy.mean(inside) < 0.6)
        expected = 0.5 * (still(0.0) + still(0.9))
        self.assertGreater(abs(still(0.0) - expected).mean(), 0.01)
        self.assertLess(abs(renderer.color() - expected).mean(), 0.003)

        def fail(moment):
            raise KeyError("from the shutter")

        with self.assertRaisesRegex(KeyError, "from the shutter"):
            renderer.render(shutter=fail)
        renderer.render()
        self.assertLess(abs(renderer.color() - still(0.0)).mean(), 0.003)

    def test_passes_of_two_renderers_add_up_to_those_of_one(self):
        whole = cornell_box(max_passes=4)
        whole.render()
        parts = []
        for first, end in ((0, 1), (1, 4)):
            part = cornell_box(max_passes=end)
            part.set_whole_passes(True)
            part.set_first_pass(first)
            part.render()
            parts.append(pickle.loads(pickle.dumps(part.pass_sums())))
        parts[0].add(parts[1])
        self.assertEqual(parts[0].passes, "0-3")
        self.assertTrue(numpy.array_equal(parts[0].color(), whole.color()))

        resumed = cornell_box(max_passes=6)
        resumed.set_pass_sums(parts[0])
        self.assertEqual(resumed.render()["passes"], 6)
        with self.assertRaisesRegex(ValueError, "picture|pass"):
            parts[0].add(parts[1])

    def test_older_pickles_of_passes_are_loaded_and_others_refused(self):
        renderer = cornell_box(max_passes=1)
        renderer.render()
        sums = renderer.pass_sums()
        state = sums.__getstate__()
        self.assertEqual(len(state), 9)
        older = osgraytrace.PassSums.__new__(osgraytrace.PassSums)
        older.__setstate__(state[:8])
        self.assertTrue(numpy.array_equal(older.color(), sums.color()))
        self.assertEqual(older.__getstate__(), state)
        with self.assertRaisesRegex(ValueError, "^these are no sums of passes$"):
            osgraytrace.PassSums.__new__(osgraytrace.PassSums).__setstate__(state[:7])


class ArraysShareMemory(unittest.TestCase):
    def test_shapes_and_types(self):
        renderer = cornell_box(size=(6, 4))
        renderer.render()
        self.assertEqual((renderer.color().shape, renderer.color().dtype), ((4, 6, 4), "float32"))
        self.assertEqual((renderer.display().shape, renderer.display().dtype), ((4, 6, 4), "uint8"))
        for name in renderer.channels:
            shape = (4, 6) if name in ("depth", "distance", "id") else (4, 6, 3)
            self.assertEqual(renderer.channel(name).shape, shape, name)

    def test_nothing_is_copied(self):
        renderer = cornell_box()
        renderer.render()
        for image in (renderer.color(), renderer.display(), renderer.channel("depth")):
            self.assertEqual(type(image.base).__name__, "PyCapsule")  # the image's own memory
            self.assertTrue(image[::-1].flags.c_contiguous)
            self.assertFalse(image.flags.owndata)

    def test_arrays_outlive_their_renderer(self):
        renderer = cornell_box()
        renderer.render()
        images = [renderer.color(), renderer.channel("normal")[3:5]]
        before = [image.copy() for image in images]
        del renderer
        gc.collect()
        others = [cornell_box(size=(64, 64)) for _ in range(3)]  # take the memory, if it were free
        for other in others:
            other.render()
        for image, copy in zip(images, before):
            self.assertTrue(numpy.array_equal(image, copy))

    def test_a_second_render_leaves_arrays_as_they_are(self):
        renderer = cornell_box()
        renderer.render()
        image, copy = renderer.color(), renderer.color().copy()
        renderer.settings["seed"] = 9
        renderer.render()
        self.assertTrue(numpy.array_equal(image, copy))
        self.assertFalse(numpy.array_equal(renderer.color(), copy))


class Views(unittest.TestCase):
    def test_matrices_are_applied_to_columns(self):
        renderer = cornell_box()
        renderer.look_at(eye=(1, 2, 3), center=(1, 9, 3))
        self.assertTrue(numpy.allclose(renderer.view_matrix @ [1, 7, 3, 1], [0, 0, -5, 1]))
        view, projection = renderer.view_matrix, renderer.projection_matrix
        renderer.set_matrices(view, projection)
        self.assertTrue(numpy.array_equal(renderer.view_matrix, view))
        self.assertTrue(numpy.array_equal(renderer.projection_matrix, projection))

    def test_points_project_to_their_pixels(self):
        renderer = cornell_box(size=(40, 30))
        renderer.render()
        position, distance = renderer.channel("position"), renderer.channel("distance")
        for y, x in ((3, 5), (20, 30), (28, 17)):
            eye = renderer.view_matrix @ [*position[y, x], 1]
            clip = renderer.projection_matrix @ eye
            pixel = (clip[:2] / clip[3] * [0.5, -0.5] + 0.5) * [40, 30]
            self.assertTrue(numpy.allclose(pixel, [x + 0.5, y + 0.5], atol=0.01), pixel)
            self.assertAlmostEqual(numpy.linalg.norm(eye[:3]) / distance[y, x], 1, places=4)

    def test_settings_have_types_and_spellings(self):
        settings = cornell_box(light_samples=9).settings
        self.assertEqual(settings["light-samples"], 9)
        settings.update(lightRadius=0.5, shadows=False, integrator="whitted")
        self.assertEqual([settings[name] for name in ("light-radius", "shadows", "integrator")],
                         [0.5, False, "whitted"])
        self.assertIs(type(settings["light-angle"]), float)
        self.assertIs(type(settings["max-passes"]), int)
        names = [option["name"] for option in osgraytrace.options()]
        self.assertEqual(list(settings), names)
        self.assertEqual(dict(settings)["seed"], 0)

    def test_statistics_have_all_members_of_cpp(self):
        header = (SOURCE / "osgRayTrace" / "Statistics").read_text()
        body = header[header.index("struct Statistics"):header.index("last frame of a view")]
        lines = [line.split("//")[0].strip() for line in body.splitlines()]
        text = " ".join(line for line in lines[2:] if line)
        members = {part.split("=")[0].split()[-1] for part in text.split(";") if part.strip()}
        renderer = cornell_box()
        statistics = renderer.render()
        self.assertEqual(set(statistics), members)
        self.assertEqual(statistics, renderer.statistics)
        self.assertEqual(statistics["passes"], 2)
        self.assertGreater(statistics["conversion"]["converted.geometry"], 0)


if __name__ == "__main__":
    unittest.main()
