# wax.py - how much noise paths below surfaces have beside those of Blender's Cycles: data/wax.osgt.
# SPDX-License-Identifier: MIT
"""Both renderers get the scene, one thread and the same number of bounces. The error of a picture of
64 samples is that from a long picture by the same renderer, as the two differ by some percent:
relMSE, the mean of (x - r)^2 / (r^2 + 0.01), over all pixels but the worst 0.1 %, and over the bust
alone. Seconds are the processor's, without those to set up: 64/48 of the difference between pictures
of 16 and of 64 samples. The table goes to the standard output. Exit code: 0 done, 2 a program
failed, 77 there is no Blender."""
import argparse
import json
import os
import resource
import shutil
import subprocess
import sys

import numpy

HERE = os.path.dirname(os.path.abspath(__file__))
SCENE = os.path.join(HERE, "../../data/wax.osgt")
FEW, MANY, SEEDS = 16, 64, (1, 2, 3, 4)
CYCLES_RADIUS = 12.56637  # RANDOM_WALK_FIXED_RADIUS takes 1 / (4 pi) of a radius as the mean way


def parseArguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", default=os.path.join(HERE, "../../build/release"))
    parser.add_argument("--out", default="out/wax")
    parser.add_argument("--size", type=int, default=100)
    parser.add_argument("--reference", type=int, default=4096, help="samples of the long pictures")
    return parser.parse_args()


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


def runBlender(task, options, name):
    file = os.path.join(options.out, name + ".json")
    with open(file, "w", encoding="utf-8") as text:
        json.dump({"size": options.size, "threads": 1, "bounces": 8, **task}, text)
    script = os.path.join(HERE, "waxInBlender.py")
    command = ["blender", "--background", "--factory-startup", "--python-exit-code", "3"]
    log = os.path.join(options.out, name + ".log")
    run([*command, "--python", script, "--", file], log)
    with open(log, encoding="utf-8") as text:
        return [float(line.split()[3]) for line in text if line.startswith("PICTURE")]


def pictures(options, renderer):
    """Returns the pictures to render: file without extension, samples, seed."""
    stem = os.path.join(os.path.abspath(options.out), renderer)
    return [[f"{stem}-reference", options.reference, 1000]] + [
        [f"{stem}-{samples}-{seed}", samples, seed] for samples in (FEW, MANY) for seed in SEEDS
    ]


def renderCycles(options):
    obj = os.path.abspath(os.path.join(options.out, "wax.obj"))
    run(["osgconv", SCENE, obj], obj + ".log", env=libraries(options))
    task = {"obj": obj, "method": "RANDOM_WALK_FIXED_RADIUS", "radius": CYCLES_RADIUS}
    return runBlender({**task, "pictures": pictures(options, "cycles")}, options, "cycles")


def renderOurs(options):
    seconds, files = [], []
    size = str(options.size)
    for file, samples, seed in pictures(options, "ours"):
        command = [os.path.join(options.build, "bin/osgraytrace"), SCENE, "-o", file + ".exr"]
        command += ["--size", size, size, "--passes", str(samples), "--seed", str(seed)]
        # Cycles counts where a path scatters, osgraytrace its ways from there.
        command += ["--max-bounces", "9", "--integrator", "path", "--threads", "1"]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        run(command, file + ".log", env=libraries(options))
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        used = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
        seconds.append(used)
        files.append(file + ".exr")
    runBlender({"convert": files}, options, "convert")
    return seconds


def load(file):
    return numpy.load(file + ".npy").astype(float)


def onBust(size):
    """Returns which pixels are well within the head and the chest: two ellipses."""
    y, x = (numpy.mgrid[0:size, 0:size] + 0.5) / size
    head = ((x - 0.5) / 0.11) ** 2 + ((y - 0.7) / 0.13) ** 2 < 1
    return head | (((x - 0.5) / 0.22) ** 2 + ((y - 0.33) / 0.1) ** 2 < 1)


def errors(picture, reference, bust):
    """Returns relMSE without the worst 0.1 % of the pixels, and that on the bust."""
    square = ((picture - reference) ** 2 / (reference**2 + 0.01)).mean(2)
    most = numpy.sort(square.ravel())[: -max(square.size // 1000, 1)]
    return most.mean(), square[bust].mean()


def main():
    options = parseArguments()
    if not shutil.which("blender"):
        print("skipped: there is no Blender; Debian has it in the package blender")
        return 77
    os.makedirs(options.out, exist_ok=True)
    bust = onBust(options.size)
    means = {}
    print("| renderer | relMSE, bust | s | relMSE x s, bust x s |\n| --- | --- | --- | --- |")
    for name, render in (("cycles", renderCycles), ("ours", renderOurs)):
        seconds = render(options)
        files = [file for file, _, _ in pictures(options, name)]
        reference = load(files[0])
        many = files[1 + len(SEEDS) :]
        found = numpy.mean([errors(load(file), reference, bust) for file in many], axis=0)
        few = numpy.mean(seconds[1 : 1 + len(SEEDS)])
        each = (numpy.mean(seconds[1 + len(SEEDS) :]) - few) / (MANY - FEW)
        products = found * each * MANY
        print(f"| {name} | {found[0]:.4f}, {found[1]:.4f} | {each * MANY:.2f} | "
              f"{products[0]:.4f}, {products[1]:.4f} |", flush=True)
        means[name] = reference[bust].mean(0)
    print("mean of Cycles' bust over ours, RGB:", (means["cycles"] / means["ours"]).round(3))
    return 0


if __name__ == "__main__":
    sys.exit(main())
