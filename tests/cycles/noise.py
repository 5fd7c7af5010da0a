# noise.py - the noise of a scene's pictures beside that of Blender's Cycles; for the scenes' scripts.
# SPDX-License-Identifier: MIT
"""Both renderers get the scene, one thread and the same number of bounces. The error of a picture of
64 samples is that from a long picture by the same renderer, as the two may differ by some percent:
relMSE, the mean of (x - r)^2 / (r^2 + 0.01), over all pixels but the worst 0.1 %. Seconds are the
processor's, without those to set up: 64/48 of the difference between pictures of 16 and of 64
samples. The table goes to the standard output."""
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


def parseArguments(description, name):
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--build", default=os.path.join(HERE, "../../build/release"))
    parser.add_argument("--out", default="out/" + name)
    parser.add_argument("--size", type=int, default=100)
    parser.add_argument("--reference", type=int, default=4096, help="samples of the long pictures")
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    return options


def needBlender():
    """Ends the program, with 77, if there is no Blender."""
    if not shutil.which("blender"):
        print("skipped: there is no Blender; Debian has it in the package blender")
        sys.exit(77)


def inData(model):
    return os.path.join(HERE, "../../data", model)


def run(command, log, **keywords):
    """Runs a program; its output goes to a file, which is named if it fails."""
    with open(log, "w", encoding="utf-8") as out:
        done = subprocess.run(command, stdout=out, stderr=subprocess.STDOUT, check=False, **keywords)
    if done.returncode != 0:
        print(f"{command[0]} failed, see {log}", file=sys.stderr)
        sys.exit(2)


def libraries(options):
    folder = os.path.abspath(os.path.join(options.build, "lib"))
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
        run(["osgconv", scene, obj], obj + ".log", env=libraries(options))
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
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        run(command, file + ".log", env=libraries(options))
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        used = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
        seconds.append(used)
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


def texts(values):
    return ", ".join(f"{value:.4f}" for value in values)


def compare(options, scene, task, parts=None):
    """Prints the table for a model and its script in Blender. task: the script, what it wants beside
    the common task, and "ours", more arguments of osgraytrace. parts: by name, functions of the size
    that return which pixels belong to a part of the picture. Returns the exit code 0; a program
    that fails ends all with 2."""
    parts = parts or {}
    needBlender()
    masks = [part(options.size) for part in parts.values()]
    names = ", ".join(["all", *parts])
    means = {}
    print(f"| renderer | relMSE: {names} | s | relMSE x s |\n| --- | --- | --- | --- |")
    for name, render in (("cycles", renderCycles), ("ours", renderOurs)):
        seconds = render(scene, task["script"], task, options)
        files = [file for file, _, _ in pictures(options, name)]
        reference = load(files[0])
        many = files[1 + len(SEEDS) :]
        found = numpy.mean([errors(load(file), reference, masks) for file in many], axis=0)
        few = numpy.mean(seconds[1 : 1 + len(SEEDS)])
        each = (numpy.mean(seconds[1 + len(SEEDS) :]) - few) / (MANY - FEW)
        products = texts(found * each * MANY)
        print(f"| {name} | {texts(found)} | {each * MANY:.2f} | {products} |", flush=True)
        means[name] = reference[masks[-1] if masks else slice(None)].reshape(-1, 3).mean(0)
    place = list(parts)[-1] if parts else "picture"
    print(f"mean of Cycles' {place} over ours, RGB:", (means["cycles"] / means["ours"]).round(3))
    return 0
