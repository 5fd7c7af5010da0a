# pbrtMedia.py - writes scenes with media for pbrt-v3, and renders them; for scripts of this folder.
# SPDX-License-Identifier: MIT
"""Its samplers have no seeds, so that each picture is rendered once: the long one with random
numbers, the others with its (0,2) sequence, which, unlike Halton's, has no end."""
import noise
import numpy
import pbrtScene
import pfm
import sceneFile


def words(values):
    return f"[{sceneFile.text(values)}]"


def mesh(points, faces):
    """Returns the shape of triangles that fan out from the first corner of each face."""
    triangles = [(f[0], f[k], f[k + 1]) for f in faces for k in range(1, len(f) - 1)]
    return pbrtScene.mesh(points, triangles)


def boundary(inside, shape):
    """Returns a shape that is not seen, with a medium inside."""
    return f'AttributeBegin\nMediumInterface "{inside}" ""\nMaterial ""\n{shape}AttributeEnd\n'


def write(file, world, view, size, samples, sampler, depth):
    """view: eye, center, up, fovy."""
    look = " ".join(sceneFile.text(view[name]) for name in ("eye", "center", "up"))
    with open(file + ".pbrt", "w", encoding="utf-8") as text:
        text.write(
            f'Integrator "volpath" "integer maxdepth" [{depth}]\n'
            f'Sampler "{sampler}" "integer pixelsamples" [{samples}]\n'
            'PixelFilter "box" "float xwidth" [0.5] "float ywidth" [0.5]\n'
            f'Film "image" "integer xresolution" [{size}] "integer yresolution" [{size}]'
            f' "string filename" ["{file}.pfm"]\n'
            f'Scale -1 1 1\nLookAt {look}\nCamera "perspective" "float fov" [{view["fovy"]}]\n'
            # The camera would be in the medium that is outside at the end.
            f"WorldBegin\nAttributeBegin\n{world}AttributeEnd\nWorldEnd\n"
        )


def renderer(world, view, options, depth):
    """Returns a renderer of mediumTable.py. world: what is between WorldBegin and WorldEnd."""

    def render(pictures):
        seconds, done = [], {}
        for file, samples, _ in pictures:
            if samples not in done:
                sampler = "random" if file.endswith("reference") else "02sequence"
                write(file, world, view, options.size, samples, sampler, depth)
                command = [options.pbrt, "--quiet", "--nthreads=1", file + ".pbrt"]
                used = noise.run(command, file + ".log")
                done[samples] = used, pfm.read(file + ".pfm")
            seconds.append(done[samples][0])
            numpy.save(file, done[samples][1])
        return seconds

    return render
