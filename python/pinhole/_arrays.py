"""Checks arrays, and converts them to the few types that the compiled half reads. Strides and order may be any."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import InputError, Note
from ._pinhole import is_color_map, srgb_of_names

Array = npt.NDArray[Any]


def numbers(name: str, given: Any) -> Array:
    """Returns an array of real numbers, without a copy if possible."""
    if isinstance(given, np.ma.MaskedArray):
        raise InputError(f"{name} is a masked array; leave out what is masked, or fill it with .filled(...)")
    if not isinstance(given, np.ndarray):
        given = _on_host(name, given)
    try:
        array = np.asarray(given)
    except (TypeError, ValueError) as error:
        raise InputError(f"{name} is not an array of numbers: {error}") from None
    if array.dtype.kind not in "fiub":
        what = {"O": "Python objects", "c": "complex numbers", "U": "texts", "S": "texts"}.get(array.dtype.kind)
        what = what or f"values of the type {array.dtype}"
        raise InputError(f"{name} has {what} (dtype {array.dtype}); it must have real numbers")
    return array


def _on_host(name: str, given: Any) -> Any:
    """Copies another library's array from a device to the host, with a note. Arrays on the host stay as they are."""
    if hasattr(given, "__cuda_array_interface__") or getattr(given, "is_cuda", False):
        # Names of these methods in CuPy, PyTorch and Numba.
        for method in ("get", "cpu", "copy_to_host"):
            if hasattr(given, method):
                warnings.warn(f"{name} is copied from a CUDA device to host memory", Note, stacklevel=5)
                return _on_host(name, getattr(given, method)())
    if hasattr(given, "__dlpack__") and not hasattr(given, "__array__"):
        try:
            return np.from_dlpack(given)
        except (BufferError, RuntimeError, TypeError) as error:
            raise InputError(f"{name} is not in host memory ({error}); copy it, as with .cpu() or .get()") from None
    return given


def floats(array: Array, dtype: Any = None) -> Array:
    """Converts an array to float32 if it has this type or fewer bits, and otherwise to float64."""
    if dtype is None:
        dtype = np.float32 if array.dtype.kind == "f" and array.dtype.itemsize <= 4 else np.float64
    # This also changes other byte orders.
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
    """Returns one radius, or an array of shape (n,) with the type of the centres; None if there is none."""
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


def per_sphere(name: str, array: Array, count: int, what: str = "spheres") -> Array:
    """Checks that an array has the shape (n,)."""
    if array.ndim == 2 and array.shape == (count, 1):
        return array[:, 0]
    if array.ndim != 1:
        raise InputError(f"{name} has the shape {array.shape}; it must be (n,), here ({count},)")
    if len(array) != count:
        raise InputError(f"{name} has {len(array)} values for {count} {what}")
    return array


def is_colors(given: Any) -> bool:
    """Whether a colour argument is an array with one row for each sphere."""
    return np.ndim(given) == 2


def colors(given: Any, count: int, what: str = "spheres") -> Array:
    """Colours: uint8 of shape (n, 3) or (n, 4) in sRGB, or float32 of shape (n, 3) in linear light."""
    array = numbers("color", given)
    if len(array) != count:
        raise InputError(f"color has {len(array)} rows for {count} {what}")
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


def named_colors(given: Any, count: int) -> Array | None:
    """Colours from CSS names, one for each sphere: uint8 of shape (n, 3); None if some text is not a colour."""
    array = np.asarray(given)
    if array.dtype.kind != "U" or array.shape != (count,):
        return None
    names, indices = np.unique(array, return_inverse=True)
    colors = srgb_of_names(names.tolist())
    return None if colors is None else np.frombuffer(colors, np.uint8).reshape(-1, 3)[indices]


def materials(given: Any, count: int) -> tuple[list[Any], Array]:
    """The different materials of a list, which may be names or tables, and the index of each sphere's material."""
    if len(given) != count:
        raise InputError(f"material has {len(given)} values for {count} spheres")
    different: dict[str, int] = {}
    firsts: list[Any] = []
    indices = np.empty(count, np.uint32)
    for sphere, one in enumerate(given):
        if not isinstance(one, (str, Mapping)):
            raise InputError(f"material: that of sphere {sphere} is {one!r}; write a Material, or a name of materials")
        key = str(one) if isinstance(one, str) else repr(dict(one))
        index = different.setdefault(key, len(firsts))
        if index == len(firsts):
            firsts.append(one)
        indices[sphere] = index
    return firsts, indices


def is_list(given: Any) -> bool:
    """Whether an argument has a value for each sphere."""
    return isinstance(given, (Sequence, np.ndarray)) and not isinstance(given, str)


