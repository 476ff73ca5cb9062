"""Several pictures in one."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import InputError
from ._image import Image, write
from ._pinhole import png_of

Array = npt.NDArray[Any]


def sheet(
    path: str | os.PathLike[str], images: Iterable[Image | Array], *, columns: int | None = None, gap: int = 0
) -> None:
    """Writes pictures of one size as one PNG, row by row. A row has ``columns`` pictures, by default all.

    Pictures are ``Image`` objects, or uint8 arrays (sRGB) of shape (height, width, 3) or (height, width, 4). There are
    ``gap`` white pixels between them.
    """
    path = os.fspath(path)
    if os.path.splitext(path)[1].lower() != ".png":
        raise InputError(f"{path}: a sheet of pictures is written as .png; change the extension")
    if isinstance(images, Image):
        raise InputError("images is one picture; write a list of pictures")
    arrays = [pixels(index, image) for index, image in enumerate(images)]
    if not arrays:
        raise InputError(f"{path}: there are no pictures")
    height, width, channels = arrays[0].shape
    for index, array in enumerate(arrays):
        if array.shape != arrays[0].shape:
            raise InputError(
                f"{path}: all pictures must have the shape of the first, {arrays[0].shape}; picture {index} has {array.shape}"
            )
    columns = min(len(arrays), len(arrays) if columns is None else columns)
    if columns < 1 or gap < 0:
        raise InputError(f"columns is {columns} and gap is {gap}; there must be at least 1 column, and no negative gap")
    rows = -(-len(arrays) // columns)
    paper = np.full((rows * (height + gap) - gap, columns * (width + gap) - gap, channels), 255, np.uint8)
    for index, array in enumerate(arrays):
        top, left = index // columns * (height + gap), index % columns * (width + gap)
        paper[top : top + height, left : left + width] = array
    write(path, png_of(paper))


def pixels(index: int, image: Image | Array) -> Array:
    """The pixels of a picture: uint8 sRGB, (height, width, 3) or (height, width, 4)."""
    array = image.rgb8 if isinstance(image, Image) else np.asarray(image)
    if array.dtype != np.uint8 or array.ndim != 3 or array.shape[2] not in (3, 4):
        raise InputError(
            f"picture {index} has the shape {array.shape} and the type {array.dtype}; "
            "it must be an Image, or (height, width, 3) or (height, width, 4) in uint8"
        )
    return array
