# noise.py - the noise of a scene's pictures beside that of Blender's Cycles; for scenes' scripts.
# SPDX-License-Identifier: MIT
"""Both renderers get the scene, one thread and the same number of bounces. The error of a picture
of 64 samples is that from a long picture by the same renderer, as the two may differ by some
percent: relMSE, the mean of (x - r)^2 / (r^2 + 0.01), over all pixels but the worst 0.1 %. Seconds
are the processor's, without those to set up: 64/48 of the difference between pictures of 16 and of
64 samples. The table goes to the standard output. The exit code is 1 if the means differ by more
than the scene's tolerance and three standard errors, 2 if a program failed or is not there, and 77
if what the comparison is with is not there."""
import argparse
import json
import os
import resource
import shutil
import subprocess
import sys

import numpy

HERE = os.path.dirname(os.path.abspath(__file__))
FEW, MANY, SEEDS, BOUNCES = 16, 64, (1, 2, 3, 4), 8


def parseArguments(description, name, program=None):
    """program: the option that names another renderer's program, by default that of the path."""
    parser = argparse.ArgumentParser(description=description)
    if program:
        parser.add_argument("--" + program, default=program, help="the program")
    parser.add_argument("--build", default=os.path.join(HERE, "../../build/release"))
    parser.add_argument("--out", default="out/" + name)
    parser.add_argument("--size", type=int, default=100)
    parser.add_argument("--reference", type=int, default=4096, help="samples of the long pictures")
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    return options


def need(program, where):
    """Ends this program, with 77, if another is not there. where: tells where it may come from."""
    if not shutil.which(program):
        print(f"skipped: there is no {program}; {where}")
        sys.exit(77)


def needBlender():
    need("blender", "Debian has it in the package blender")


def inData(model):
    return os.path.join(HERE, "../../data", model)


def fail(message):
    """Ends this program, with 2."""
    print(message, file=sys.stderr)
    sys.exit(2)


def run(command, log, **keywords):
    """Runs a program; its output goes to a file, which is named if it fails. Returns the processor
    seconds, the system's among them."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(log, "w", encoding="utf-8") as out:
        try:
            done = subprocess.run(command, stdout=out, stderr=subprocess.STDOUT, **keywords)
        except OSError as error:
            fail(f"{command[0]} cannot be started: {error.strerror}")
    if done.returncode != 0:
        fail(f"{command[0]} failed, see {log}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def libraries(build):
    """Returns the environment in which programs of OSG find the plugins of a build."""
    folder = os.path.abspath(os.path.join(build, "lib"))
    return {**os.environ, "OSG_LIBRARY_PATH": f"{folder}:{folder}/osgPlugins-3.6.5"}


def runBlender(script, task, options, name):
    file = os.path.join(options.out, name + ".json")
    with open(file, "w", encoding="utf-8") as text:
        json.dump({"size": options.size, "threads": 1, "bounces": BOUNCES, **task}, text)
    command = ["blender", "--background", "--factory-startup", "--python-exit-code", "3"]
    log = os.path.join(options.out, name + ".log")
    run([*command, "--python", os.path.join(HERE, script), "--", file], log)
    with open(log, encoding="utf-8") as text:
        return [float(line.split()[3]) for line in text if line.startswith("PICTURE")]


def pictures(options, renderer):
    """Returns the pictures to render: file without extension, samples, seed."""
    stem = os.path.join(os.path.abspath(options.out), renderer)
    return [[f"{stem}-reference", options.reference, 1000]] + [
        [f"{stem}-{samples}-{seed}", samples, seed] for samples in (FEW, MANY) for seed in SEEDS
    ]


def renderCycles(scene, script, task, options):
    obj = os.path.abspath(os.path.join(options.out, "scene.obj"))
    if scene.endswith(".osgt"):
        run(["osgconv", scene, obj], obj + ".log", env=libraries(options.build))
    return runBlender(
        script, {**task, "obj": obj, "pictures": pictures(options, "cycles")}, options, "cycles"
    )


def renderOurs(scene, script, task, options):
    seconds, files = [], []
    size = str(options.size)
    for file, samples, seed in pictures(options, "ours"):
        command = [os.path.join(options.build, "bin/osgraytrace"), scene, "-o", file + ".exr"]
        command += ["--size", size, size, "--passes", str(samples), "--seed", str(seed)]
        # Cycles counts where a path scatters, osgraytrace its ways from there.
        bounces = str(task.get("bounces", BOUNCES) + 1)
        command += ["--max-bounces", bounces, "--integrator", "path", "--threads", "1"]
        command += task.get("ours", [])
        seconds.append(run(command, file + ".log", env=libraries(options.build)))
        files.append(file + ".exr")
    runBlender(script, {"convert": files}, options, "convert")
    return seconds


def load(file):
    return numpy.load(file + ".npy").astype(float)


def errors(picture, reference, parts):
    """Returns relMSE without the worst 0.1 % of the pixels, and that of each part."""
    square = ((picture - reference) ** 2 / (reference**2 + 0.01)).mean(2)
    most = numpy.sort(square.ravel())[: -max(square.size // 1000, 1)]
    return [most.mean()] + [square[part].mean() for part in parts]


def differs(ratio, spread, tolerance=0.02):
    """Returns whether a ratio of means, which has a standard error, is not 1."""
    return bool(abs(ratio - 1) > tolerance + 3 * spread)


def spreadOf(pictures, samples):
    """Returns the relative standard error of the mean of a picture of so many samples, from
    pictures of MANY samples."""
    means = [picture.mean() for picture in pictures]
    return numpy.std(means, ddof=1) / numpy.mean(means) * (MANY / samples) ** 0.5


def texts(values):
    return ", ".join(f"{value:.4f}" for value in values)


def compare(options, scene, task, parts=None, tolerance=0.02):
    """Prints the table for a model and its script in Blender. task: the script, what it wants
    beside the common task, and "ours", more arguments of osgraytrace. parts: by name, functions of
    the size that return which pixels belong to a part of the picture. Returns the exit code: 1 if
    the means of the last part, or of the picture, differ by more than the tolerance."""
    parts = parts or {}
    needBlender()
    masks = [part(options.size) for part in parts.values()]
    names = ", ".join(["all", *parts])
    means, spreads = {}, []
    print(f"| renderer | relMSE: {names} | s | relMSE x s |\n| --- | --- | --- | --- |")
    for name, render in (("cycles", renderCycles), ("ours", renderOurs)):
        seconds = render(scene, task["script"], task, options)
        files = [file for file, _, _ in pictures(options, name)]
        reference = load(files[0])
        many = [load(file) for file in files[1 + len(SEEDS) :]]
        found = numpy.mean([errors(picture, reference, masks) for picture in many], axis=0)
        few = numpy.mean(seconds[1 : 1 + len(SEEDS)])
        each = (numpy.mean(seconds[1 + len(SEEDS) :]) - few) / (MANY - FEW)
        products = texts(found * each * MANY)
        print(f"| {name} | {texts(found)} | {each * MANY:.2f} | {products} |", flush=True)
        pixels = masks[-1] if masks else slice(None)
        means[name] = reference[pixels].reshape(-1, 3).mean(0)
        spreads.append(spreadOf([picture[pixels] for picture in many], options.reference))
    place = list(parts)[-1] if parts else "picture"
    ratio = means["cycles"] / means["ours"]
    different = differs(means["cycles"].mean() / means["ours"].mean(), max(spreads), tolerance)
    print(f"mean of Cycles' {place} over ours, RGB:", ratio.round(3), "differs" * different)
    return 1 if different else 0
