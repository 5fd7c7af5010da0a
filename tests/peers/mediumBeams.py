# mediumBeams.py - how fast light that a glass ball gathers in gas converges beside Tungsten's.
# SPDX-License-Identifier: MIT
"""A closed room is full of gas, with a glass ball under a small lamp. Each renderer gets numbers of
passes and one thread. relMSE is that of noise.py against our long picture, without the pixels
around the lamp, which is smaller than one. The table has relMSE and processor seconds, less those
of the fewest passes, and when 3e-3 is reached, by powers between the rows. What is beyond them is a
guess. The exit code is 2 if a program failed, or if its passes are too few to be timed."""
import json
import os

import mediumTable
import noise
import numpy
import osgText
import pfm

LOW, HIGH = (-1.0, 0.0, -1.0), (1.0, 2.0, 2.6)  # corners of the room [m]
BALL, RADIUS, INDEX = (0.1, 1.15, 0.0), 0.35, 1.5
LAMP, SIDE, RADIANCE = (0.0, 1.98, 0.0), 0.01, (2e4, 1.8e4, 1.5e4)
SCATTERING, ABSORPTION = 0.4, 0.02
EYE, CENTER, FOVY = (0.0, 1.0, 2.5), (0.0, 1.0, 0.0), 50.0
BOUNCES, TARGET = 16, 3e-3
RENDERERS = ["sppm", "photon-caustics", "tungsten", "path"]


def walls():
    """Returns the sides of the room, with their fronts inside."""
    (x, y, z), (X, Y, Z) = LOW, HIGH
    return [
        [(x, y, z), (x, y, Z), (X, y, Z), (X, y, z)],
        [(x, Y, z), (X, Y, z), (X, Y, Z), (x, Y, Z)],
        [(x, y, z), (X, y, z), (X, Y, z), (x, Y, z)],
        [(x, y, Z), (x, Y, Z), (X, Y, Z), (X, y, Z)],
        [(x, y, z), (x, Y, z), (x, Y, Z), (x, y, Z)],
        [(X, y, z), (X, y, Z), (X, Y, Z), (X, Y, z)],
    ]


def writeOurs(file, albedo):
    half = SIDE / 2
    corner = (LAMP[0] - half, LAMP[1], LAMP[2] - half)
    osgText.write(
        file,
        [
            osgText.quads("walls", walls(), [albedo] * 3),
            osgText.sphere("ball", BALL, RADIUS, osgText.glass(INDEX)),
            osgText.areaLight(corner, (SIDE, 0, 0), (0, 0, SIDE), RADIANCE),
            osgText.fog((0, 1, 0.8), 10, osgText.medium(SCATTERING, ABSORPTION, 0)),
        ],
    )


def quad(center, size, rotation, bsdf):
    place = {"position": center, "scale": [size[0], 1, size[1]], "rotation": rotation}
    return {"type": "quad", "transform": place, "bsdf": bsdf, "ext_medium": "gas"}


def writeTungsten(file, albedo, size, passes, photons, radius):
    x, y, z = (HIGH[k] - LOW[k] for k in range(3))
    mx, my, mz = ((HIGH[k] + LOW[k]) / 2 for k in range(3))
    room = [
        quad([mx, LOW[1], mz], (x, z), [0, 0, 0], "wall"),
        quad([mx, HIGH[1], mz], (x, z), [0, 0, 180], "wall"),
        quad([mx, my, LOW[2]], (x, y), [90, 0, 0], "wall"),
        quad([mx, my, HIGH[2]], (x, y), [-90, 0, 0], "wall"),
        quad([LOW[0], my, mz], (y, z), [0, 0, -90], "wall"),
        quad([HIGH[0], my, mz], (y, z), [0, 0, 90], "wall"),
    ]
    lamp = {**quad(LAMP, (SIDE, SIDE), [0, 0, 180], "null"), "emission": RADIANCE}
    ball = {
        "type": "sphere",
        "transform": {"position": BALL, "scale": RADIUS},
        "bsdf": "glass",
        "ext_medium": "gas",
    }
    scene = {
        "media": [
            {
                "name": "gas",
                "type": "homogeneous",
                "sigma_a": ABSORPTION,
                "sigma_s": SCATTERING,
                "phase_function": {"type": "isotropic"},
            }
        ],
        "bsdfs": [
            {"name": "wall", "type": "lambert", "albedo": albedo},
            {"name": "glass", "type": "dielectric", "ior": INDEX, "albedo": 1},
            {"name": "null", "type": "null", "albedo": 1},
        ],
        "primitives": [*room, ball, lamp],
        "camera": {
            "type": "pinhole",
            "resolution": [size, size],
            "fov": FOVY,
            "medium": "gas",
            "reconstruction_filter": "box",
            "transform": {"position": EYE, "look_at": CENTER, "up": [0, 1, 0]},
        },
        "integrator": {
            "type": "progressive_photon_map",
            "max_bounces": BOUNCES,
            "photon_count": photons,
            "volume_photon_count": 8 * photons,
            "volume_photon_type": "beams",
            "volume_gather_radius": radius,
            "gather_radius": 0.05,
            "use_frustum_grid": True,
        },
        "renderer": {
            "spp": passes,
            "spp_step": 1,
            "hdr_output_file": os.path.basename(file) + ".pfm",
            "output_file": os.path.basename(file) + ".png",
            "overwrite_output_files": True,
            "stratified_sampler": True,
            "adaptive_sampling": False,
            "checkpoint_interval": "0",
            "timeout": "0",
        },
    }
    with open(file + ".json", "w", encoding="utf-8") as text:
        json.dump(scene, text)


