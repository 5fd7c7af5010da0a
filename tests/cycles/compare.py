# compare.py - renders glTF models with osgraytrace and with Blender's Cycles, and compares them.
# SPDX-License-Identifier: MIT
"""Both renderers get the same file, sky, camera and number of samples, and write sRGB in 8 bits.
The folder OUT gets a folder for each model, with ours.png, cycles.png and both.png, and table.md.
Exit code: 0 all models reach their goals, 1 some do not, 2 a program failed or a model that was
named is not there, 77 there is no Blender, so that nothing was compared."""
import argparse
import hashlib
import json
import os
import shutil
import subprocess
import sys
from urllib.parse import unquote

import numpy
from PIL import Image

import sky
import spheres

HERE = os.path.dirname(os.path.abspath(__file__))

SCENE = """#Ascii Scene
#Version 161
#Generator OpenSceneGraph 3.6.5

osg::Group {{
  UniqueID 1
  StateSet TRUE {{
    osg::StateSet {{
      UniqueID 2
      ModeList 1 {{
        GL_LIGHT0 OFF
      }}
    }}
  }}
  Children 2 {{
    osg::ProxyNode {{
      UniqueID 3
      FileNames 1 {{
        "{model}"
      }}
    }}
    osgRayTrace::EnvironmentLight {{
      UniqueID 4
      Image TRUE {{
        ClassName osg::Image
        UniqueID 5
        FileName "{sky}"
        WriteHint 0 2
      }}
    }}
  }}
}}
"""


def parseArguments(rows):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="rows of models.json, else all")
    parser.add_argument("--build", default=os.path.join(HERE, "../../build/release"))
    parser.add_argument("--models", default=os.environ.get("OSGRAYTRACE_GLTF_MODELS"))
    parser.add_argument("--out", default="out/cycles")
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--bounces", type=int, default=16)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--repair", action="store_true", help="give Cycles glTF's formulas")
    parser.add_argument("--pictures", help="folder for NAME.jpg: ours and Cycles', 640 x 320")
    options = parser.parse_args()
    unknown = [name for name in options.names if name not in rows]
    if unknown:
        parser.error("models.json has no " + ", ".join(unknown))
    return options


def run(command, log, **keywords):
    """Runs a program at low priority; its output goes to a file, which is named if it fails."""
    with open(log, "w", encoding="utf-8") as out:
        done = subprocess.run(
            ["nice", *command], stdout=out, stderr=subprocess.STDOUT, check=False, **keywords
        )
    if done.returncode != 0:
        print(f"{command[0]} failed, see {log}", file=sys.stderr)
        sys.exit(2)


def modelFile(name, options, folder):
    """Returns the file of a sphere of ours or of a sample model, None if there is no such file."""
    if name in spheres.MATERIALS:
        return spheres.write(name, folder)
    if not options.models:
        return None
    file = os.path.join(os.path.abspath(options.models), name, "glTF", name + ".gltf")
    return file if os.path.exists(file) else None


def inputFiles(task):
    """Returns the files that Cycles' picture is made of: the model's own, sky and scripts."""
    with open(task["model"], encoding="utf-8") as text:
        document = json.load(text)
    parts = document.get("buffers", []) + document.get("images", [])
    uris = [part["uri"] for part in parts if not part.get("uri", "data:").startswith("data:")]
    beside = os.path.dirname(task["model"])
    scripts = [os.path.join(HERE, name) for name in ("renderInBlender.py", "repairs.py")]
    files = [os.path.join(beside, unquote(uri)) for uri in uris]
    return [task["model"], *files, task["sky"], *scripts]


def hashOf(file):
    with open(file, "rb") as content:
        return hashlib.sha256(content.read()).hexdigest()


def renderCycles(task):
    """Renders with Cycles unless the folder has the picture of the very same task already."""
    folder = task["folder"]
    task = {**task, "inputs": [hashOf(file) for file in inputFiles(task)]}
    stored = os.path.join(folder, "task.json")
    if os.path.exists(stored):
        with open(stored, encoding="utf-8") as text:
            if json.load(text) == task:
                return
    for name in ("task.json", "camera.json", "cycles.png", "mask.png"):
        if os.path.exists(os.path.join(folder, name)):
            os.remove(os.path.join(folder, name))
    new = stored + ".new"
    with open(new, "w", encoding="utf-8") as text:
        json.dump(task, text)
    script = os.path.join(HERE, "renderInBlender.py")
    command = ["blender", "--background", "--factory-startup", "--python-exit-code", "3"]
    run([*command, "--python", script, "--", new], os.path.join(folder, "blender.log"))
    os.replace(new, stored)


