"""Cameras, with a position, or with a view that frames the spheres."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ._errors import InputError
from ._pinhole import check_view, keys_of


class Camera:
    """A camera. Lengths are in scene units, and angles in degrees.

    ``Camera.look_at`` places a camera, and ``Camera.frame`` lets it frame all spheres. ``kind`` is ``"pinhole"``,
    ``"orthographic"``, ``"thin-lens"``, ``"panorama"`` or ``"fisheye"``, by default that of the kind of data;
    further keywords are the keys of the scene file's
    table ``[camera.KIND]``, such as ``aperture_radius``, ``focus_on``, ``half_extent`` or ``stereo``.
    """

    __slots__ = ("kind", "keys", "view", "turn", "up")

    def __init__(
        self,
        kind: str | None = None,
        *,
        view: str | Sequence[float] | None = None,
        turn: float = 0.0,
        up: Sequence[float] | None = None,
        fov: float | None = None,
        **keys: Any,
    ) -> None:
        if view is not None and not isinstance(view, str):
            view = _angles(view)
        if view is not None:
            check_view(view)
        if view is not None and any(key in keys for key in ("eye", "look_at", "direction")):
            raise InputError("view and eye, look_at or direction exclude each other; remove one of them")
        if fov is not None and "vertical_fov" in keys:
            raise InputError("fov and vertical_fov say the same; remove one of them")
        if fov is not None:
            keys["vertical_fov"] = fov
        self.kind = kind
        self.keys = {key: item for key, item in keys.items() if item is not None}
        self.view = view
        self.turn = float(turn)
        self.up = None if up is None else tuple(_point("up", up))

    @classmethod
    def look_at(
        cls,
        eye: Sequence[float],
        at: Sequence[float],
        *,
        up: Sequence[float] = (0.0, 1.0, 0.0),
        fov: float | None = None,
        kind: str | None = None,
        **keys: Any,
    ) -> Camera:
        """A camera at the point ``eye`` that looks at the point ``at``. ``fov`` is the vertical field of view."""
        return cls(kind, eye=_point("eye", eye), look_at=_point("at", at), up=up, fov=fov, **keys)

    @classmethod
    def frame(
        cls,
        view: str | Sequence[float] | None = None,
        *,
        turn: float = 0.0,
        up: Sequence[float] | None = None,
        zoom: float | None = None,
        margin: float | None = None,
        fov: float | None = None,
        kind: str | None = None,
        **keys: Any,
    ) -> Camera:
        """A camera that frames all spheres.

        ``view`` is ``"x"``, ``"-x"``, ``"y"``, ``"-y"``, ``"z"``, ``"-z"``, ``"iso"`` or (azimuth, elevation); ``turn``
        turns the camera about the direction that is up; ``margin`` is the free part of the picture on each side.
        """
        return cls(kind, view=view, turn=turn, up=up, zoom=zoom, margin=margin, fov=fov, **keys)

    def _is_placed(self) -> bool:
        """Whether the keys give the position or the direction of the camera."""
        return "eye" in self.keys or "direction" in self.keys or self.kind in ("panorama", "fisheye")

    def _table(self, data: Any) -> dict[str, Any]:
        """Returns the table ``camera`` of a scene file for a camera that frames spheres."""
        keys: dict[str, Any] = dict(self.keys)
        kind, direction, usual_up = self._usual(data)
        if direction is not None:
            keys["direction"], keys["up"] = direction, usual_up
        elif self.view is not None or not self._is_placed():
            up = usual_up if self.up is None else self.up
            direction, up = data.view_axes(self.view, self.turn, up)
            keys["direction"], keys["up"] = list(direction), list(up)
        elif self.turn != 0.0:
            raise InputError("turn applies to a camera that frames the spheres; remove turn, eye or direction")
        elif self.up is not None:
            keys["up"] = list(self.up)
        return {kind: keys}

    def _usual(self, data: Any) -> tuple[str, Sequence[float] | None, Sequence[float] | None]:
        """The kind of the camera; the direction in which it sees this kind of data, unless this camera has a view or that is
        the usual one; and the direction that is up then, if it is not the usual one.
        """
        view = data.kind()[3]
        is_placed = self.up is not None or any(key in self.keys for key in ("eye", "look_at", "stereo"))
        if view is None or is_placed or self.kind in ("panorama", "fisheye"):
            return self.kind or "pinhole", None, None
        camera, direction, up, up_of_views = view
        has_view = self.view is not None or self.turn != 0.0 or any(key in self.keys for key in ("direction", "focus_on"))
        if any(key not in keys_of("camera.orthographic") for key in self.keys):
            camera = "pinhole"
        return self.kind or camera, None if has_view else direction, up_of_views if has_view else up

    def __repr__(self) -> str:
        shown = {"view": self.view, "turn": self.turn or None, "up": self.up, **self.keys}
        words = [*([repr(self.kind)] if self.kind else []), *(f"{key}={item!r}" for key, item in shown.items() if item is not None)]
        return f"Camera({', '.join(words)})"


def as_camera(given: Any) -> Camera | Mapping[str, Any]:
    """Makes a camera from the argument ``camera``: a camera, a view, the table of a scene file, or None."""
    if given is None:
        return Camera()
    if isinstance(given, (Camera, Mapping)):
        return given
    if isinstance(given, (str, tuple, list, np.ndarray)):
        view: Any = given
        return Camera(view=view)
    raise InputError(
        f'camera is {given!r}; write a Camera, a view such as "iso" or (azimuth, elevation), or the table of a scene file'
    )


def _angles(view: Any) -> str:
    """A view by azimuth and elevation, in degrees."""
    try:
        azimuth, elevation = (float(angle) for angle in view)
    except (TypeError, ValueError):
        raise InputError(
            f'view is {view!r}; write "x", "-x", "y", "-y", "z", "-z", "iso" or (azimuth, elevation) in degrees; '
            "a camera at a point is Camera.look_at(eye, at)"
        ) from None
    return f"{azimuth!r},{elevation!r}"


def _point(name: str, point: Sequence[float]) -> list[float]:
    try:
        x, y, z = (float(number) for number in point)
    except (TypeError, ValueError):
        raise InputError(f"{name} is {point!r}; write three numbers, x, y and z") from None
    return [x, y, z]
