# surfaces.py - the error of pictures of ours after so many seconds beside that of pbrt-v3 and of
# Blender's Cycles, on scenes without media.
# SPDX-License-Identifier: MIT
"""Each renderer gets the same surfaces, lamps and view, one thread, the same number of bounces and
a box of a pixel as filter. A method's number of samples (passes, iterations) is the power of two
that takes about --seconds. Seconds are the processor's, the system's among them, without those to
set up: those of a picture of few samples are taken off. The error is relMSE, the mean of (x - r)^2
/ (r^2 + e^2) over all pixels but the worst 0.1 %, from one long picture r of ours, e a tenth of its
mean. So a mean that differs from it by more than 2 % and three standard errors is said, and the
exit code is 1. It is 2 if a program failed or a scene has what others are not given, and 77 if
Blender or pbrt-v3 is not there. The table goes to the standard output, pictures to --out."""
import argparse
import math
import os
import sys

import numpy

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "../cycles"))
import lampScenes  # noqa: E402
import noise  # noqa: E402
import pbrtScene  # noqa: E402
import pfm  # noqa: E402
import sceneFile  # noqa: E402
import smallVcmScene  # noqa: E402

BOUNCES = 12  # surfaces after the first that scatter a path
SPPM = '"sppm" "integer maxdepth" [{depth}] "integer numiterations" [{samples}] "float radius" [%g]'
BIDIRECTIONAL = '"bdpt" "integer maxdepth" [{depth}]'
PATH = '"path" "integer maxdepth" [{depth}] "string lightsamplestrategy" "%s"'
# A scene's file or function, methods of ours, that of the long picture, and the first radius of
# pbrt's sppm: the one with the least error, its blur included, of those that were tried.
SCENES = {
    "ajar": ("ajar.osgt", ["path", "sppm"], "sppm", 0.05),
    "hall": (lampScenes.hall, ["path"], "path", None),
    "rooms": (lampScenes.rooms, ["path"], "path", None),
    "pool": ("pool.osgt", ["photon-caustics", "sppm"], "photon-caustics", 0.4),
    "plates": ("veach_plates.osgt", ["path", "sppm"], "path", None),
    "necklace": ("necklace.osgt", ["path", "sppm", "photon-caustics"], "path", None),
    "cornell": ("cornell_box.osgt", ["path", "sppm"], "path", None),
}


def options():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=", ".join(SCENES) + "; all")
    parser.add_argument("--build", default=os.path.join(HERE, "../../build/release"))
    parser.add_argument("--pbrt", default="pbrt", help="pbrt-v3's program")
    parser.add_argument("--smallvcm", help="SmallVCM's program, patched: see smallVcmScene.py")
    parser.add_argument("--out", default="out/surfaces")
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--seconds", type=float, default=4)
    parser.add_argument("--reference", type=float, default=30, help="seconds of the long pictures")
    parser.add_argument("--only", help="methods whose names have this text")
    parser.add_argument(
        "--lights",
        choices=["spatial", "power"],
        help="how pbrt's path chooses lamps; by default spatial, and power in the hall",
    )
    given = parser.parse_args()
    unknown = [name for name in given.scenes if name not in SCENES]
    if unknown:
        parser.error(f"no scene {unknown[0]}; there are {', '.join(SCENES)}")
    given.scenes = given.scenes or list(SCENES)
    names = {it.name for scene in given.scenes for it in methodsOf(scene, given)}
    if given.only and not any(given.only in name for name in names):
        parser.error(f"no method {given.only}; there are {'; '.join(sorted(names))}")
    noise.needBlender()
    noise.need(given.pbrt, "--pbrt names the program of pbrt-v3")
    os.makedirs(given.out, exist_ok=True)
    return given


