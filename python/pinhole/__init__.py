"""Ray traces spheres: arrays in, pictures and layers out, on any device and without a display.

>>> import numpy as np, pinhole as ph
>>> spheres = ph.Spheres(np.random.default_rng(1).normal(size=(100, 3)), radius=0.1, color="steelblue")
>>> image = spheres.render(size=(160, 120), samples=4)
>>> np.asarray(image).shape
(120, 160, 3)
"""

from ._camera import Camera
from ._certificate import Certificate
from ._errors import DeviceError, Error, FileError, InputError, InternalError, Note, PackageError
from ._files import Trajectory, read
from ._image import Image
from ._movie import movie
from ._pinhole import __version__
from ._spheres import Spheres

__all__ = [
    "Camera",
    "Certificate",
    "DeviceError",
    "Error",
    "FileError",
    "Image",
    "InputError",
    "InternalError",
    "Note",
    "PackageError",
    "Spheres",
    "Trajectory",
    "__version__",
    "movie",
    "read",
]
