"""The view of spheres in a notebook, a widget that needs the package anywidget."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import anywidget
import numpy as np
import traitlets
from ipywidgets import CallbackDispatcher

from ._camera import Camera
from ._errors import Error, InputError
from ._image import Image
from ._orbit import Orbit
from ._refine import Refiner, Stage, checked_size, screen_size
from ._shapes import counted
from ._spheres import Spheres

if TYPE_CHECKING:
    from ._shapes import Shapes

#: Labels show columns up to this number of spheres, because that copies the columns.
LABELLED = 2_000_000

#: Maximum number of columns in a label.
COLUMNS = 6


class View(anywidget.AnyWidget):
    """A picture in a notebook that is turned by dragging and zoomed by the wheel; ``view`` makes it.

    Pictures are rendered in the kernel, on a thread: quick and small ones while the camera moves, and then one with
    increasing numbers of samples. A click picks a sphere.

    ====================================  =====================
    drag, arrow keys                      turn
    right button, shift, or two fingers   move
    ctrl and drag                         roll
    wheel, two fingers, + and -           zoom
    double click, Home                    the first camera
    click, Enter (the middle)             pick; Escape unpicks
    ====================================  =====================
    """

    _esm = Path(__file__).with_name("_view.js").read_text("utf-8")
    _css = Path(__file__).with_name("_view.css").read_text("utf-8")

    #: The index of the picked sphere, which can be observed; None if there is none.
    picked = traitlets.Int(None, allow_none=True).tag(sync=True)
    _label = traitlets.Unicode("").tag(sync=True)
    _status = traitlets.Unicode("").tag(sync=True)
    _name = traitlets.Unicode("").tag(sync=True)
    _picture = traitlets.Bytes(b"").tag(sync=True)
    _size = traitlets.List([640, 480]).tag(sync=True)

    def __init__(
        self,
        spheres: Shapes,
        size: tuple[int, int],
        camera: Camera | str | Mapping[str, Any] | None,
        settings: Mapping[str, Any],
    ) -> None:
        self._spheres = spheres
        self._shown_size = checked_size(size)
        self._settings = {key: of for key, of in settings.items() if key not in ("layers", "progress")}
        self._orbit = self._placed(camera)
        self._first = self._orbit.camera
        self._functions = CallbackDispatcher()
        self._refiner = Refiner(
            spheres, self._first, self._shown_size, self._settings, self._show, self._fail
        )  # fmt: skip
        data = spheres._data
        is_spheres = isinstance(spheres, Spheres)
        name = counted(len(data), "sphere") if is_spheres else counted(len(data) + data.cone_count(), "shape")
        super().__init__(_size=self._page_size(), _name=f"picture of {name}")
        self.on_msg(self._on_message)
        self.observe(self._on_picked, "picked")
        self.refresh()

    def _placed(self, camera: Camera | str | Mapping[str, Any] | None) -> Orbit:
        """Returns the camera with its position, as an orbit that can turn."""
        placed = self._spheres._placed({**self._settings, "size": self._shown_size, "camera": camera})
        return Orbit(placed, self._spheres.bounds)

    def _page_size(self) -> list[int]:
        """The size of the picture on the page. The pictures of two eyes are side by side."""
        width, height = self._shown_size
        return [2 * width if "stereo" in self._orbit.rest else width, height]

    @property
    def camera(self) -> Camera:
        """The camera in its current position. ``render(camera=view.camera)`` makes the picture in any size. Assign a
        camera, or the name of a view, to move it.
        """
        return self._orbit.camera

    @camera.setter
    def camera(self, camera: Camera | str | Mapping[str, Any] | None) -> None:
        self._orbit = self._placed(camera)
        self._size = self._page_size()
        self._ask(moves=False)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture in pixels of the screen: more than CSS pixels if these are larger."""
        return self._refiner.size

    @property
    def image(self) -> Image | None:
        """The newest picture; None before the first."""
        stage = self._refiner.stage
        return None if stage is None else stage.image

    def wait(self, timeout: float | None = None) -> Image:
        """Waits until the picture has all of its samples, and returns it. ``timeout`` is in seconds."""
        finished = self._refiner.wait(timeout)
        if self._refiner.error is not None:
            raise self._refiner.error
        stage = self._refiner.stage
        if not finished or stage is None or not stage.is_final:
            raise InputError(f"the picture of the view is not finished after {timeout} seconds; wait longer")
        return stage.image

    def refresh(self) -> None:
        """Renders the picture again, such as after ``Spheres.update``."""
        self._ask(moves=False)

    def on_pick(self, function: Callable[[int | None], object], remove: bool = False) -> None:
        """Calls a function with the index of each newly picked sphere, and with None when none is picked any more."""
        self._functions.register_callback(function, remove=remove)

    def _ask(self, *, moves: bool) -> None:
        self._refiner.ask(self._orbit.camera, moves=moves)

    def _on_message(self, _: object, message: Any, buffers: object) -> None:
        """Handles a message of the page."""
        kind = message.get("kind") if isinstance(message, dict) else None
        if kind == "move":
            (turn_x, turn_y), (pan_x, pan_y) = (_numbers(message, name, 2) for name in ("turn", "pan"))
            (zoom,), (roll,) = (_numbers(message, name, 1) for name in ("zoom", "roll"))
            if turn_x or turn_y:
                self._orbit.turn(turn_x, turn_y)
            if roll:
                self._orbit.roll(roll)
            if pan_x or pan_y:
                self._orbit.pan(pan_x, pan_y)
            if zoom:
                self._orbit.zoom(zoom)
            self._ask(moves=True)
        elif kind == "still":
            self._refiner.settle()
        elif kind == "reset":
            self.camera = self._first
        elif kind == "pick":
            x, y = _numbers(message, "at", 2)
            tell = _on_loop(self._set_picked)
            self._refiner.pick(self._orbit.camera, x, y, tell)
        elif kind == "unpick":
            self.picked = None
        elif kind == "screen":
            (ratio,) = _numbers(message, "ratio", 1)
            size = screen_size(self._shown_size, ratio)
            if size != self._refiner.size:
                self._refiner.size = size
                self.refresh()

    def _set_picked(self, index: int | None) -> None:
        self.picked = index

    def _on_picked(self, change: Mapping[str, Any]) -> None:
        index: int | None = change["new"]
        self._label = "" if index is None else self._label_of(index)
        self._functions(index)

    def _label_of(self, index: int) -> str:
        """The text about a sphere."""
        spheres, words = self._spheres, [f"sphere {index}"]
        if isinstance(spheres, Spheres) and 0 <= index < len(spheres) <= LABELLED:
            columns = ((name, spheres[name]) for name in spheres.columns[:COLUMNS])
            # Columns of a selection have the values of all spheres, so they are left out.
            words += [f"{name} {_short(values[index])}" for name, values in columns if len(values) == len(spheres)]
        return ", ".join(words)

    def _show(self, stage: Stage) -> None:
        """Sends a picture to the page. The rendering thread calls it."""
        refines = not (stage.is_quick or stage.is_final)
        self._picture = stage.image._repr_png_()
        self._status = f"{stage.samples} of {self._refiner.samples} samples" if refines else ""

    def _fail(self, error: Error) -> None:
        self._status = str(error)

    def _repr_mimebundle_(self, **keys: Any) -> Any:
        """Returns the widget, and the newest picture for pages that cannot show widgets."""
        bundle = super()._repr_mimebundle_(**keys)
        data, metadata = bundle if isinstance(bundle, tuple) else (bundle or {}, {})
        if self._picture:
            data = {**data, "image/png": self._picture}
        return data, metadata

    def __repr__(self) -> str:
        width, height = self._shown_size
        return f"<pinhole.View {width}x{height}: {self._name}>"


def _on_loop(function: Callable[[int | None], object]) -> Callable[[int | None], object]:
    """Wraps a function for calls from other threads. It runs where messages arrive, and may print and set variables."""
    try:
        loop = asyncio.get_running_loop()
    except RuntimeError:
        return function

    def call(index: int | None) -> None:
        loop.call_soon_threadsafe(function, index)

    return call


def _numbers(message: Mapping[str, Any], name: str, count: int) -> list[float]:
    """The numbers in a message; zeros for missing or wrong ones."""
    found = message.get(name)
    given: list[Any] = found if isinstance(found, list) else [found]
    if len(given) != count or not all(isinstance(item, (int, float)) and math.isfinite(item) for item in given):
        return [0.0] * count
    return [float(item) for item in given]


def _short(item: Any) -> str:
    """Formats a value of a column in few characters."""
    return f"{item:g}" if isinstance(item, (float, np.floating)) else str(item)
