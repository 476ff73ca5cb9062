"""Spheres and their methods."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _arrays, _progress, _settings
from ._camera import Camera, as_camera
from ._certificate import Certificate
from ._errors import InputError, Note, PackageError
from ._image import Image
from ._movie import movie
from ._orbit import rotation
from ._pinhole import SphereData

if TYPE_CHECKING:
    from ._pinhole import JoinedFrames
    from ._view import View

Array = npt.NDArray[Any]


class Spheres:
    """Spheres with radii and colours.

    Parameters
    ----------
    positions
        Centres in any unit of length: shape (n, 3), any float or integer type, any strides. float64 keeps its precision:
        spheres are stored as float32 offsets from a float64 origin.
    radius
        about touch.
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
        Named arrays of shape (n,), for ``color_by``, ``radius_by``, ``select`` and so on.
    settings
        The keys of a scene file about data: ``color_by``, ``radius_by``, ``opacity_by``, ``emission_by``,
        ``select``, ``leave_out``, ``elements``, ``bonds``, ``box``, ``radius_scale``.

    >>> import pinhole
    >>> pinhole.Spheres([[0, 0, 0], [1, 0, 0]], radius=0.5, color="tomato")
    <pinhole.Spheres: 2 spheres>
    """

    __slots__ = ("_data", "_settings", "camera")

    #: The default camera of ``render``.
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
        material: Any = None,
        columns: Mapping[str, Any] | None = None,
        **settings: Any,
    ) -> None:
        centers = _arrays.positions("positions", positions)
        count = len(centers)
        radii = _arrays.radii(radius, centers)
        if columns is not None and not hasattr(columns, "items"):
            raise InputError(f"columns is {type(columns).__name__}; it must be a dict of names and arrays of shape ({count},)")
        named = {
            str(name): _arrays.column(f"columns[{name!r}]", item, count)
            for name, item in ({} if columns is None else columns).items()
        }
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
            settings["color"] = _triple(color)
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
        self._data = SphereData.of_arrays(centers, radii, colors, list(named.items()), text)
        warn(self._data.notes)

    @classmethod
    def _of(cls, data: SphereData, settings: dict[str, Any], camera: Camera | None = None) -> Spheres:
        made = cls.__new__(cls)
        made._data, made._settings, made.camera = data, settings, camera
        return made

    def with_(self, *, cmap: str | None = None, color_range: tuple[Any, Any] | None = None, **settings: Any) -> Spheres:
        """The same data with other settings, for spheres with columns. Arguments are the settings of ``Spheres``."""
        if cmap is not None or color_range is not None:
            by = settings.get("color_by", self._settings.get("color_by"))
            settings["color_by"] = _with_map(by, cmap, color_range)
        checked = {**self._settings, **_settings.data_settings(settings)}
        made = self._of(self._data.restyled(_settings.data_text(checked)), checked, self.camera)
        warn(made._data.notes)
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
    def notes(self) -> list[str]:
        """Notes for the user about the data, such as the range of colours."""
        return self._data.notes

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
        """Returns the text of the scene file for a picture with these settings. It names the data ``spheres``."""
        return self._text(settings)[0]

    def _text(self, settings: Mapping[str, Any]) -> _settings.Text:
        tables = _settings.picture_settings(settings)
        tables = {"style": _settings.style_of(tables), **tables}
        camera = tables.pop("camera", None)
        camera = as_camera(self.camera if camera is None else camera)
        tables["camera"] = camera._table(self._data) if isinstance(camera, Camera) else camera
        data = {"data": "spheres", **self._settings} if self._settings else {}
        return _settings.scene_text({**data, **tables})

    def render(
        self,
        size: tuple[int, int] | None = None,
        *,
        style: str | None = None,
        samples: int | None = None,
        camera: Camera | str | tuple[float, float] | Mapping[str, Any] | None = None,
        layers: Iterable[str] = (),
        backend: str = "auto",
        progress: bool | Callable[[float], object] | None = None,
        **settings: Any,
    ) -> Image:
        """Renders a picture.

        Parameters
        ----------
        size
            Width and height in pixels; by default 800 by 600.
        style
            A look: ``"default"``, ``"fast"``, ``"path"`` and so on, as in the program's ``--style``.
        samples
            Samples for each pixel.
        camera
            A ``Camera``; a view such as ``"iso"`` or (azimuth, elevation); or the table ``camera`` of a scene file as a dict.
        layers
            Names of layers besides colour: alpha, depth, normal, position, albedo, id, samples, variance.
        backend
            ``"gpu"``, ``"cpu"``, or ``"auto"``: the CPU if there is no adapter, or for random rays if the adapter is
            software.
        progress
            Whether a line on standard error shows the progress, or a function that is called with numbers from 0 to 1.
        settings
            The tables and keys of a scene file: ``studio``, ``path``, ``sampling``, ``lights``, ``sky``, ``sun``,
            ``ground``, ``background``, ``legend``, ``scale_bar``, ``labels``, ``output``. Short forms are ``light``
            (primary, studio or path), and the flags of the program for keys of such a table, such as ``denoise``,
            ``seed``, ``filter``, ``transparent``, ``exposure``, ``tone``, ``bits``, ``dpi`` and ``text_scale``.

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
        warn(picture.notes)
        return Image(picture)

    def view(
        self,
        size: tuple[int, int] = (640, 480),
        *,
        style: str | None = None,
        camera: Camera | str | Mapping[str, Any] | None = None,
        **settings: Any,
    ) -> View:
        """Shows a view in a notebook. Drag to turn it, use the wheel to zoom, and click to pick a sphere.

        It needs the package anywidget: ``pip install pinhole-rt[notebook]``. ``size`` is in CSS pixels; a screen may
        have several pixels for each. Further arguments are those of ``render``.
        """
        try:
            from ._view import View
        except ModuleNotFoundError as error:
            if (error.name or "").split(".")[0] not in ("anywidget", "ipywidgets", "traitlets"):
                raise
            raise PackageError(
                f"views need the package {error.name}: pip install 'pinhole-rt[notebook]'; render(...) needs none"
            ) from None
        return View(self, size, camera, {"style": style, **settings})

    def verify(self, size: tuple[int, int] | None = None, **settings: Any) -> Certificate:
        """Renders the view with one ray for each pixel on the device, and decides pixel by pixel whether a conforming
        device may have made this picture. Light is not checked. Arguments are those of ``render``.
        """
        text = self._text({**settings, "size": size})
        return Certificate(self._data.verify(text))

    def _placed(
        self, settings: Mapping[str, Any], *, frames: JoinedFrames | None = None, axis: Array | None = None
    ) -> dict[str, Any]:
        """Returns the table of a camera with its position. It frames several frames, the body that these spheres sweep
        as they turn about an axis, or by default these spheres.
        """
        settings = {key: of for key, of in settings.items() if key not in ("backend", "layers", "progress")}
        text = self._text(settings)
        around = None if axis is None else axis.tolist()
        found = self._data.placed(text, around) if frames is None else frames.placed(text)
        placed: dict[str, dict[str, Any]] = json.loads(found)
        return {kind: {key: of for key, of in keys.items() if of is not None} for kind, keys in placed.items()}

    def turntable(
        self, path: str | os.PathLike[str], *, frames: int = 120, fps: float = 25.0, **settings: Any
    ) -> None:
        """Renders a movie in which the camera goes once around the spheres, about the direction that is up,
        at a distance from which they fit into every picture.

        ``path`` is as for ``pinhole.movie``; further arguments are those of ``render``.
        """
        if not isinstance(frames, (int, np.integer)) or frames < 1:
            raise InputError(f"frames is {frames!r}; it must be a whole number of at least 1")
        camera = settings.pop("camera", None)
        camera = as_camera(self.camera if camera is None else camera)
        if not isinstance(camera, Camera) or camera.kind != "pinhole":
            raise InputError("a turntable needs a pinhole camera, such as Camera.frame(view, zoom=...)")
        up = np.array(camera.up or self._data.view_axes("x", 0.0, None)[1], float)
        up = up / np.linalg.norm(up)
        (kind, placed), = self._placed({**settings, "camera": camera}, axis=up).items()
        eye = np.array(placed["eye"])
        bounds = self.bounds
        middle = np.zeros(3) if bounds is None else (bounds[0] + bounds[1]) / 2
        look = np.array(placed["look_at"]) - eye if "look_at" in placed else np.array(placed["direction"])
        top = np.array(placed.get("up", up))
        rest = {key: of for key, of in placed.items() if key not in ("eye", "look_at", "direction", "up")}

        def turned(number: int) -> dict[str, Any]:
            turn = rotation(up, 2 * np.pi * number / frames)
            place = {"eye": middle + turn @ (eye - middle), "direction": turn @ look, "up": turn @ top}
            return {kind: {**place, **rest}}

        movie(path, (self.render(camera=turned(number), **settings) for number in range(frames)), fps=fps)

    def update(self, *, positions: Any = None, radius: Any = None, color: Any = None, first: int = 0) -> None:
        """Gives spheres new centres, radii or colours in place, from the sphere ``first`` on.

        ``positions`` has the shape (k, 3), ``radius`` (k,) and ``color`` (k, 3) or (k, 4) in uint8. Colours can change
        only if spheres were made with such colours. Spheres with bonds keep their places and radii. The device keeps its copy, and rebuilds only the changed parts.
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


def _triple(color: Any) -> Any:
    """Returns a colour as a scene file writes it."""
    if isinstance(color, str):
        return color
    numbers = _arrays.numbers("color", color)
    if numbers.dtype.kind in "iu" and numbers.max() > 1:
        bytes_of = "#" + "".join(f"{int(number) & 255:02x}" for number in numbers)
        raise InputError(
            f'color is {numbers.tolist()}; a triple is linear light from 0 to 1; for bytes in sRGB write "{bytes_of}"'
        )
    return [float(number) for number in numbers]


def warn(notes: Iterable[str]) -> None:
    """Warns the user about notes, which are not errors."""
    for note in notes:
        if note.startswith("colors show "):
            # A default range is to be expected, and `Spheres.notes` has it.
            continue
        warnings.warn(note.replace("--radius sets it", "radius=... sets it"), Note, stacklevel=3)