def column(name: str, given: Any, count: int) -> tuple[list[str], Array] | Array:
    """Returns a column: numbers in float64, or the different texts, the first one first, and the index of each sphere's."""
    array = np.asarray(given)
    if array.dtype.kind in "US" or (array.dtype.kind == "O" and all(isinstance(of, str) for of in array.ravel())):
        texts = per_sphere(name, array.astype(str), count)
        names, firsts, indices = np.unique(texts, return_index=True, return_inverse=True)
        order = np.argsort(firsts)
        places = np.argsort(order).astype(np.uint32)
        return (names[order].tolist(), places[indices.reshape(-1)])
    return floats(per_sphere(name, numbers(name, given), count), np.float64)


def columns(given: Any, count: int) -> dict[str, Any]:
    """Returns all columns. Those of an array with several numbers for each sphere are called as in files."""
    if given is None:
        return {}
    if not hasattr(given, "items"):
        raise InputError(f"columns is {type(given).__name__}; it must be a dict of names and arrays of shape ({count},)")
    found: dict[str, Any] = {}
    for name, item in given.items():
        parts = {str(name): item}
        if np.ndim(item) == 2 and np.shape(item)[0] == count and np.shape(item)[1] > 1:
            array, width = np.asarray(item), np.shape(item)[1]
            ends = "xyz" if width <= 3 else range(width)
            parts = {f"{name}.{end}": array[:, place] for place, end in zip(range(width), ends)}
        found.update({part: column(f"columns[{part!r}]", of, count) for part, of in parts.items()})
    return found


def cell(given: Any, origin: Any, pbc: Any) -> tuple[list[list[float]], list[float], list[bool]] | None:
    """The edges of a periodic cell, its corner, and whether the data repeats along each edge; None if there is none."""
    if given is None:
        return None
    edges = numbers("cell", given).astype(float)
    if edges.shape == (3,):
        edges = np.diag(edges)
    if edges.shape != (3, 3) or not np.isfinite(edges).all():
        raise InputError(f"cell has the shape {np.shape(given)}; it must be three lengths, or (3, 3) with an edge in each row")
    if np.linalg.det(edges) == 0.0:
        raise InputError(f"cell is {np.asarray(given).tolist()}; its edges must not lie in one plane")
    corner = numbers("origin", (0.0, 0.0, 0.0) if origin is None else origin).astype(float)
    repeats = np.broadcast_to(np.asarray(pbc, bool), 3)
    if corner.shape != (3,) or not np.isfinite(corner).all():
        raise InputError(f"origin is {origin!r}; write three numbers, x, y and z")
    return edges.tolist(), corner.tolist(), repeats.tolist()


def pairs(given: Any, count: int) -> Array | None:
    """Bonds: pairs of indices, uint32 of shape (k, 2)."""
    if given is None:
        return None
    array = np.asarray(given)
    if array.size == 0:
        return np.zeros((0, 2), np.uint32)
    if array.ndim != 2 or array.shape[1] != 2 or array.dtype.kind not in "iu":
        raise InputError(f"pairs has the shape {array.shape}; it must be (k, 2), with two indices in each row")
    if array.min() < 0 or array.max() >= count:
        raise InputError(f"pairs has the index {array.min() if array.min() < 0 else array.max()}; there are {count} spheres")
    return np.ascontiguousarray(array, np.uint32)


def indices(given: Any, count: int) -> Array:
    """The indices that a mask, a slice, or an array of indices takes from spheres: uint32."""
    array = np.asarray(given) if not isinstance(given, slice) else given
    if isinstance(array, np.ndarray) and array.size == 0:
        return np.zeros(0, np.uint32)
    if isinstance(array, np.ndarray) and array.dtype.kind not in "biu":
        raise InputError(f"spheres[{given!r}]: give a name of a column, a mask, a slice, or indices")
    if isinstance(array, np.ndarray) and array.dtype.kind == "b" and array.shape != (count,):
        raise InputError(f"the mask has the shape {array.shape} for {count} spheres")
    return np.atleast_1d(np.arange(count, dtype=np.uint32)[array])


def map_name(cmap: Any) -> Any:
    """The name of a colour map of matplotlib, or colours that are blended into one that is not known here."""
    if cmap is None or isinstance(cmap, str):
        return cmap
    if is_list(cmap) and all(isinstance(color, str) for color in cmap):
        return ",".join(cmap)
    if not callable(cmap):
        raise InputError(f'cmap is {cmap!r}; write a name such as "viridis", or give a colour map of matplotlib')
    name = str(getattr(cmap, "name", ""))
    if is_color_map(name):
        return name
    colors = [cmap(step / 15)[:3] for step in range(16)]
    return ",".join("#" + "".join(f"{round(255 * float(part)):02x}" for part in color) for color in colors)


def triple(color: Any) -> Any:
    """Returns a colour as a scene file writes it."""
    if isinstance(color, str):
        return color
    array = numbers("color", color)
    if array.dtype.kind in "iu" and array.max() > 1:
        bytes_of = "#" + "".join(f"{int(number) & 255:02x}" for number in array)
        raise InputError(
            f'color is {array.tolist()}; a triple is linear light from 0 to 1; for bytes in sRGB write "{bytes_of}"'
        )
    return [float(number) for number in array]
