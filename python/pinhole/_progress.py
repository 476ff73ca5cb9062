"""A line with the progress of long renders, in terminals and notebooks."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

#: The time in seconds after which progress is shown.
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
        """Removes the line."""
        if self.shown:
            sys.stderr.write("\r" + " " * len(self.shown) + "\r")
            sys.stderr.flush()


def chosen(progress: bool | Callable[[float], object] | None) -> tuple[Callable[[float], object] | None, Line | None]:
    """Returns the function to call with the progress, and the line to close afterwards."""
    if callable(progress):
        return (progress, None)
    if progress is None:
        progress = sys.stderr.isatty() or "ipykernel" in sys.modules
    if not progress:
        return (None, None)
    line = Line()
    return (line, line)
