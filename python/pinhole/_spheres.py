"""Spheres and their methods."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, overload

import numpy as np
import numpy.typing as npt

from . import _arrays, _settings
from ._camera import Camera
from ._errors import ForeignName, InputError
from ._pinhole import SphereData, column_of, mask, of_arrays, restyled, taken
from ._shapes import Shapes, counted, warn

Array = npt.NDArray[Any]


class Spheres(Shapes):
    """Spheres with radii and colours.

    Parameters
    ----------
    positions
        Centres in any unit of length: shape (n, 3), any float or integer type, any strides. float64 keeps its precision:
        spheres are stored as float32 offsets from a float64 origin.
    radius
        One number or an array of shape (n,), in the unit of the positions; without it, one with which neighbours
        about touch.
    color
        A CSS colour such as ``"steelblue"``, or n of them; a linear triple (r, g, b); an array of shape (n, 3) or (n, 4) in
        uint8 (sRGB), or (n, 3) in floats (linear light); or n numbers or other texts, which ``cmap`` turns into colours.
    cmap
        The name of a colour map, such as ``"viridis"``.
    color_range
        The numbers at both ends of the colour map, or percentiles such as ``("2%", "98%")``; by default all values.
    opacity
        One number from 0 to 1, or an array of shape (n,).
    material
        A ``Material``; or a list of n, which may be names from ``materials={"name": Material(...)}``.
    columns
        Named arrays of shape (n,), for ``color_by``, ``radius_by``, ``select`` and so on; one of shape (n, 3) is a vector. A
        column ``element`` gives radii and colours, and ``name`` with ``resname`` does so for atoms.
    cell
        The edges of the periodic cell: three lengths, or shape (3, 3) with an edge in each row. It starts at ``origin``,
        and ``pbc`` says along which edges the data repeats.
    pairs
        Bonds, shape (k, 2): pairs of indices. They are drawn where bonds are, as with ``bonds=True``.
    settings
        The keys of a scene file about data: ``color_by``, ``radius_by``, ``opacity_by``, ``emission_by``,
        ``select``, ``leave_out``, ``elements``, ``bonds``, ``box``, ``radius_scale``, ``show``, ``replicate``. ``kind`` is
        the kind of data, such as ``"crystal"``, which decides what no setting says; ``"plain"`` decides nothing.

    >>> import pinhole
    >>> pinhole.Spheres([[0, 0, 0], [1, 0, 0]], radius=0.5, color="tomato")
    <pinhole.Spheres: 2 spheres>
    """

    __slots__ = ()

    def __init__(
        self,
        positions: Any,
        radius: Any = None,
        color: Any = None,
        *,
        cmap: str | None = None,
        color_range: tuple[Any, Any] | None = None,
        opacity: Any = None,
        material: Any = None,
        columns: Mapping[str, Any] | None = None,
        cell: Any = None,
        origin: Any = None,
        pbc: Any = True,
        pairs: Any = None,
        **settings: Any,
    ) -> None:
        centers = _arrays.positions("positions", positions)
        count = len(centers)
        radii = _arrays.radii(radius, centers)
        named = _arrays.columns(columns, count)
        cmap = _arrays.map_name(cmap)
        colors = None
        if color is not None and _arrays.is_colors(color):
            colors = _arrays.colors(color, count)
        elif color is not None and (by_name := _arrays.named_colors(color, count)) is not None:
            colors = by_name
        elif color is not None and not isinstance(color, str) and not _is_triple(color, count):
            named["color"] = _arrays.column("color", color, count)
            by = {"column": "color", "map": cmap, "range": color_range}
            if settings.get("color_by") is not None:
                raise InputError("color and color_by say the same; remove one of them")
            settings["color_by"] = {key: item for key, item in by.items() if item is not None}
            cmap = color_range = None
        elif color is not None:
            settings["color"] = _arrays.triple(color)
        if cmap is not None or color_range is not None:
            settings["color_by"] = _with_map(settings.get("color_by"), cmap, color_range)
        if opacity is not None and np.ndim(opacity) > 0:
            named["opacity"] = _arrays.column("opacity", opacity, count)
            settings["opacity_by"] = "opacity"
        elif opacity is not None:
            settings["opacity"] = opacity
        if material is not None and _arrays.is_list(material):
            for other in ("elements", "elements_by"):
                if settings.get(other) is not None:
                    raise InputError(f"material for each sphere and {other} exclude each other; remove one of them")
            firsts, indices = _arrays.materials(material, count)
            tables, names = _settings.material_tables(firsts, settings.get("materials"))
            named["material"] = (names, indices)
            settings["materials"] = tables
            settings["elements_by"] = ["material"]
            settings["elements"] = {name: {"material": name} for name in names}
        elif material is not None:
            settings["material"] = material
        self._settings = _settings.data_settings(settings)
        self.camera = None
        text = _settings.data_text(self._settings)
        edges, bonds = _arrays.cell(cell, origin, pbc), _arrays.pairs(pairs, count)
        self._data = of_arrays(centers, radii, colors, list(named.items()), text, edges, bonds, None)
        warn(self._data.notes)

    @classmethod
    def _of(cls, data: SphereData, settings: dict[str, Any], camera: Camera | None = None) -> Spheres:
        made = cls.__new__(cls)
        made._data, made._settings, made.camera = data, settings, camera
        return made

    def show(self, *rule: Any, **keys: Any) -> Spheres:
        """Returns these spheres with one more rule for what is drawn.

        ``spheres.show("resname HEM", "sticks", carbon="orange")`` draws a selection in a style, and
        ``spheres.show("balls")`` all. The last rule for a sphere counts. Styles are spacefill, balls, sticks, lines,
        points, trace, ghost and hidden; keys are radius, scale, stick, color, carbon, opacity and material.
        """
        if len(rule) not in (1, 2):
            raise InputError(
                'show(selection, style) says what is drawn, such as show("resname HEM", "sticks"); render(...) makes a picture'
            )
        made = {"select": _settings.selection(rule[0]) if len(rule) == 2 else None, "as": rule[-1], **keys}
        return self.with_(show=[*self._settings.get("show", []), made])

    def with_(self, *, cmap: str | None = None, color_range: tuple[Any, Any] | None = None, **settings: Any) -> Spheres:
        """The same data with other settings, for spheres with columns. Arguments are the settings of ``Spheres``."""
        if cmap is not None or color_range is not None:
            by = settings.get("color_by", self._settings.get("color_by"))
            settings["color_by"] = _with_map(by, _arrays.map_name(cmap), color_range)
        checked = {**self._settings, **_settings.data_settings(settings)}
        return self._made(restyled(self._data, _settings.data_text(checked)), checked)

    def _made(self, data: SphereData, settings: dict[str, Any]) -> Spheres:
        """Spheres of other data, with the same camera."""
        warn(data.notes)
        return self._of(data, settings, self.camera)

    def mask(self, selection: str | Mapping[str, Any]) -> Array:
        """Whether a selection such as ``"protein and within 5 of resname HEM"`` chooses each sphere of the picture: bool, of
        shape (n,).
        """
        chosen, notes = mask(self._data, _settings.selection(selection))
        warn(notes)
        return chosen

    def select(self, selection: str | Mapping[str, Any]) -> Spheres:
        """The spheres that a selection chooses, such as ``"chain A"`` or ``{"chain": "A"}``, as spheres of their own."""
        selection = _settings.selection(selection)
        if self.columns or self.cell is not None:
            before = self._settings.get("select")
            return self.with_(select=selection if before is None else f"({before}) and ({selection})")
        chosen = self.mask(selection)
        if not chosen.any():
            raise InputError(f"select: nothing is chosen by {selection!r}")
        return self[chosen]

    def __len__(self) -> int:
        return len(self._data)

    @property
    def kind(self) -> str | None:
        """The name of the kind of data, which decides what no setting says; None for spheres with a colour for each."""
        return self._data.kind()[0]

    def __getattr__(self, name: str) -> Any:
        if name.startswith(("add_", "set_", "addStyle", "setStyle")):
            raise ForeignName(f'Spheres has no {name}; spheres.show("resname HEM", "sticks") says what is drawn as what')
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    def __repr__(self) -> str:
        names = self._data.column_names()
        columns = f", columns {', '.join(names)}" if names else ""
        return f"<pinhole.Spheres: {counted(len(self), 'sphere')}{columns}>"

    @property
    def positions(self) -> Array:
        """A copy of the centres used in pictures: float64, (n, 3)."""
        return self._data.positions()

    @property
    def radii(self) -> Array:
        """A copy of the radii used in pictures: float32, (n,)."""
        return self._data.radii()

    @property
    def cell(self) -> Array | None:
        """The three edges of the periodic cell: float64, (3, 3), one in each row; None if there is none."""
        cell = self._data.cell()
        return None if cell is None else np.array(cell)

    @property
    def color_key(self) -> dict[str, Any] | None:
        """The meaning of colours, if a column gives them: ``title``; and either ``range`` (two numbers), ``log``
        (a bool) and ``colors`` (uint8 sRGB, (k, 3), low end first), or ``categories`` (names, colours in uint8 sRGB).
        """
        key: dict[str, Any] | None = self._data.color_key()
        if key is not None and "colors" in key:
            key["colors"] = np.frombuffer(key["colors"], np.uint8).reshape(-1, 3)
        elif key is not None:
            key["categories"] = dict(key["categories"])
        return key

    @property
    def columns(self) -> list[str]:
        """The names of the columns."""
        return self._data.column_names()

    @overload
    def __getitem__(self, name: str) -> Array: ...
    @overload
    def __getitem__(self, name: Any) -> Spheres: ...
    def __getitem__(self, name: Any) -> Any:
        """A column, such as ``spheres["b_factor"]``: float64 or text, of shape (n,); a vector has the shape (n, 3).
        ``"x"``, ``"radius"`` and ``"index"`` always exist. A mask, a slice or an array of indices gives a part of the spheres.
        """
        if isinstance(name, str):
            found = column_of(self._data, name)
            if isinstance(found, tuple):
                names, indices = found
                return np.array(names)[indices]
            return found
        taken_already = {"select", "leave_out", "replicate"}
        if not self.columns and self.cell is None:
            # These spheres have their final radii.
            taken_already.add("radius_scale")
        rest = {key: of for key, of in self._settings.items() if key not in taken_already}
        indices = _arrays.indices(name, len(self))
        return self._made(taken(self._data, indices, _settings.data_text(rest)), rest)

    def update(self, *, positions: Any = None, radius: Any = None, color: Any = None, first: int | None = None) -> None:
        """Gives spheres new centres, radii or colours in place: all of them, or those from the sphere ``first`` on.

        ``positions`` has the shape (k, 3), ``radius`` (k,) and ``color`` (k, 3) or (k, 4) in uint8. Colours can change
        only if spheres were made with such colours. Spheres with bonds keep their places and radii. The device keeps its copy, and rebuilds only the changed parts.
        """
        centers = None if positions is None else np.ascontiguousarray(_arrays.positions("positions", positions))
        count = len(self) - (first or 0) if centers is None else len(centers)
        given = [len(array) for array in (centers, radius, color) if array is not None and np.ndim(array) > 0]
        if first is None and any(length != len(self) for length in given):
            raise InputError(
                f"there are {min(given)} new values for {len(self)} spheres; first=... says which sphere is the first, "
                "and other numbers of spheres need new Spheres(...)"
            )
        first = first or 0
        radii = None
        if radius is not None:
            like = np.zeros((count, 3), np.float32)
            found = _arrays.radii(radius, like)
            radii = np.full(count, found, np.float32) if isinstance(found, float) else np.ascontiguousarray(found)
        colors = None
        if color is not None:
            colors = _arrays.colors(color, count)
            if colors.dtype != np.uint8:
                raise InputError(f"color has the type {colors.dtype}; updates take uint8")
            if colors.shape[1] == 3:
                colors = np.concatenate([colors, np.full((count, 1), 255, np.uint8)], axis=1)
            colors = np.ascontiguousarray(colors)
        self._data.update(first, centers, radii, colors)


def _with_map(color_by: Any, cmap: str | None, color_range: tuple[Any, Any] | None) -> dict[str, Any]:
    """Returns the table ``color_by`` with another colour map or range."""
    if color_by is None:
        what = "cmap" if cmap is not None else "color_range"
        raise InputError(f"{what} needs numbers: give color an array of shape (n,), or name a column in color_by")
    table = {"column": color_by} if isinstance(color_by, str) else dict(color_by)
    given = {"map": cmap, "range": color_range}
    return {**table, **{key: item for key, item in given.items() if item is not None}}


def _is_triple(color: Any, count: int) -> bool:
    """Whether three numbers are a single colour rather than values for three spheres."""
    array = np.asarray(color)
    is_three = array.shape == (3,) and array.dtype.kind in "biuf"
    return is_three and (count != 3 or isinstance(color, (tuple, list)))