class Ours:
    def __init__(self, integrator):
        self.name, self.integrator, self.first = f"ours, {integrator}", integrator, 4
        self.seeds = (1, 2)

    def render(self, scene, jobs, given):
        seconds = []
        view = scene["view"]
        for file, samples, seed in jobs:
            command = [os.path.join(given.build, "bin/osgraytrace"), scene["file"]]
            command += ["-o", file + ".exr", "--size", str(given.size), str(given.size)]
            for name in ("eye", "center", "up"):
                command += ["--" + name, *sceneFile.text(view[name]).split()]
            command += ["--fovy", str(view["fovy"]), "--integrator", self.integrator]
            # pbrt counts where a path scatters, osgraytrace its ways from there.
            command += ["--max-bounces", str(BOUNCES + 1), "--threads", "1"]
            command += ["--passes", str(samples), "--seed", str(seed)]
            seconds.append(noise.run(command, file + ".log", env=noise.libraries(given.build)))
        files = [file + ".exr" for file, _, _ in jobs]
        noise.runBlender(BLENDER, {"convert": files}, given, "convert")
        return seconds


class Pbrt:
    seeds = (1,)  # its samplers know no other

    def __init__(self, name, integrator):
        self.name, self.integrator, self.first = f"pbrt-v3, {name}", integrator, 1

    def render(self, scene, jobs, given):
        seconds = []
        for file, samples, _ in jobs:
            integrator = self.integrator.format(samples=samples, depth=BOUNCES + 1)
            pbrtScene.write(file + ".pbrt", scene, file + ".pfm", given.size, samples, integrator)
            command = [given.pbrt, "--quiet", "--nthreads", "1", file + ".pbrt"]
            seconds.append(noise.run(command, file + ".log"))
            numpy.save(file, pfm.read(file + ".pfm"))
        return seconds


class SmallVcm:
    """Vertex connection and merging. Its radius is the program's own share of the scene's."""

    name, first, seeds = "SmallVCM, vcm", 4, (1, 2)

    def render(self, scene, jobs, given):
        seconds = []
        for file, samples, seed in jobs:
            smallVcmScene.write(file + ".txt", scene, given.size)
            command = [given.smallvcm, file + ".txt", "vcm", str(samples), str(seed)]
            command += [str(BOUNCES + 2), file + ".pfm", "0.003"]
            seconds.append(noise.run(command, file + ".log"))
            numpy.save(file, pfm.read(file + ".pfm")[::-1])  # its highest row is the first
        return seconds


class Cycles:
    name, first, seeds = "Cycles", 4, (1, 2)

    def render(self, scene, jobs, given):
        task = {"scene": scene["arrays"], "bounces": BOUNCES, "pictures": jobs}
        return noise.runBlender(BLENDER, task, given, "cycles")


BLENDER = os.path.join(HERE, "surfacesInBlender.py")


def prepare(name, given):
    """Returns the scene, with the files that Blender and osgraytrace read."""
    source = SCENES[name][0]
    folder = os.path.abspath(os.path.join(given.out, name))
    os.makedirs(folder, exist_ok=True)
    file = noise.inData(source) if isinstance(source, str) else os.path.join(folder, name + ".osgt")
    try:
        scene = sceneFile.read(file) if isinstance(source, str) else source()
    except ValueError as error:
        noise.fail(f"{file}: {error}")
    if not isinstance(source, str):
        sceneFile.write(file, scene)
    arrays = os.path.join(folder, "scene.npy")
    numpy.save(arrays, scene, allow_pickle=True)
    return {**scene, "file": os.path.abspath(file), "arrays": arrays, "folder": folder}


def fileOf(method, scene, what):
    return os.path.join(scene["folder"], method.name.replace(", ", "-") + f"-{what}")


def plan(method, scene, seconds, given):
    """Returns how many samples take about so many seconds, a smaller number, and the seconds of the
    latter, from pictures of few samples."""
    few, more = method.first, 4 * method.first
    jobs = [[fileOf(method, scene, it), it, 1] for it in (few, more)]
    start, end = method.render(scene, jobs, given)
    while end - start < seconds / 8:
        more *= 4
        end = method.render(scene, [[fileOf(method, scene, more), more, 1]], given)[0]
    return max(more, 2 ** round(math.log2(seconds * (more - few) / (end - start)))), start


