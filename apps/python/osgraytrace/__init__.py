# SPDX-License-Identifier: MIT
"""Ray traces OpenSceneGraph models to numpy arrays, without a display.

    import osgraytrace

    renderer = osgraytrace.Renderer("cow.osgt", size=(640, 480), integrator="path")
    renderer.look_at(eye=(0, -20, 5), center=(0, 0, 0))
    statistics = renderer.render(error=0.02)
    picture = renderer.display()          # uint8, (480, 640, 4)
    depth = renderer.channel("distance")  # float32, (480, 640)

Row 0 of all arrays is at the top of the picture. Arrays are views of memory that they keep alive:
nothing is copied. Their rows run backwards in memory; array[::-1] is the picture bottom up, in one
piece, for libraries that want that.
"""

from ._osgraytrace import (
    LoadError,
    PassSums,
    RenderError,
    Renderer,
    Scene,
    Settings,
    __version__,
    options,
)

__all__ = ["LoadError", "PassSums", "RenderError", "Renderer", "Scene", "Settings", "options"]

for _name in __all__:
    globals()[_name].__module__ = "osgraytrace"
del _name
