"""Ray traces spheres, cylinders and cones: arrays in, pictures and layers out, on any device and without a display.

>>> import numpy as np, pinhole as ph
>>> spheres = ph.Spheres(np.random.default_rng(1).normal(size=(100, 3)), radius=0.1, color="steelblue")
>>> image = spheres.render(size=(160, 120), samples=4)
>>> np.asarray(image).shape
(120, 160, 3)
"""

import atexit
import os

if not os.environ.get("XDG_RUNTIME_DIR") and not os.environ.get("MESA_VK_DEVICE_SELECT"):
    # Without a desktop session, a layer of Mesa that chooses a device would only print errors.
    os.environ.setdefault("NODEVICE_SELECT", "1")

from ._camera import Camera
from ._certificate import Certificate
from ._cones import Cones, Cylinders
from ._errors import DeviceError, Error, FileError, InputError, InternalError, Note, PackageError
from ._files import Trajectory, read
from ._image import Image
from ._movie import movie
from ._pinhole import __version__, adapters, use_adapter, wait_for_threads
from ._shapes import Shapes
from ._sheet import sheet
from ._spheres import Spheres
from ._tables import (
    Arrows,
    Axes,
    Bonds,
    Box,
    ColorBy,
    DepthCue,
    EmissionBy,
    Ground,
    Label,
    Legend,
    Light,
    Material,
    Occlusion,
    OpacityBy,
    Outline,
    Output,
    Path,
    RadiusBy,
    Sampling,
    ScaleBar,
    Sky,
    Studio,
    Sun,
    Text,
)

__all__ = [
    "Arrows",
    "Axes",
    "Bonds",
    "Box",
    "Camera",
    "Certificate",
    "ColorBy",
    "Cones",
    "Cylinders",
    "DepthCue",
    "DeviceError",
    "EmissionBy",
    "Error",
    "FileError",
    "Ground",
    "Image",
    "InputError",
    "InternalError",
    "Label",
    "Legend",
    "Light",
    "Material",
    "Note",
    "Occlusion",
    "OpacityBy",
    "Outline",
    "Output",
    "PackageError",
    "Path",
    "RadiusBy",
    "Sampling",
    "ScaleBar",
    "Shapes",
    "Sky",
    "Spheres",
    "Studio",
    "Sun",
    "Text",
    "Trajectory",
    "__version__",
    "adapters",
    "movie",
    "read",
    "sheet",
    "use_adapter",
]

atexit.register(wait_for_threads)