def renderOurs(task, options):
    folder = task["folder"]
    scene = os.path.join(folder, "scene.osgt")
    with open(scene, "w", encoding="utf-8") as text:
        text.write(SCENE.format(model=task["model"], sky=task["sky"]))
    with open(os.path.join(folder, "camera.json"), encoding="utf-8") as text:
        camera = json.load(text)
    command = [os.path.join(options.build, "bin/osgraytrace"), scene]
    size = str(task["size"])
    command += ["-o", os.path.join(folder, "ours.png"), "--size", size, size]
    for place in ("eye", "center", "up"):
        command += ["--" + place, *[repr(float(number)) for number in camera[place]]]
    command += ["--fovy", str(camera["fovy"]), "--integrator", "path"]
    # Cycles counts where a path scatters, osgraytrace its ways from there: one more to the sky.
    command += ["--passes", str(task["samples"]), "--max-bounces", str(task["bounces"] + 1)]
    command += ["--seed", str(task["seed"])]
    libraries = os.path.abspath(os.path.join(options.build, "lib"))
    environment = {**os.environ, "OSG_LIBRARY_PATH": f"{libraries}:{libraries}/osgPlugins-3.6.5"}
    run(command, os.path.join(folder, "osgraytrace.log"), env=environment)


def pixels(folder, name, mode="RGB"):
    return numpy.asarray(Image.open(os.path.join(folder, name)).convert(mode)).astype(float)


def psnr(difference):
    """Returns the peak signal-to-noise ratio of differences of 8-bit values [dB]."""
    square = numpy.mean(difference**2)
    return 99.0 if square == 0 else 10 * numpy.log10(255**2 / square)


def compare(folder):
    """Returns PSNR over the picture and over the model's pixels, and the mean difference there."""
    ours, cycles = pixels(folder, "ours.png"), pixels(folder, "cycles.png")
    model = pixels(folder, "mask.png", "RGBA")[..., 3] > 0
    difference = ours - cycles
    shown = [ours, cycles, numpy.clip(128 + 4 * difference, 0, 255)]
    both = Image.fromarray(numpy.hstack(shown).astype(numpy.uint8))
    both.save(os.path.join(folder, "both.png"))
    return psnr(difference), psnr(difference[model]), difference[model].mean()


def savePair(folder, file):
    """Saves ours and Cycles' picture side by side as a JPEG file of 640 x 320 pixels."""
    both = Image.open(os.path.join(folder, "both.png"))
    pair = both.crop((0, 0, 2 * both.height, both.height))
    pair.resize((640, 320), Image.LANCZOS).save(file, quality=88)


def goalOf(row, repaired):
    """Returns the least PSNR of the whole picture that the row must reach [dB]."""
    goal = row.get("goal", 30)
    return row.get("repairedGoal", goal) if repaired else goal


def findModels(names, options, out):
    """Returns the files of those models that are there, and the names of the others."""
    found, missing = {}, []
    for name in names:
        folder = os.path.join(out, name)
        os.makedirs(folder, exist_ok=True)
        model = modelFile(name, options, folder)
        if model:
            found[name] = model
        else:
            missing.append(name)
    return found, missing


def tableRow(*cells):
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def main():
    with open(os.path.join(HERE, "models.json"), encoding="utf-8") as text:
        rows = json.load(text)
    options = parseArguments(rows)
    if not shutil.which("blender"):
        print("skipped: there is no Blender; Debian has it in the package blender")
        return 77
    out = os.path.abspath(options.out)
    os.makedirs(out, exist_ok=True)
    models, missing = findModels(options.names or rows, options, out)
    if missing:
        print("not found:", ", ".join(missing))
        print("--models or OSGRAYTRACE_GLTF_MODELS names the folder of the sample models")
    if missing and options.names:
        return 2
    if options.pictures:
        os.makedirs(options.pictures, exist_ok=True)
    skies = {name: os.path.join(out, name + ".hdr") for name in ("outdoors", "even")}
    for name, file in skies.items():
        sky.write(file, getattr(sky, name)())

    columns = "model", "picture [dB]", "model [dB]", "mean difference [1/255]", "samples", "note"
    lines = [tableRow(*columns), tableRow(*["---"] * len(columns))]
    print(*lines, sep="\n", flush=True)
    below = []
    for name, model in models.items():
        row = rows[name]
        folder = os.path.join(out, name)
        task = {"model": model, "sky": skies[row.get("sky", "outdoors")], "folder": folder}
        task |= {"view": row.get("view", [0.5, -1, 0.3]), "size": options.size}
        task |= {"samples": options.samples, "bounces": options.bounces, "seed": options.seed}
        task["repair"] = options.repair
        renderCycles(task)
        renderOurs(task, options)
        picture, covered, mean = compare(folder)
        if options.pictures:
            savePair(folder, os.path.join(options.pictures, name + ".jpg"))
        if picture < goalOf(row, options.repair):
            below.append(name)
        figures = f"{picture:.1f}", f"{covered:.1f}", f"{mean:+.1f}", options.samples
        lines.append(tableRow(name, *figures, row.get("note", "")))
        print(lines[-1], flush=True)
    with open(os.path.join(out, "table.md"), "w", encoding="utf-8") as text:
        text.write("\n".join(lines) + "\n")
    if below:
        print("below the goal:", ", ".join(below))
    return 1 if below else 0


if __name__ == "__main__":
    sys.exit(main())