def tungsten(options, photons, radius):
    """Returns a function that renders a picture, saves it as an array and returns the seconds."""

    def render(file, passes, seed):
        writeTungsten(file, options.albedo, options.size, passes, photons, radius)
        command = [options.tungsten, "-t", "1", "-s", str(seed), file + ".json"]
        seconds = noise.run(command, file + ".log")
        numpy.save(file, pfm.read(file + ".pfm"))
        return seconds

    return render


def ours(options, scene, integrator):
    view = ["--eye", *map(str, EYE), "--center", *map(str, CENTER), "--up", "0", "1", "0"]
    arguments = ["--fovy", str(FOVY), "--integrator", integrator, *view]
    renderer = mediumTable.ours(scene, options, BOUNCES, *arguments)
    return lambda file, passes, seed: renderer([[file, passes, seed]])[0]


def reached(seconds, errors):
    """Returns when the target is reached, along straight lines of logarithms, the last one of which
    goes on; infinity if it does not fall."""
    t, e = numpy.log(seconds), numpy.log(errors)
    for k in range(len(t) - 1):
        if e[k + 1] <= numpy.log(TARGET) or k == len(t) - 2:
            if e[k + 1] >= e[k]:
                return numpy.inf
            share = (numpy.log(TARGET) - e[k]) / (e[k + 1] - e[k])
            return float(numpy.exp(t[k] + share * (t[k + 1] - t[k])))
    return numpy.inf


def withoutLamp(picture, reference):
    """Returns the picture with the pixels of the reference around the lamp."""
    at = reference.max(2) > 4
    wide = numpy.pad(at, 1)
    near = sum(numpy.roll(wide, (y, x), (0, 1)) for y in (-1, 0, 1) for x in (-1, 0, 1)) > 0
    return numpy.where(near[1:-1, 1:-1, None], reference, picture)


def table(options, name, render, counts, reference):
    stem = os.path.join(os.path.abspath(options.out), name)
    start = numpy.mean([render(f"{stem}-start", 1, seed) for seed in (1, 2)])
    seconds, errors = [], []
    for count in counts:
        means = []
        found = []
        for seed in options.seeds:
            file = f"{stem}-{count}-{seed}"
            used = render(file, count, seed)
            picture = withoutLamp(noise.load(file), reference)
            found.append((used - start, noise.errors(picture, reference, [])[0]))
            means.append(numpy.median(picture / reference))
        seconds.append(numpy.mean([pair[0] for pair in found]) * count / (count - 1))
        if seconds[-1] <= 0:
            noise.fail(f"{name}: {count} passes take no longer than one")
        errors.append(numpy.mean([pair[1] for pair in found]))
        print(f"| {name} | {count} | {seconds[-1]:.2f} | {errors[-1]:.5f} |", flush=True)
    print(f"{name}: relMSE {TARGET} after {reached(seconds, errors):.2f} s; ", end="")
    print(f"median over the long picture {numpy.mean(means):.4f}", flush=True)


def parseArguments():
    parser = noise.argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", default=os.path.join(noise.HERE, "../../build/release"))
    parser.add_argument("--out", default="out/beams")
    parser.add_argument("--size", type=int, default=96)
    parser.add_argument("--albedo", type=float, default=0.5, help="of the walls")
    parser.add_argument("--photons", type=int, default=10000, help="of Tungsten, in a pass")
    parser.add_argument("--radius", type=float, default=0.02, help="of Tungsten's beams [m]")
    parser.add_argument("--counts", type=int, nargs="+", default=[2, 4, 16, 64])
    parser.add_argument("--longest", type=int, default=2048)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--tungsten", default="tungsten", help="the program")
    parser.add_argument("--only", nargs="+", choices=RENDERERS, default=RENDERERS)
    options = parser.parse_args()
    options.counts = sorted(set(options.counts))
    if len(options.counts) < 2 or options.counts[0] < 2:
        parser.error("--counts wants at least two numbers of passes, of 2 and more")
    noise.need(options.tungsten, "--tungsten names the program")
    return options


def main():
    options = parseArguments()
    noise.needBlender()
    os.makedirs(options.out, exist_ok=True)
    scene = os.path.abspath(os.path.join(options.out, "ball.osgt"))
    writeOurs(scene, options.albedo)
    print("| renderer | passes | s | relMSE |\n| --- | --- | --- | --- |")
    photons = ours(options, scene, "sppm")
    made = f"reference-{options.size}-{options.albedo:g}-{options.longest}"
    long = os.path.join(os.path.abspath(options.out), made)
    if not os.path.exists(long + ".npy"):
        photons(long, options.longest, 1000)
    reference = noise.load(long)
    renderers = {
        "sppm": (photons, options.counts),
        "photon-caustics": (ours(options, scene, "photon-caustics"), options.counts),
        "tungsten": (tungsten(options, options.photons, options.radius), options.counts),
        "path": (ours(options, scene, "path"), options.counts[-2:]),
    }
    for name in options.only:
        table(options, name, *renderers[name], reference)


main()
