"""Renders the newest requested picture on a thread. While the camera moves, pictures are quick, and then one is refined
with more and more samples.
"""

from __future__ import annotations

import atexit
import math
import threading
import time
import weakref
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import _settings
from ._camera import Camera
from ._errors import Error
from ._image import Image

if TYPE_CHECKING:
    from ._shapes import Shapes

#: Seconds without a movement after which the picture is refined.
STILL_AFTER = 0.25

#: The time in seconds that a quick picture may take. Slower pictures get fewer pixels.
QUICK = 0.06

#: The sides of quick pictures as fractions of the whole: the smallest, the largest, and those of the first picture.
PARTS = (0.125, 1.0, 0.5)

#: The factor by which samples grow from one refined picture to the next.
GROWTH = 4

#: The most pixels of a side and of a whole picture on a screen.
LARGEST = (8192, 16_000_000)

#: Settings that quick pictures, by primary rays, also use.
OF_QUICK = ("film", "output", "transparent", "exposure", "tone", "background")


#: The time in seconds within which a picture stops that is no longer wanted.
STOPS_WITHIN = 5.0


class Superseded(Exception):
    """The exception in a render when a newer picture is wanted."""


class Stage(NamedTuple):
    """A picture, with its camera and its quality."""

    image: Image
    camera: Camera
    is_quick: bool
    #: Whether this is the last stage, with all samples.
    is_final: bool
    samples: int


