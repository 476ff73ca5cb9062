"""What all shapes have in common: pictures of them, and sums."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _progress, _settings
from ._camera import Camera, as_camera
from ._certificate import Certificate
from ._errors import InputError, Note, PackageError
from ._image import Image
from ._movie import movie
from ._orbit import rotation
from ._pinhole import SphereData
from ._settings import Text

if TYPE_CHECKING:
    from ._pinhole import JoinedFrames
    from ._view import View

Array = npt.NDArray[Any]


class Shapes:
    """Shapes that are rendered together: ``Spheres``, ``Cylinders``, ``Cones``, or a sum of them such as
    ``spheres + cylinders``.

    A sum is a copy: later updates of its parts do not change it. Ids are those of all spheres, in the order of the sum,
    and then those of cylinders and cones. If several parts have a colour key, a legend shows that of the first.
    """

    __slots__ = ("_data", "_settings", "camera")

    _data: SphereData
    _settings: dict[str, Any]
    #: The default camera of ``render``.
    camera: Camera | None

    def __add__(self, other: Shapes) -> Shapes:
        if not isinstance(other, Shapes):
            return NotImplemented
        made = Shapes.__new__(Shapes)
        made._data, made._settings = self._data.joined(other._data), {}
        made.camera = other.camera if self.camera is None else self.camera
        return made

    def __repr__(self) -> str:
        spheres, cones = len(self._data), self._data.cone_count()
        return f"<pinhole.Shapes: {counted(spheres, 'sphere')}, {counted(cones, 'cone')}>"

    def _repr_png_(self) -> bytes:
        return self.render(size=(640, 480))._repr_png_()

    @property
    def bounds(self) -> tuple[Array, Array] | None:
        """The smallest and the largest coordinates that spheres reach, in scene units; None if there are no spheres."""
        found = self._data.bounds()
        return None if found is None else (np.array(found[0]), np.array(found[1]))

    @property
    def notes(self) -> list[str]:
        """Notes for the user about the data, such as the range of colours."""
        return self._data.notes

    def scene_file(self, **settings: Any) -> str:
        """Returns the text of the scene file for a picture with these settings. It names the data ``spheres``."""
        return self._text(settings)[0]

    def _text(self, settings: Mapping[str, Any]) -> Text:
        tables = _settings.picture_settings(settings)
        _, of_kind, usual, _, look = self._data.kind()
        style = _settings.style_of(tables)
        if not any(key in tables for key in ("style", "integrator", "studio", "background")):
            of_kind += look
        if style == "default" and usual is not None and "style" not in tables and "background" not in tables:
            style = usual
        tables = {"style": style, **tables}
        camera = tables.pop("camera", None)
        camera = as_camera(self.camera if camera is None else camera)
        tables["camera"] = camera._table(self._data) if isinstance(camera, Camera) else camera
        data = {"data": "spheres", **self._settings} if self._settings or of_kind else {}
        text, arguments, kind = _settings.scene_text({**data, **tables})
        # What follows from the kind of data stands before all tables.
        return of_kind + text, [*("" for _ in of_kind.splitlines()), *arguments], kind

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
        if not isinstance(camera, Camera) or camera.kind not in (None, "pinhole"):
            raise InputError("a turntable needs a pinhole camera, such as Camera.frame(view, zoom=...)")
        _, direction, usual = camera._usual(self._data)
        keys = camera.keys if direction is None else {**camera.keys, "direction": direction}
        camera = Camera("pinhole", view=camera.view, turn=camera.turn, up=camera.up or usual, **keys)
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


def counted(count: int, noun: str) -> str:
    """A number of things."""
    return f"{count} {noun if count == 1 else noun + 's'}"


def warn(notes: Iterable[str]) -> None:
    """Warns the user about notes, which are not errors."""
    for note in notes:
        if note.startswith("colors show "):
            # A default range is to be expected, and `Spheres.notes` has it.
            continue
        warnings.warn(note, Note, stacklevel=3)
