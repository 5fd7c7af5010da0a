# testThreads.py - progress functions, other threads, Ctrl-C, and the interpreter's end.
# SPDX-License-Identifier: MIT
import os
import signal
import threading
import unittest

import numpy

import osgraytrace
from scenes import SOURCE, cornell_box, run_python

LONG = 1 << 20  # passes that nobody waits for


class Progress(unittest.TestCase):
    def test_it_is_called_after_each_pass(self):
        passes = []
        renderer = cornell_box(max_passes=5)
        renderer.render(progress=lambda statistics: passes.append(statistics["passes"]))
        self.assertEqual(passes, [1, 2, 3, 4, 5])

    def test_false_ends_the_render_and_the_next_one_goes_on(self):
        renderer = cornell_box(max_passes=6)
        statistics = renderer.render(progress=lambda statistics: statistics["passes"] < 2)
        self.assertEqual(statistics["passes"], 2)
        self.assertEqual(renderer.render()["passes"], 6)
        whole = cornell_box(max_passes=6)
        whole.render()
        self.assertTrue(numpy.array_equal(renderer.color(), whole.color()))

    def test_exceptions_come_out_of_render(self):
        class Own(Exception):
            pass

        def fail(statistics):
            raise Own("from the progress function")

        renderer = cornell_box(max_passes=LONG)
        with self.assertRaisesRegex(Own, "from the progress function"):
            renderer.render(progress=fail)
        self.assertEqual(renderer.statistics["passes"], 1)

    def test_it_may_look_at_the_picture_but_not_render(self):
        shapes, problems = [], []

        def look(statistics):
            shapes.append(renderer.display().shape)
            try:
                renderer.render()
            except osgraytrace.RenderError as problem:
                problems.append(str(problem))

        renderer = cornell_box()
        renderer.render(progress=look)
        self.assertEqual(shapes, [(32, 48, 4)] * 2)
        self.assertEqual(problems, ["a progress function cannot render"] * 2)


class OtherThreads(unittest.TestCase):
    def test_python_goes_on_while_a_picture_is_rendered(self):
        """The thread would not get out of start() if render() kept the interpreter's lock."""
        renderer, began = cornell_box(max_passes=LONG), threading.Event()
        thread = threading.Thread(target=renderer.render,
                                  kwargs={"progress": lambda statistics: began.set()})
        thread.start()
        began.wait()
        counted = 0
        while counted < 100000:
            counted += 1
        self.assertTrue(thread.is_alive())
        renderer.cancel()
        thread.join()
        self.assertEqual(renderer.statistics["imageShare"], 1)

    def test_renderers_of_one_scene_render_at_once(self):
        scene = osgraytrace.Scene(SOURCE / "data" / "rings.osgt")
        renderers = [osgraytrace.Renderer(scene, size=(24, 16), passes=2, threads=1, seed=seed % 2)
                     for seed in range(6)]
        threads = [threading.Thread(target=renderer.render) for renderer in renderers]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for renderer in renderers[2:]:
            same = renderers[renderer.settings["seed"]]
            self.assertTrue(numpy.array_equal(renderer.color(), same.color()))

    def test_threads_share_a_renderer_and_wait_for_each_other(self):
        renderer, pictures = cornell_box(), []

        def use(seed):
            renderer.settings["seed"] = seed
            renderer.size = (16 + seed, 12)
            renderer.render()
            pictures.append(renderer.display().shape)

        threads = [threading.Thread(target=use, args=(seed,)) for seed in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(pictures), 8)

    def test_ctrl_c_ends_a_render(self):
        renderer = cornell_box(max_passes=LONG)
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            renderer.render()
        timer.join()
        self.assertGreater(renderer.statistics["passes"], 0)


class TheEnd(unittest.TestCase):
    RENDER = ("import osgraytrace, threading, time\n"
              f"box = {str(SOURCE / 'data' / 'cornell_box.osgt')!r}\n"
              "renderer = osgraytrace.Renderer(box, size=(32, 24), max_passes=1 << 20)\n")

    def test_the_interpreter_ends_while_threads_render(self):
        code, output = run_python(
            self.RENDER + "def render(began):\n"
            "    own = osgraytrace.Renderer(scene, size=(8, 8), max_passes=1 << 20, threads=1)\n"
            "    own.render(progress=lambda statistics: began.set())\n"
            "scene, begun = renderer.scene, [threading.Event() for _ in range(8)]\n"
            "for began in begun:\n"
            "    threading.Thread(target=render, args=(began,), daemon=True).start()\n"
            "for began in begun: began.wait()\n")
        self.assertEqual((code, output), (0, ""))

    def test_the_interpreter_ends_with_arrays_and_renderers_alive(self):
        code, output = run_python(self.RENDER + "renderer.settings['max-passes'] = 1\n"
                                  "renderer.render()\n"
                                  "import builtins\n"
                                  "builtins.kept = [renderer, renderer.color()]\n")
        self.assertEqual((code, output), (0, ""))

    def test_a_forked_process_renders(self):
        code, output = run_python(
            self.RENDER + "import os\n"
            "renderer.settings['max-passes'] = 1\n"
            "renderer.render()\n"
            "if os.fork() == 0:\n"
            "    other = osgraytrace.Renderer(box, size=(32, 24), max_passes=2)\n"
            "    print(other.render()['passes'], flush=True)\n"
            "    os._exit(0)\n"
            "os.wait()\n")
        self.assertEqual((code, output), (0, "2\n"))


if __name__ == "__main__":
    unittest.main()