class Refiner:
    """Renders spheres with the settings of ``render``. The thread calls ``show`` with every picture, and
    ``fail`` with an error.
    """

    def __init__(
        self,
        spheres: Shapes,
        camera: Camera,
        size: tuple[int, int],
        settings: Mapping[str, Any],
        show: Callable[[Stage], object],
        fail: Callable[[Error], object],
    ) -> None:
        self.spheres, self.size = spheres, size
        self.settings = dict(settings)
        self.backend: str = self.settings.pop("backend", None) or "auto"
        self.show, self.fail = show, fail
        self.samples, background = self._probe(camera)
        known = {key: of for key, of in self.settings.items() if key in OF_QUICK and of is not None}
        self.quick = {"background": background, **known, "style": "fast"}
        self.part = PARTS[2]
        self.stage: Stage | None = None
        self.error: Error | None = None
        # The current request: the newest camera, whether it moves, since when, and the number of the request.
        self._camera, self._moves, self._since, self._serial = camera, False, 0.0, 0
        #: The number of the newest request that was answered.
        self._done = 0
        #: The request of the newest picture, and the picture's samples, which are 0 if it is quick.
        self._reached = (-1, 0)
        self._picks: list[tuple[Camera, float, float, Callable[[int | None], object]]] = []
        self._thread: threading.Thread | None = None
        self._changed = threading.Condition()

    def _probe(self, camera: Camera) -> tuple[int, list[float]]:
        """Returns the number of samples of a pixel, and the background, from a picture that shows no spheres. It also
        checks the settings and copies the spheres to the device.
        """
        bounds = self.spheres.bounds
        low, high = bounds if bounds is not None else (np.zeros(3), np.ones(3))
        up = np.array(camera.up or (0.0, 1.0, 0.0))
        up = up / np.linalg.norm(up)
        eye = (low + high) / 2 + 10 * float(np.linalg.norm(high - low)) * up
        side = [1.0, 0.0, 0.0] if abs(up[0]) < 0.7 else [0.0, 1.0, 0.0]
        away = Camera(eye=eye.tolist(), direction=up.tolist(), up=side)
        settings = {key: of for key, of in self.settings.items() if key not in ("legend", "scale_bar", "axes", "labels", "text")}
        image = self._render({**settings, "camera": away, "size": (4, 4)}, layers=["samples"])
        return int(image.samples.max()), [float(part) for part in image.color[0, 0]]

    def _render(
        self, settings: Mapping[str, Any], serial: int | None = None, layers: list[str] | None = None
    ) -> Image:
        """Renders a picture. It stops when another request than this one, or a pick, is waiting."""

        def look(_: float) -> None:
            if serial is not None and (serial != self._serial or self._picks):
                raise Superseded

        text = self.spheres._text(settings)
        return Image(self.spheres._data.render(text, layers or [], self.backend, look))

    def image_at(self, camera: Camera, samples: int | None = None, serial: int | None = None) -> Image:
        """Renders the picture with this number of samples, or all."""
        settings = {**self.settings, "camera": camera, "size": self.size}
        if samples is not None:
            settings.pop("samples", None)
            settings["sampling"] = {**(self.settings.get("sampling") or {}), "samples": samples}
        return self._render(settings, serial)

    def stop(self) -> None:
        """Drops all requests and waits until the thread has ended, as the interpreter needs before it ends."""
        with self._changed:
            self._serial += 1
            self._done, self._picks = self._serial, []
            self._changed.notify_all()
        self.wait(STOPS_WITHIN)

    def ask(self, camera: Camera, *, moves: bool) -> None:
        """Requests a picture, in place of earlier requests."""
        with self._changed:
            self._camera, self._moves, self._since = camera, moves, time.monotonic()
            self._serial += 1
            self.error = None
            self._start()

    def settle(self) -> None:
        """Records that the camera no longer moves."""
        with self._changed:
            self._moves = False
            self._changed.notify_all()

    def pick(self, camera: Camera, x: float, y: float, tell: Callable[[int | None], object]) -> None:
        """Finds the sphere at a place, in fractions of width and height from the upper left, for ``tell``."""
        with self._changed:
            self._picks.append((camera, x, y, tell))
            self._start()

    def _start(self) -> None:
        if self._thread is None:
            _at_work.add(self)
            self._thread = threading.Thread(target=self._work, name="pinhole view", daemon=True)
            self._thread.start()
        self._changed.notify_all()

    def wait(self, timeout: float | None = None) -> bool:
        """Waits until there is nothing left to do. Returns False after a timeout."""
        with self._changed:
            return self._changed.wait_for(lambda: self._thread is None, timeout)

    def _work(self) -> None:
        while True:
            with self._changed:
                picks, self._picks = self._picks, []
                serial, camera, moves = self._serial, self._camera, self._moves
                if not picks and serial == self._done:
                    self._thread = None
                    self._changed.notify_all()
                    return
            try:
                for pick in picks:
                    self._answer(*pick)
                if serial != self._done and (not moves or self._move(serial, camera)):
                    self._refine(serial, camera)
                    self._done = serial
            except Superseded:
                pass
            except Error as error:
                self._done = serial
                self.error = error
                self.fail(error)
            except BaseException:
                with self._changed:
                    self._thread = None
                    self._changed.notify_all()
                raise

    def _answer(self, camera: Camera, x: float, y: float, tell: Callable[[int | None], object]) -> None:
        settings = {**self.quick, "camera": camera, "size": self.size}
        ids = self._render(settings, layers=["id"]).id
        height, width = ids.shape
        if not (0 <= x < 1 and 0 <= y < 1):
            tell(None)
            return
        found = int(ids[int(y * height), int(x * width)])
        # Added shapes, such as bonds, have larger indices than the data's spheres.
        tell(found if found < len(self.spheres._data) else None)

    def _move(self, serial: int, camera: Camera) -> bool:
        """Shows a quick picture, and returns whether the camera does not move afterwards."""
        if self._reached[0] == serial:
            return self._stays_still(serial)
        started = time.monotonic()
        size = (max(1, round(self.size[0] * self.part)), max(1, round(self.size[1] * self.part)))
        # Quick pictures are never stopped, or nothing would be visible while the camera moves continuously.
        image = self._render({**self.quick, "camera": camera, "size": size})
        taken = time.monotonic() - started
        self._reached = (serial, 0)
        self._show(Stage(image, camera, True, False, 1))
        part = self.part * min(max(math.sqrt(QUICK / max(taken, 1e-6)), 0.5), 1.5)
        self.part = min(max(part, PARTS[0]), PARTS[1])
        return self._stays_still(serial)

    def _stays_still(self, serial: int) -> bool:
        """Waits until the camera has not moved for a while. Returns whether no other request came first."""
        with self._changed:
            left = self._since + STILL_AFTER - time.monotonic()
            self._changed.wait_for(lambda: serial != self._serial or bool(self._picks) or not self._moves, left)
            return serial == self._serial and not self._picks

    def _refine(self, serial: int, camera: Camera) -> None:
        """Shows pictures with increasing numbers of samples."""
        samples = 1
        while samples < self.samples:
            if self._reached[0] != serial or self._reached[1] < samples:
                self._show(Stage(self.image_at(camera, samples, serial), camera, False, False, samples), serial)
                self._reached = (serial, samples)
            samples *= GROWTH
        self._show(Stage(self.image_at(camera, None, serial), camera, False, True, self.samples), serial)

    def _show(self, stage: Stage, serial: int | None = None) -> None:
        with self._changed:
            if serial is not None and serial != self._serial:
                raise Superseded
            self.stage = stage
        self.show(stage)


#: Refiners that have had a thread.
_at_work: weakref.WeakSet[Refiner] = weakref.WeakSet()


@atexit.register
def _stop_all() -> None:
    for refiner in list(_at_work):
        refiner.stop()


def screen_size(size: tuple[int, int], ratio: float) -> tuple[int, int]:
    """The size in pixels of a picture of this size in CSS pixels, on a screen with this number of pixels for each."""
    side, area = LARGEST
    most = min(side / max(size), math.sqrt(area / (size[0] * size[1])))
    factor = min(max(ratio, 1.0), max(most, 1.0))
    return (round(size[0] * factor), round(size[1] * factor))


def checked_size(size: Any) -> tuple[int, int]:
    """Checks that a picture of this size can be shown."""
    _settings.picture_settings({"size": size})
    width, height = size
    return (int(width), int(height))
