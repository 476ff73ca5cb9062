"""Spheres, and what can be done with them."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _arrays, _progress, _settings
from ._camera import Camera
from ._errors import InputError, Note
from ._image import Image
from ._pinhole import SphereData

Array = npt.NDArray[Any]


class Spheres:
    """Spheres with radii and colours.

    Parameters
    ----------
    positions
        Centres in any unit of length: shape (n, 3), any float or integer type, any strides. float64 keeps its precision:
        spheres are stored as float32 offsets from a float64 origin.
    radius
        One radius or an array of shape (n,), in the unit of the positions. Without it, spheres are so large that neighbours
        about touch.
    color
        A CSS colour such as ``"steelblue"``; a linear triple (r, g, b); an array of shape (n, 3) or (n, 4) in uint8 (sRGB),
        or (n, 3) in floats (linear light); or n numbers or texts, which ``cmap`` turns into colours.
    cmap
        The name of a colour map, such as ``"viridis"``.
    color_range
        The numbers at both ends of the colour map, or percentiles such as ``("2%", "98%")``; by default all are in range.
    opacity
        From 0 to 1: one number, or an array of shape (n,).
    columns
        Named arrays of shape (n,), for ``color_by``, ``radius_by``, ``select`` and so on.
    settings
        The keys of a scene file about data: ``material``, ``color_by``, ``radius_by``, ``opacity_by``, ``emission_by``,
        ``select``, ``leave_out``, ``elements``, ``bonds``, ``box``, ``radius_scale``.

    >>> import pinhole
    >>> pinhole.Spheres([[0, 0, 0], [1, 0, 0]], radius=0.5, color="tomato")
    <pinhole.Spheres: 2 spheres>
    """

    __slots__ = ("_data", "_settings", "camera")

    #: The camera of pictures for which ``render`` is given none.
    camera: Camera | None

    def __init__(
        self,
        positions: Any,
        radius: Any = None,
        color: Any = None,
        *,
        cmap: str | None = None,
        color_range: tuple[Any, Any] | None = None,
        opacity: Any = None,
        columns: Mapping[str, Any] | None = None,
        **settings: Any,
    ) -> None:
        centers = _arrays.positions("positions", positions)
        count = len(centers)
        radii = _arrays.radii(radius, centers)
        named = {str(name): _arrays.column(f"columns[{name!r}]", item, count) for name, item in (columns or {}).items()}
        colors = None
        if color is not None and _arrays.is_colors(color):
            colors = _arrays.colors(color, count)
        elif color is not None and not isinstance(color, str) and not _is_triple(color, count):
            named["color"] = _arrays.column("color", color, count)
            by = {"column": "color", "map": cmap, "range": color_range}
            if settings.get("color_by") is not None:
                raise InputError("color and color_by say the same; remove one of them")
            settings["color_by"] = {key: item for key, item in by.items() if item is not None}
            cmap = color_range = None
        elif color is not None:
            settings["color"] = _triple(color)
        if cmap is not None or color_range is not None:
            named_by = settings.get("color_by")
            if named_by is None:
                what = "cmap" if cmap is not None else "color_range"
                raise InputError(f"{what} needs numbers: give color an array of shape (n,), or name a column in color_by")
            table = {"column": named_by} if isinstance(named_by, str) else dict(named_by)
            given = {"map": cmap, "range": color_range}
            settings["color_by"] = {**table, **{key: item for key, item in given.items() if item is not None}}
        if opacity is not None and np.ndim(opacity) > 0:
            named["opacity"] = _arrays.column("opacity", opacity, count)
            settings["opacity_by"] = "opacity"
        elif opacity is not None:
            settings["opacity"] = opacity
        self._settings = _settings.data_settings(settings)
        self.camera = None
        text = _settings.data_text(self._settings)
        self._data = SphereData.of_arrays(centers, radii, colors, list(named.items()), text)
        _warn(self._data.notes)

    @classmethod
    def _of(cls, data: SphereData, settings: dict[str, Any], camera: Camera | None = None) -> Spheres:
        made = cls.__new__(cls)
        made._data, made._settings, made.camera = data, settings, camera
        return made

    def with_(self, **settings: Any) -> Spheres:
        """The same data with other settings, for spheres with columns. Arguments are the settings of ``Spheres``."""
        checked = {**self._settings, **_settings.data_settings(settings)}
        made = self._of(self._data.restyled(_settings.data_text(checked)), checked, self.camera)
        _warn(made._data.notes)
        return made

    def __len__(self) -> int:
        return len(self._data)

    def __repr__(self) -> str:
        names = self._data.column_names()
        columns = f", columns {', '.join(names)}" if names else ""
        return f"<pinhole.Spheres: {len(self)} {'sphere' if len(self) == 1 else 'spheres'}{columns}>"

    def _repr_png_(self) -> bytes:
        return self.render(size=(640, 480))._repr_png_()

    @property
    def bounds(self) -> tuple[Array, Array] | None:
        """The smallest and the largest coordinates that spheres reach, in scene units; None if there are no spheres."""
        found = self._data.bounds()
        return None if found is None else (np.array(found[0]), np.array(found[1]))

    @property
    def positions(self) -> Array:
        """A copy of the centres as they are rendered: float64, (n, 3)."""
        return self._data.positions()

    @property
    def radii(self) -> Array:
        """A copy of the radii as they are rendered: float32, (n,)."""
        return self._data.radii()

    @property
    def cell(self) -> Array | None:
        """The three edges of the periodic cell: float64, (3, 3), one in each row; None if there is none."""
        cell = self._data.cell()
        return None if cell is None else np.array(cell)

    @property
    def columns(self) -> list[str]:
        """The names of the columns."""
        return self._data.column_names()

    def __getitem__(self, name: str) -> Array:
        """A column: float64, or text, of shape (n,)."""
        found = self._data.column(name)
        if found is None:
            raise InputError(f"there is no column {name!r}; the columns are {', '.join(self.columns) or 'none'}")
        if isinstance(found, tuple):
            names, indices = found
            return np.array(names)[indices]
        return found

    def scene_file(self, **settings: Any) -> str:
        """The text of the scene file that a picture with these settings has; its data has the name ``spheres``."""
        return self._text(settings)[0]

    def _text(self, settings: Mapping[str, Any]) -> _settings.Text:
        tables = _settings.picture_settings(settings)
        tables = {"style": _settings.style_of(tables), **tables}
        camera = tables.pop("camera", None) or self.camera or Camera()
        if isinstance(camera, str):
            camera = Camera(view=camera)
        tables["camera"] = camera._table(self._data) if isinstance(camera, Camera) else camera
        data = {"data": "spheres", **self._settings} if self._settings else {}
        return _settings.scene_text({**data, **tables})

    def render(
        self,
        size: tuple[int, int] | None = None,
        *,
        style: str | None = None,
        samples: int | None = None,
        camera: Camera | str | Mapping[str, Any] | None = None,
        layers: Iterable[str] = (),
        backend: str = "auto",
        progress: bool | Callable[[float], object] | None = None,
        **settings: Any,
    ) -> Image:
        """Renders a picture.

        Parameters
        ----------
        size
            Width and height in pixels; 800 by 600 without it.
        style
            A look: ``"default"``, ``"fast"``, ``"path"`` and so on, as in the program's ``--style``.
        samples
            Samples for each pixel.
        camera
            A ``Camera``; a view such as ``"iso"``; or the table ``camera`` of a scene file as a dict.
        layers
            Names of layers besides colour: alpha, depth, normal, position, albedo, id, samples, variance.
        backend
            ``"gpu"``, ``"cpu"``, or ``"auto"``: the CPU if there is no adapter.
        progress
            Whether a line on standard error shows the progress, or a function that is called with numbers from 0 to 1.
        settings
            The tables and keys of a scene file: ``studio``, ``path``, ``sampling``, ``lights``, ``sky``, ``sun``,
            ``ground``, ``background``, ``legend``, ``scale_bar``, ``labels``, ``output``; and the short forms ``light``
            (primary, studio or path), ``denoise``, ``seed``, ``transparent``, ``exposure``, ``tone``, ``bits``
            and ``dpi``.

        >>> image = pinhole.Spheres([[0, 0, 0]], radius=1).render(size=(64, 48), backend="cpu", layers=["id"])
        >>> image.id[24, 32]
        np.uint32(0)
        """
        text = self._text({**settings, "size": size, "style": style, "samples": samples, "camera": camera})
        if isinstance(layers, str):
            layers = [layers]
        call, line = _progress.chosen(progress)
        try:
            picture = self._data.render(text, list(layers), backend, call)
        finally:
            if line is not None:
                line.close()
        _warn(picture.notes)
        return Image(picture)

    def update(self, *, positions: Any = None, radius: Any = None, color: Any = None, first: int = 0) -> None:
        """Gives spheres new centres, radii or colours in place, from the sphere ``first`` on.

        ``positions`` has the shape (k, 3), ``radius`` (k,) and ``color`` (k, 3) or (k, 4) in uint8, which needs spheres that
        were made with such colours. The device keeps its copy and builds only what must be built anew.
        """
        centers = None if positions is None else np.ascontiguousarray(_arrays.positions("positions", positions))
        count = len(self) - first if centers is None else len(centers)
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


def _is_triple(color: Any, count: int) -> bool:
    """Whether three numbers are one colour, and not those of three spheres."""
    return np.shape(color) == (3,) and (count != 3 or isinstance(color, (tuple, list)))


def _triple(color: Any) -> Any:
    """A colour as a scene file has it."""
    return color if isinstance(color, str) else [float(number) for number in _arrays.numbers("color", color)]


def _warn(notes: Iterable[str]) -> None:
    """Tells the user what is not an error."""
    for note in notes:
        warnings.warn(note.replace("--radius sets it", "radius=... sets it"), Note, stacklevel=3)
