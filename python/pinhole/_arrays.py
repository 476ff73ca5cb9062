"""Checks arrays, and turns them into the few types that the compiled half reads. Strides and order may be any."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import InputError

Array = npt.NDArray[Any]


def numbers(name: str, given: Any) -> Array:
    """An array of real numbers, without a copy where that is possible."""
    if isinstance(given, np.ma.MaskedArray):
        raise InputError(f"{name} is a masked array; leave out what is masked, or fill it with .filled(...)")
    if not isinstance(given, np.ndarray) and hasattr(given, "__dlpack__") and not hasattr(given, "__array__"):
        try:
            given = np.from_dlpack(given)
        except (BufferError, RuntimeError, TypeError) as error:
            raise InputError(f"{name} is not in host memory ({error}); copy it, as with .cpu() or .get()") from None
    try:
        array = np.asarray(given)
    except (TypeError, ValueError) as error:
        raise InputError(f"{name} is not an array of numbers: {error}") from None
    if array.dtype.kind not in "fiub":
        what = {"O": "Python objects", "c": "complex numbers", "U": "texts", "S": "texts"}.get(array.dtype.kind)
        what = what or f"values of the type {array.dtype}"
        raise InputError(f"{name} has {what} (dtype {array.dtype}); it must have real numbers")
    return array


def floats(array: Array, dtype: Any = None) -> Array:
    """The array in float32 if it has this type or fewer bits, or else in float64."""
    if dtype is None:
        dtype = np.float32 if array.dtype.kind == "f" and array.dtype.itemsize <= 4 else np.float64
    # Other byte orders are changed too.
    return array.astype(np.dtype(dtype), copy=False)


def positions(name: str, given: Any) -> Array:
    """Centres: shape (n, 3), float32 or float64."""
    array = numbers(name, given)
    if array.ndim == 2 and array.shape[1] == 3:
        return floats(array)
    if array.ndim == 2 and array.shape[0] == 3:
        raise InputError(f"{name} has the shape {array.shape}; it must be (n, 3): transpose it, {name}.T")
    if array.size == 0:
        return np.zeros((0, 3), np.float32)
    if array.shape == (3,):
        raise InputError(f"{name} has the shape (3,); it must be (n, 3): for one sphere, {name}[None, :]")
    if array.ndim == 2 and array.shape[1] == 4:
        raise InputError(f"{name} has the shape {array.shape}; it must be (n, 3): radii are an argument, radius={name}[:, 3]")
    raise InputError(f"{name} has the shape {array.shape}; it must be (n, 3), with x, y and z in each row")


def radii(given: Any, like: Array) -> float | Array | None:
    """One radius, or an array of shape (n,) with the type of the centres; None if there is none."""
    if given is None:
        return None
    array = numbers("radius", given)
    if array.ndim == 0:
        radius = float(array)
        if not (np.isfinite(radius) and radius > 0):
            raise InputError(f"radius is {radius!r}; it must be finite and greater than 0")
        return radius
    array = per_sphere("radius", array, len(like))
    wrong = ~(np.isfinite(array) & (array > 0))
    if wrong.any():
        index = int(np.argmax(wrong))
        raise InputError(
            f"radius: sphere {index} has the radius {array[index]!s}; it must be finite and greater than 0"
        )
    return floats(array, like.dtype)


def per_sphere(name: str, array: Array, count: int) -> Array:
    """Checks that an array has the shape (n,)."""
    if array.ndim == 2 and array.shape == (count, 1):
        return array[:, 0]
    if array.ndim != 1:
        raise InputError(f"{name} has the shape {array.shape}; it must be (n,), here ({count},)")
    if len(array) != count:
        raise InputError(f"{name} has {len(array)} values for {count} spheres")
    return array


def is_colors(given: Any) -> bool:
    """Whether a colour argument is an array with a row for each sphere."""
    return np.ndim(given) == 2


def colors(given: Any, count: int) -> Array:
    """Colours: uint8 of shape (n, 3) or (n, 4) in sRGB, or float32 of shape (n, 3) in linear light."""
    array = numbers("color", given)
    if len(array) != count:
        raise InputError(f"color has {len(array)} rows for {count} spheres")
    if array.dtype == np.uint8 and array.shape[1] in (3, 4):
        return array
    if array.dtype.kind == "f" and array.shape[1] == 3:
        return floats(array, np.float32)
    remedy = ""
    if array.dtype.kind in "iu" and array.shape[1] in (3, 4):
        remedy = '; for numbers from 0 to 255 write color.astype("u1")'
    elif array.dtype.kind == "f" and array.shape[1] == 4:
        remedy = '; for colors of matplotlib write (255 * color).astype("u1")'
    raise InputError(
        f"color has the shape {array.shape} and the type {array.dtype}; it must be (n, 3) or (n, 4) in uint8 (sRGB), "
        f"or (n, 3) in floats (linear light){remedy}"
    )


def column(name: str, given: Any, count: int) -> tuple[list[str], Array] | Array:
    """A column: numbers in float64, or different texts and the index of each sphere's text."""
    array = np.asarray(given)
    if array.dtype.kind in "US" or (array.dtype.kind == "O" and all(isinstance(of, str) for of in array.ravel())):
        texts = per_sphere(name, array.astype(str), count)
        names, indices = np.unique(texts, return_inverse=True)
        return (names.tolist(), indices.astype(np.uint32).reshape(-1))
    return floats(per_sphere(name, numbers(name, given), count), np.float64)
