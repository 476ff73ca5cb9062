"""A line with the progress of long renders, in terminals and notebooks."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

#: The time in seconds after which progress is shown.
SHOWN_AFTER = 1.0


class Line:
    """Shows progress on standard error, or in one output of a notebook, which does not fill a saved one."""

    def __init__(self) -> None:
        self.started = time.monotonic()
        self.shown = ""
        self.output: Any = None

    def __call__(self, part: float) -> None:
        elapsed = time.monotonic() - self.started
        if elapsed < SHOWN_AFTER or part <= 0.0:
            return
        left = elapsed / part - elapsed
        text = f"rendering: {100 * part:3.0f} %, {left:.0f} s left"
        if text != self.shown:
            self._write("\r" + text.ljust(len(self.shown)), text)
            self.shown = text

    def _write(self, line: str, text: str) -> None:
        if "ipykernel" not in sys.modules:
            sys.stderr.write(line)
            sys.stderr.flush()
            return
        from IPython.display import display

        if self.output is None:
            self.output = display({"text/plain": text}, raw=True, display_id=True)  # type: ignore[no-untyped-call, unused-ignore]
        else:
            self.output.update({"text/plain": text}, raw=True)

    def close(self) -> None:
        """Removes the line."""
        if self.shown:
            self._write("\r" + " " * len(self.shown) + "\r", "")


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