def measure(method, scene, given):
    """Returns pictures of a number of samples, that number, and its seconds without the set-up."""
    samples, seconds = plan(method, scene, given.seconds, given)
    jobs = [[fileOf(method, scene, f"{it}"), samples, it] for it in ("a", "b")[: len(method.seeds)]]
    jobs = [[file, many, seed] for (file, many, _), seed in zip(jobs, method.seeds)]
    times = method.render(scene, jobs, given)
    spent = (numpy.mean(times) - seconds) * samples / (samples - method.first)
    if spent <= 0:
        noise.fail(f"{method.name}: {samples} samples take no longer than {method.first}")
    return [noise.load(file) for file, _, _ in jobs], samples, spent


def writePng(file, picture):
    """Writes a picture of NumPy's, lowest row first, brightness by its mean."""
    try:
        from PIL import Image
    except ImportError:
        return
    shown = numpy.clip(picture / (picture.mean() * 3), 0, 1) ** (1 / 2.2)
    Image.fromarray((shown[::-1] * 255).astype("uint8")).save(file + ".png")


def errorOf(pictures, reference):
    scale = 1 / reference.mean()
    return numpy.mean([noise.errors(it * scale, reference * scale, [])[0] for it in pictures])


def ratioOf(picture, reference):
    """Returns the mean of a picture over that of the reference, without the brightest 1 % of its
    pixels, which are glints of lamps; and the standard error."""
    grey, known = picture.mean(2).ravel(), reference.mean(2).ravel()
    most = numpy.argsort(known)[: -known.size // 100]
    mean = known[most].mean()
    spread = (grey - known)[most].std() / math.sqrt(most.size) / mean
    return grey[most].mean() / mean, spread


def methodsOf(name, given):
    """Returns the methods of a scene; SmallVCM, which knows diffuse surfaces alone, among them."""
    _, ours, _, radius = SCENES[name]
    # The spatial table of 2,000 lamps in all cells of the hall takes pbrt-v3 minutes to set up.
    choice = given.lights or ("power" if name == "hall" else "spatial")
    methods = [Ours(it) for it in ours] + [Pbrt("path", PATH % choice), Pbrt("bdpt", BIDIRECTIONAL)]
    if radius:
        methods.append(Pbrt("sppm", SPPM % radius))
    if given.smallvcm:
        methods.append(SmallVcm())
    return methods + [Cycles()]


def compareScene(name, given):
    """Prints the rows of a scene. Returns whether all means agree."""
    scene = prepare(name, given)
    given = argparse.Namespace(**{**vars(given), "out": scene["folder"]})
    diffuse = all(it["material"]["kind"] == "diffuse" for it in scene["parts"])
    long = Ours(SCENES[name][2])
    file = fileOf(long, scene, f"reference-{given.size}-{given.reference:g}")
    if not os.path.exists(file + ".npy"):
        samples, _ = plan(long, scene, given.reference, given)
        long.render(scene, [[file, samples, 1000]], given)
    reference = noise.load(file)
    writePng(file, reference)
    fine = True
    for method in methodsOf(name, given):
        if given.only and given.only not in method.name:
            continue
        if isinstance(method, SmallVcm) and not diffuse:
            continue
        pictures, samples, seconds = measure(method, scene, given)
        writePng(fileOf(method, scene, "a"), pictures[0])
        error = errorOf(pictures, reference)
        mean = numpy.mean(pictures, axis=0)
        ratio, spread = ratioOf(mean, reference)
        differs = " differs" * noise.differs(ratio, spread)
        fine = fine and not differs
        print(
            f"| {name} | {method.name} | {samples} | {seconds:.2f} | {error:.3g} |"
            f" {error * seconds:.3g} | {ratio:.3f} +- {spread:.3f}{differs} |",
            flush=True,
        )
    return fine


def main():
    given = options()
    print("| scene | method | samples | s | relMSE | relMSE x s | mean over ours |")
    print("| --- | --- | --- | --- | --- | --- | --- |", flush=True)
    fine = [compareScene(name, given) for name in given.scenes]
    return 0 if all(fine) else 1


if __name__ == "__main__":
    sys.exit(main())
