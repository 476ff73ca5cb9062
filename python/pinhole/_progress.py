"""A line that shows the progress of renders that take long, in terminals and notebooks."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

#: Renders that take less time than this, in seconds, show nothing.
SHOWN_AFTER = 1.0


class Line:
    """Shows progress on standard error."""

    def __init__(self) -> None:
        self.started = time.monotonic()
        self.shown = ""

    def __call__(self, part: float) -> None:
        elapsed = time.monotonic() - self.started
        if elapsed < SHOWN_AFTER or part <= 0.0:
            return
        left = elapsed / part - elapsed
        text = f"rendering: {100 * part:3.0f} %, {left:.0f} s left"
        if text != self.shown:
            sys.stderr.write("\r" + text.ljust(len(self.shown)))
            sys.stderr.flush()
            self.shown = text

    def close(self) -> None:
        """Takes the line away."""
        if self.shown:
            sys.stderr.write("\r" + " " * len(self.shown) + "\r")
            sys.stderr.flush()


def chosen(progress: bool | Callable[[float], object] | None) -> tuple[Callable[[float], object] | None, Line | None]:
    """What is called with the progress, and the line to close afterwards."""
    if callable(progress):
        return (progress, None)
    if progress is None:
        progress = sys.stderr.isatty() or "ipykernel" in sys.modules
    if not progress:
        return (None, None)
    line = Line()
    return (line, line)
