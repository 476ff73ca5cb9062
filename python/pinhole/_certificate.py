"""Certificates show whether a device rendered correctly."""

from __future__ import annotations

import os
from typing import Any

import numpy.typing as npt

from . import _report
from ._errors import InputError
from ._image import write
from ._pinhole import Judged


#: The words for the outcomes.
_NAMES = {"proved": "legal", "undecided": "UNDECIDED", "violated": "NOT LEGAL"}


class Certificate:
    """The result of checking pixel by pixel whether a conforming device may have made a picture."""

    __slots__ = ("_judged",)

    def __init__(self, judged: Judged) -> None:
        self._judged = judged

    @property
    def is_legal(self) -> bool:
        """Whether the outcome is ``"proved"``: every pixel is legal, and almost none has another legal answer."""
        return self._judged.is_legal

    @property
    def outcome(self) -> str:
        """``"proved"``; ``"violated"`` if a pixel is not legal; or ``"undecided"`` if none is known not to be, but more
        than 1 % of the pixels have several legal answers."""
        return self._judged.outcome

    @property
    def adapter(self) -> str:
        """The name of the adapter that rendered."""
        return self._judged.adapter

    @property
    def counts(self) -> dict[str, int]:
        """The number of pixels with each verdict: decided, silhouette, tie, violation."""
        return dict(self._judged.counts())

    @property
    def verdicts(self) -> npt.NDArray[Any]:
        """The verdict about every pixel as an index into ``list(counts)``: uint8, (height, width)."""
        return self._judged.verdicts()

    @property
    def violations(self) -> list[str]:
        """The first violations, in words."""
        return self._judged.violations()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes an .html page that needs no other files."""
        path = os.fspath(path)
        if os.path.splitext(path)[1].lower() not in (".html", ".htm"):
            raise InputError(f"{path}: a certificate is written as .html; change the extension")
        write(path, _report.page(self._judged).encode())

    def _repr_html_(self) -> str:
        return _report.part(self._judged)

    def __bool__(self) -> bool:
        return self.is_legal

    def __str__(self) -> str:
        return str(self._judged)

    def __repr__(self) -> str:
        words = ", ".join(f"{count} {name}" for name, count in self.counts.items() if count)
        return f"<pinhole.Certificate: {_NAMES[self.outcome]}, {words}>"
