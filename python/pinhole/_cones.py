"""Cylinders and cones."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from . import _arrays, _settings
from ._errors import InputError
from ._pinhole import SphereData
from ._shapes import Shapes, counted, warn

Array = npt.NDArray[Any]

#: The closed ends of cylinders and cones.
CAPS = ("none", "first", "second", "both")


class Cylinders(Shapes):
    """Cylinders, which ``+`` joins with other shapes: ``(spheres + cylinders).render()``.

    Parameters
    ----------
    start, end
        The middles of both ends: shape (n, 3), any float or integer type, any strides.
    radius
        One number or an array of shape (n,), in the unit of the ends. A cylinder is at most 10,000 times longer or
        shorter than its radius.
    caps
        The closed ends: ``"none"``, ``"first"``, ``"second"`` or ``"both"``. Through an open end, the inside is seen.
    round
        Whether the ends are round, a half sphere at each. The spheres count as spheres in ids.
    color
        A CSS colour such as ``"steelblue"``, or n of them; a linear triple (r, g, b); or an array of shape (n, 3) in
        uint8 (sRGB) or floats (linear light).
    material
        A ``Material`` for all, which is not emissive.
    opacity
        One number from 0 to 1 for all.

    >>> import pinhole
    >>> pinhole.Cylinders([[0, 0, 0]], [[0, 0, 4]], 0.5, color="steelblue")
    <pinhole.Cylinders: 1 cylinder>
    """

    __slots__ = ("_count",)

    _count: int

    def __init__(
        self,
        start: Any,
        end: Any,
        radius: Any,
        *,
        caps: str | None = None,
        round: bool = False,
        color: Any = None,
        material: Any = None,
        opacity: Any = None,
    ) -> None:
        starts, ends = _ends(start, end)
        array = _arrays.numbers("radius", radius)
        if array.ndim > 0:
            array = _arrays.per_sphere("radius", array, len(starts), "cylinders")
        radii = np.broadcast_to(array.reshape(-1, 1), (len(starts), 2))
        _make(self, starts, ends, radii, caps, round, color, material, opacity)

    def __len__(self) -> int:
        return self._count

    def __repr__(self) -> str:
        return f"<pinhole.Cylinders: {counted(len(self), 'cylinder')}>"


class Cones(Shapes):
    """Cones between two discs, which ``+`` joins with other shapes: ``(spheres + cones).render()``.

    Parameters
    ----------
    start, end
        The middles of both ends: shape (n, 3).
    radii
        The radii of both ends: a pair for all, or shape (n, 2). A tip has the radius 0.
    round
        Whether the ends are round, a sphere at each, which the side touches.
    caps, color, material, opacity
        As for ``Cylinders``.

    >>> import pinhole
    >>> pinhole.Cones([[0, 0, 0]], [[0, 0, 1]], (0.5, 0))
    <pinhole.Cones: 1 cone>
    """

    __slots__ = ("_count",)

    _count: int

    def __init__(
        self,
        start: Any,
        end: Any,
        radii: Any,
        *,
        caps: str | None = None,
        round: bool = False,
        color: Any = None,
        material: Any = None,
        opacity: Any = None,
    ) -> None:
        starts, ends = _ends(start, end)
        array = _arrays.numbers("radii", radii)
        if array.shape not in ((2,), (len(starts), 2)):
            raise InputError(
                f"radii has the shape {array.shape}; it must be (2,) for all cones, or ({len(starts)}, 2); with one radius, "
                "write Cylinders(...)"
            )
        _make(self, starts, ends, np.broadcast_to(array, (len(starts), 2)), caps, round, color, material, opacity)

    def __len__(self) -> int:
        return self._count

    def __repr__(self) -> str:
        return f"<pinhole.Cones: {counted(len(self), 'cone')}>"


def _ends(start: Any, end: Any) -> tuple[Array, Array]:
    """Both ends in float64."""
    starts, ends = _arrays.positions("start", start), _arrays.positions("end", end)
    if len(starts) != len(ends):
        raise InputError(f"start has {len(starts)} rows and end has {len(ends)}; each shape has one in both")
    return _arrays.floats(starts, np.float64), _arrays.floats(ends, np.float64)


def _make(
    shapes: Cylinders | Cones,
    start: Array,
    end: Array,
    radii: Array,
    caps: str | None,
    round: bool,
    color: Any,
    material: Any,
    opacity: Any,
) -> None:
    """Fills new cylinders or cones."""
    if caps is not None and caps not in CAPS:
        raise InputError(f"caps is {caps!r}; it must be one of {', '.join(CAPS)}")
    if round and caps is not None:
        raise InputError("caps and round exclude each other; remove one of them")
    count, what = len(start), type(shapes).__name__.lower()
    for name, given in (("material", _arrays.is_list(material)), ("opacity", np.ndim(opacity) > 0)):
        if given:
            raise InputError(f"{name}: all {what} have one; make several {type(shapes).__name__}(...) and add them")
    settings: dict[str, Any] = {"material": material, "opacity": opacity}
    colors = None
    if color is not None and _arrays.is_colors(color):
        colors = _arrays.colors(color, count, what)
        if colors.shape[1] == 4:
            raise InputError(f"color has an alpha, which {what} do not have; write color[:, :3], and give opacity to all")
    elif color is not None:
        colors = _arrays.named_colors(color, count)
        if colors is None:
            settings["color"] = _arrays.triple(color)
    shapes._settings = _settings.data_settings(settings)
    shapes._count, shapes.camera = count, None
    radii = np.ascontiguousarray(_arrays.floats(radii, np.float64))
    text = _settings.data_text(shapes._settings)
    shapes._data = SphereData.of_cones([start, end, radii], colors, caps or "both", bool(round), text)
    warn(shapes._data.notes)
