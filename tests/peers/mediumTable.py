# mediumTable.py - the noise of pictures of media by several renderers; for scripts of this folder.
# SPDX-License-Identifier: MIT
"""What is compared, and how, is told by tests/cycles/noise.py. A renderer is a function that
renders noise.pictures(options, name), which it gets, as arrays of NumPy, and returns the processor
seconds of each."""
import os
import sys

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../cycles"))
import noise  # noqa: E402


def ours(scene, options, bounces, *arguments, build=None, environment=None, arrays=None):
    """Returns a renderer that is osgraytrace. build: another build than that of the options; the
    environment has more variables for it. arrays: makes arrays of .exr files; by default Blender
    does."""
    build = build or options.build

    def render(pictures):
        seconds = []
        for file, samples, seed in pictures:
            command = [os.path.join(build, "bin/osgraytrace"), scene, "-o", file + ".exr"]
            command += ["--size", str(options.size), str(options.size), "--passes", str(samples)]
            command += ["--seed", str(seed), "--threads", "1", "--max-bounces", str(bounces)]
            variables = {**noise.libraries(build), **(environment or {})}
            seconds.append(noise.run([*command, *arguments], file + ".log", env=variables))
        files = [file + ".exr" for file, _, _ in pictures]
        (arrays or blenderArrays)(files, options)
        return seconds

    return render


def blenderArrays(files, options):
    noise.runBlender("fogInBlender.py", {"convert": files}, options, "convert")


def compare(options, renderers, one_reference=False):
    """Prints a table with a row for each renderer; the last one is what the others are compared
    with. Returns 1 if a mean differs from that of the last one (noise.differs), else 0.
    one_reference: the long picture of the last one is right for all. The means of short pictures
    are told then, but none is said to differ: few samples do not tell the error of a mean whose
    variance has no bound."""
    results, references = {}, {}
    for name, render in reversed(renderers.items()):
        long = noise.pictures(options, name)[:1]
        if not one_reference or not references:
            render(long)
            references[name] = noise.load(long[0][0])
    right = next(iter(references.values()))
    print("| renderer | relMSE | s | relMSE x s | mean |\n| --- | --- | --- | --- | --- |")
    for name, render in renderers.items():
        pictures, seeds = noise.pictures(options, name)[1:], len(noise.SEEDS)
        seconds = numpy.array(render(pictures))
        reference = references.get(name, right)
        many = [noise.load(file) for file, _, _ in pictures[seeds:]]
        found = [noise.errors(picture, reference, [])[0] for picture in many]
        each = (seconds[seeds:].mean() - seconds[:seeds].mean()) / (noise.MANY - noise.FEW)
        product = numpy.mean(found) * each * noise.MANY
        if one_reference:
            reference = numpy.mean(many, axis=0)
        spread = noise.spreadOf(many, options.reference)
        results[name] = product, reference.mean((0, 1)), spread
        row = [f"{number:.3g}" for number in (numpy.mean(found), each * noise.MANY, product)]
        print(f"| {name} | {' | '.join(row)} | {reference.mean():.5f} |", flush=True)
    last, mean, known = list(results.values())[-1]
    different = False
    for name, (product, other, spread) in list(results.items())[:-1]:
        print(f"{name}: relMSE x s is {product / last:.2f} times ours, means over ours", end=" ")
        ratio = other.mean() / mean.mean()
        wrong = not one_reference and noise.differs(ratio, max(spread, known))
        different = different or wrong
        print((other / mean).round(4), "differs" * wrong, flush=True)
    return 1 if different else 0
