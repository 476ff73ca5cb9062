"""What tests share: data that they make themselves, and the program of the same build."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

# A job in the background of a shell ignores Ctrl-C, which tests send to themselves.
signal.signal(signal.SIGINT, signal.default_int_handler)

#: The program that was built beside the package; tests that compare with it are skipped without it.
PROGRAM = os.environ.get("PINHOLE_PROGRAM")


def cloud(count: int = 500, seed: int = 1) -> np.ndarray[Any, Any]:
    """Some points, in float64."""
    return np.random.default_rng(seed).normal(size=(count, 3))


@pytest.fixture
def program(tmp_path: Path) -> Callable[..., bytes]:
    """Runs the program in a folder of its own, and returns the picture that it wrote, unless they are numbered."""

    def run(*arguments: str, output: str = "program.png") -> bytes:
        if PROGRAM is None:
            pytest.skip("PINHOLE_PROGRAM does not name the program")
        command = [PROGRAM, "render", *arguments, "-o", output]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=100)
        assert done.returncode == 0, done.stderr
        return b"" if "%" in output else (tmp_path / output).read_bytes()

    return run
