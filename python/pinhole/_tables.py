"""Tables of a scene file as objects. They are dicts, and plain dicts may replace them everywhere."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from functools import cache
from typing import Any, ClassVar

import numpy as np

from . import _settings
from ._pinhole import SphereData, keys_of, of_arrays


class Table(_settings.Tagged):
    """A table of a scene file. Its keys are the arguments that are not None. Printing it gives the text of a
    scene file.
    """

    #: The name in scene files, such as ``studio.occlusion``.
    name: ClassVar[str] = ""
    #: The keys in scene files.
    names: ClassVar[tuple[str, ...]] = ()
    is_listed: ClassVar[bool] = False

    def __init_subclass__(cls, of: str, argument: str | None = None, listed: bool = False) -> None:
        cls.name, cls.names, cls.is_listed = of, tuple(keys_of(of)), listed
        cls.argument = argument or of
        cls.__module__ = "pinhole"
        # Help and completion show this signature.
        parameters = [inspect.Parameter(key, inspect.Parameter.KEYWORD_ONLY, default=None) for key in cls.names]
        cls.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]

    def __init__(self, **keys: Any) -> None:
        super().__init__({key: of for key, of in keys.items() if of is not None})
        for key, of in self.items():
            _settings.refuse_misplaced(f"{self.name}.{key}", of)
        self._check()

    def _check(self) -> None:
        """Checks the table by letting the library read it."""
        table: Any = [self] if self.is_listed else self
        *outer, last = self.name.split(".")
        for part in (last, *reversed(outer)):
            table = {part: table}
        _nothing().placed(_settings.scene_text({"data": "spheres", **table}), None)

    def __repr__(self) -> str:
        return _toml(f"[[{self.name}]]" if self.is_listed else f"[{self.name}]", self.name, self)


@cache
def _nothing() -> SphereData:
    """Makes data without spheres, for checking texts."""
    return of_arrays(np.zeros((0, 3), np.float32), 1.0, None, [], ("", [], None), None, None, None)


def _toml(head: str, name: str, table: Mapping[str, Any]) -> str:
    plain = {key: of for key, of in table.items() if not isinstance(of, Mapping)}
    lines = [head, *(f"{_settings.bare(key)} = {_settings.value(of, f'{name}.{key}')}" for key, of in plain.items())]
    for key, of in table.items():
        if key not in plain:
            inner = f"{name}.{_settings.bare(key)}"
            lines += ["", _toml(f"[{inner}]", inner, of)]
    return "\n".join(lines)


class Studio(Table, of="studio"):
    """Direct light: its ambient light, shadows, ``Occlusion``, ``Outline`` and ``DepthCue``."""


class Occlusion(Table, of="studio.occlusion"):
    """Ambient light that spheres hide from each other, for ``Studio``."""


class Outline(Table, of="studio.outline"):
    """Lines along jumps in depth or direction, for ``Studio``."""


class DepthCue(Table, of="studio.depth_cue"):
    """Fading of colours with distance, for ``Studio``."""


class Path(Table, of="path"):
    """Settings of path tracing."""


class Sampling(Table, of="sampling"):
    """The samples of each pixel."""


class Light(Table, of="lights", listed=True):
    """A light, for a list: ``lights=[Light(kind="directional", toward=(1, 1, 1))]``."""


class Sun(Table, of="sun"):
    """A sun with a visible disk."""


class Sky(Table, of="sky"):
    """The surroundings, which give light to paths."""


class Ground(Table, of="ground"):
    """A plane on which spheres lie."""


class Output(Table, of="output"):
    """The conversion of a picture to a PNG file."""


class Legend(Table, of="legend"):
    """A legend for colours of numbers or categories."""


class Axes(Table, of="axes"):
    """The directions of x, y and z."""


class ScaleBar(Table, of="scale_bar"):
    """A line of a known length."""


class Label(Table, of="labels", listed=True):
    """A text in the picture, for a list."""


class Text(Table, of="text"):
    """The appearance of texts."""


class Material(Table, of="materials.given", argument="material"):
    """The material of spheres; an argument of ``Spheres``."""


class ColorBy(Table, of="color_by"):
    """Colours from a column; an argument of ``Spheres``."""


class RadiusBy(Table, of="radius_by"):
    """Radii from a column; an argument of ``Spheres``."""


class OpacityBy(Table, of="opacity_by"):
    """Opacities from a column; an argument of ``Spheres``."""


class EmissionBy(Table, of="emission_by"):
    """Emitted light from a column; an argument of ``Spheres``."""


class Bonds(Table, of="bonds"):
    """Bonds between spheres; an argument of ``Spheres``."""


class Arrows(Table, of="arrows"):
    """Arrows that show a vector of each sphere; an argument of ``Spheres``."""


class Box(Table, of="box"):
    """The edges of the periodic cell; an argument of ``Spheres``."""


#: All tables.
ALL: tuple[type[Table], ...] = tuple(Table.__subclasses__())
