"""Pictures."""

from __future__ import annotations

import os
import tempfile
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import FileError, InputError
from ._pinhole import Picture

Array = npt.NDArray[Any]

#: The layers besides colour, as ``render(layers=...)`` names them.
LAYERS = ("alpha", "depth", "normal", "position", "albedo", "id", "samples", "variance")


class Image:
    """A picture with its layers as NumPy arrays of shape (height, width) or (height, width, 3); row 0 is the top.

    ``np.asarray(image)`` and ``image.rgb8`` are the picture in uint8 sRGB, as in a PNG. ``image.color`` is linear light
    in float32. The other layers exist if ``render(layers=...)`` asked for them.
    """

    __slots__ = ("_picture", "_arrays")

    def __init__(self, picture: Picture) -> None:
        self._picture = picture
        self._arrays: dict[str, Array] = {}

    def _layer(self, name: str) -> Array:
        if name not in self._arrays:
            array = self._picture.rgb8() if name == "rgb8" else self._picture.layer(name)
            if array is None:
                raise InputError(
                    f"this picture has no layer {name}; ask for it with render(layers=[{name!r}]); "
                    f"it has {', '.join(self.layers)}"
                )
            array.setflags(write=False)
            self._arrays[name] = array
        return self._arrays[name]

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return (self._picture.width, self._picture.height)

    @property
    def layers(self) -> list[str]:
        """The names of the layers that the picture has."""
        return self._picture.layer_names()

    @property
    def adapter(self) -> str | None:
        """The name of the adapter that rendered; None if the CPU did."""
        return self._picture.adapter

    @property
    def notes(self) -> list[str]:
        """Notes for the user about the picture."""
        return self._picture.notes

    @property
    def rgb8(self) -> Array:
        """The encoded picture: uint8 sRGB, (height, width, 3); with alpha (height, width, 4) if it is transparent."""
        return self._layer("rgb8")

    @property
    def color(self) -> Array:
        """Linear light: float32, (height, width, 3), Rec. 709 primaries."""
        return self._layer("color")

    @property
    def alpha(self) -> Array:
        """The fraction of each pixel that spheres cover: float32, (height, width), from 0 to 1."""
        return self._layer("alpha")

    @property
    def depth(self) -> Array:
        """Distance along the ray in scene units: float32, (height, width); inf where nothing is hit."""
        return self._layer("depth")

    @property
    def normal(self) -> Array:
        """Unit normals in world space: float32, (height, width, 3); zero where nothing is hit."""
        return self._layer("normal")

    @property
    def position(self) -> Array:
        """The points that rays hit, in scene units: float32, (height, width, 3); zero where nothing is hit."""
        return self._layer("position")

    @property
    def albedo(self) -> Array:
        """Linear surface colours without light: float32, (height, width, 3); zero where nothing is hit."""
        return self._layer("albedo")

    @property
    def id(self) -> Array:
        """Indices of spheres: uint32, (height, width); 4294967295 where nothing is hit."""
        return self._layer("id")

    @property
    def samples(self) -> Array:
        """The number of samples of each pixel: uint32, (height, width)."""
        return self._layer("samples")

    @property
    def variance(self) -> Array:
        """The estimated variance of each pixel's mean luminance: float32, (height, width)."""
        return self._layer("variance")

    def save(self, path: str | os.PathLike[str], layer: str | None = None) -> None:
        """Writes a file: .png, .exr with all requested layers, or .npy with one ``layer`` (default: color)."""
        path = os.fspath(path)
        extension = os.path.splitext(path)[1].lower()
        if layer is not None and extension != ".npy":
            raise InputError(f"{path}: a layer by itself is written as .npy; change the extension or remove layer")
        if extension == ".png":
            data = self._picture.png()
        elif extension == ".exr":
            data = self._picture.exr()
        elif extension == ".npy":
            name = layer or "color"
            self._layer(name)
            data = self._picture.npy(name)
        else:
            raise InputError(f"{path}: a picture is written as .png or .exr, and a layer as .npy; change the extension")
        write(path, data)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Array:
        array = self.rgb8
        if dtype is not None and np.dtype(dtype) != array.dtype:
            return array.astype(dtype)
        return array.copy() if copy else array

    def _repr_png_(self) -> bytes:
        return self._picture.png()

    def __repr__(self) -> str:
        width, height = self.size
        return f"<pinhole.Image {width}x{height}: {', '.join(self.layers)}>"


def write(path: str, data: bytes) -> None:
    """Writes a file, which gets its name only when it is complete."""
    folder = os.path.dirname(path) or "."
    try:
        handle, temporary = tempfile.mkstemp(prefix=".pinhole-", dir=folder)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
            mask = os.umask(0)
            os.umask(mask)
            os.chmod(temporary, 0o666 & ~mask)
            os.replace(temporary, path)
        except BaseException:
            os.unlink(temporary)
            raise
    except OSError as error:
        raise FileError(f"{path}: cannot be written: {error.strerror or error}") from None
