"""Moves a camera with the pointer, by the same rules as the program's window."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ._camera import Camera

Array = npt.NDArray[Any]

#: The number of full turns when the pointer moves by one height of the picture.
TURNS_PER_HEIGHT = 0.5

#: The change of the distance by one step of the wheel, in CSS pixels, as a power of e.
ZOOM_PER_POINT = 0.003

#: The vertical field of view of cameras without ``fov``, in degrees.
USUAL_FOV = 30.0


class Orbit:
    """A camera with a position, and the point around which it turns."""

    __slots__ = ("kind", "rest", "eye", "direction", "up", "pivot", "least", "depth")

    def __init__(self, placed: Mapping[str, Mapping[str, Any]], bounds: tuple[Array, Array] | None) -> None:
        ((self.kind, keys),) = placed.items()
        self.eye = np.array(keys["eye"], float)
        looks_at = "look_at" in keys
        self.direction = _unit(np.array(keys["look_at"]) - self.eye if looks_at else np.array(keys["direction"]))
        up = np.array(keys.get("up", (0.0, 1.0, 0.0)), float)
        self.up = _unit(up - np.dot(up, self.direction) * self.direction)
        self.rest = {key: of for key, of in keys.items() if key not in ("eye", "look_at", "direction", "up")}
        low, high = bounds if bounds is not None else (self.eye - 1.0, self.eye + 1.0)
        size = float(np.linalg.norm(high - low))
        depth = float(np.dot((low + high) / 2 - self.eye, self.direction))
        if looks_at:
            depth = float(np.linalg.norm(np.array(keys["look_at"]) - self.eye))
        elif depth <= 1e-3 * size:
            depth = 0.5 * max(size, 1e-6)
        self.pivot = self.eye + depth * self.direction
        self.least = 1e-4 * max(size, 1e-9)
        self.depth = depth

    @property
    def is_inside(self) -> bool:
        """Whether the camera sees in all directions, so that it turns about its own position."""
        return self.kind in ("panorama", "fisheye")

    @property
    def camera(self) -> Camera:
        """The camera in its current position."""
        place = {"eye": self.eye.tolist(), "direction": self.direction.tolist()}
        return Camera(self.kind, up=self.up.tolist(), **place, **self.rest)

    def turn(self, x: float, y: float) -> None:
        """Turns the scene under the pointer, which moved to the right and down by fractions of the picture's height."""
        angle = TURNS_PER_HEIGHT * 2 * math.pi
        right = np.cross(self.direction, self.up)
        turn = rotation(self.up, -x * angle) @ rotation(right, -y * angle)
        self._set(turn @ self.direction, turn @ self.up)

    def roll(self, angle: float) -> None:
        """Turns the picture about its middle, counter-clockwise, by an angle in radians."""
        self._set(self.direction, rotation(self.direction, angle) @ self.up)

    def pan(self, x: float, y: float) -> None:
        """Moves the camera so that points at the depth of the pivot follow the pointer."""
        if "half_extent" in self.rest:
            height = 2 * float(self.rest["half_extent"][1])
            if self.kind != "orthographic":
                height *= self.depth / float(self.rest.get("distance", 1.0))
        else:
            fov = math.radians(float(self.rest.get("vertical_fov", USUAL_FOV)))
            height = 2 * self.depth * math.tan(fov / 2)
        height /= float(self.rest.get("zoom", 1.0))
        by = height * (y * self.up - x * np.cross(self.direction, self.up))
        self.eye, self.pivot = self.eye + by, self.pivot + by

    def zoom(self, points: float) -> None:
        """Moves nearer by steps of the wheel in CSS pixels."""
        factor = math.exp(min(max(-ZOOM_PER_POINT * points, -1.0), 1.0))
        if self.kind == "orthographic" and "half_extent" in self.rest:
            self.rest = {**self.rest, "half_extent": [factor * float(side) for side in self.rest["half_extent"]]}
            return
        depth = max(self.depth * factor, self.least)
        if "focus_distance" in self.rest:
            moved = float(self.rest["focus_distance"]) + depth - self.depth
            self.rest = {**self.rest, "focus_distance": max(moved, self.least)}
        self.eye = self.pivot - depth * self.direction
        self.depth = depth

    def _set(self, direction: Array, up: Array) -> None:
        """Gives the camera another direction, around the pivot or around itself."""
        self.direction = _unit(direction)
        self.up = _unit(up - np.dot(up, self.direction) * self.direction)
        if self.is_inside:
            self.pivot = self.eye + self.depth * self.direction
        else:
            self.eye = self.pivot - self.depth * self.direction


def rotation(axis: Array, angle: float) -> Array:
    """The matrix of a turn by an angle about an axis, counter-clockwise as seen from the end of the axis."""
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turn: Array = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross)
    return turn


def _unit(vector: Array) -> Array:
    unit: Array = vector / np.linalg.norm(vector)
    return unit
