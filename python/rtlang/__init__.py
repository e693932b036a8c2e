"""rtlang: pictures of many spheres from numpy arrays, with the error known.

    import numpy as np
    import rtlang

    scene = rtlang.Scene()
    scene.spheres(np.random.rand(1000, 3), 0.02, np.random.rand(1000, 3))
    scene.light((-3, 5, 4))
    scene.camera(fit=True)
    scene.render(640, 480).save("spheres.png")

docs/python.md is a tour. SPDX-License-Identifier: MIT
"""
from . import _library
from ._colors import colormap, srgb
from ._errors import Error, FileError, LimitError, SceneError, SceneWarning, UsageError
from .image import Image
from .looks import Look
from .scene import Scene

__version__ = _library.LIBRARY.rt_version().decode("ascii")
__all__ = ["Error", "FileError", "Image", "LimitError", "Look", "Scene", "SceneError", "SceneWarning", "UsageError",
           "colormap", "srgb"]
